#include "arcslip/problems/response/nonlinear_mode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace arcslip::problems {

/// One harmonic of the linear part, with derivatives in eta and zeta.
struct NonlinearMode::Order {
  Index which;
  ContactMatrix compliance;      // C_h
  ContactMatrix compliance_eta;  // of the damping -2 zeta eta as well
  ContactMatrix compliance_zeta;
  double norm = 1;  // 1 + |C_B K|^2 + |C_D K|^2, of the terms that may cancel in C_h K
  double norm_eta = 0;
  double norm_zeta = 0;
};

HarmonicVector NonlinearMode::motion(const Vector& u, const Vector& p, Index coordinate) const {
  HarmonicVector r(harmonics());
  for (Index a = 0; a < harmonics(); ++a) {
    const Index place = 2 * (coordinate * harmonics() + a);
    r(a) = place == 0 ? Complex(p(amplitude)) : Complex(u(place), u(place + 1));
  }
  return r;
}

double NonlinearMode::threshold(Index contact, const Vector& u, const Vector& p) const {
  return coordinates_.element(contact).slip_threshold(load(u, p));
}

const std::vector<ElementForce>& NonlinearMode::forces(const Vector& u, const Vector& p, int regime,
                                                       bool derivatives) const {
  thread_local std::vector<ElementForce> all;
  all.resize(at(coordinates_.size()));
  for (Index i = 0; i < coordinates_.size(); ++i) {
    coordinates_.element(i).force(system_.orders, motion(u, p, i), load(u, p), slips(regime, i), derivatives,
                                  all[at(i)]);
  }
  return all;
}

NonlinearMode::Order NonlinearMode::order(Index which, const Vector& u, int regime) const {
  const double h = system_.orders[at(which)];
  const Index m = coordinates_.size();
  Order order{which, ContactMatrix::Zero(m, m), ContactMatrix::Zero(m, m), ContactMatrix::Zero(m, m)};
  if (regime == 0 && which > 0 && !coordinates_.has_others())
    return order;  // x_h = 0, also at a resonance of C_h
  const auto add = [&](const ContactModes& structure, double Coordinate::*entry) {
    const DampedReceptance found = structure.damped(h * u(frequency), -2 * u(damping) * u(frequency));
    const auto in_coordinates = [&](const ContactMatrix& matrix) {
      ContactMatrix sum = ContactMatrix::Zero(m, m);
      coordinates_.add(matrix, entry, sum);
      return sum;
    };
    const ContactMatrix compliance = in_coordinates(found.compliance);
    const ContactMatrix by_eta =
        in_coordinates(h * found.compliance_eta - 2 * u(damping) * found.compliance_mass);
    const ContactMatrix by_zeta = in_coordinates(-2 * u(frequency) * found.compliance_mass);
    order.compliance += compliance;
    order.compliance_eta += by_eta;
    order.compliance_zeta += by_zeta;
    for (Index j = 0; j < m; ++j) {
      const double square = std::pow(coordinates_.element(j).reference_stiffness(), 2);
      order.norm += square * compliance.col(j).squaredNorm();
      order.norm_eta += 2 * square * std::real(compliance.col(j).dot(by_eta.col(j)));
      order.norm_zeta += 2 * square * std::real(compliance.col(j).dot(by_zeta.col(j)));
    }
  };
  add(system_.base[at(which)], &Coordinate::base);
  add(system_.damper[at(which)], &Coordinate::damper);
  return order;
}

bool NonlinearMode::evaluate(const Vector& u, const Vector& p, int regime,
                             const continuation::Evaluation& out) const {
  if (!(u(frequency) > 0 && p(amplitude) > 0 && p(preload) > 0 && load(u, p) > 0)) return false;
  for (Index i = 1; i < contacts(); ++i) {
    if (slips(regime, i) && motion(u, p, i).isZero(0)) return false;
  }
  const bool derivatives = out.jacobian != nullptr || out.parameter_jacobian != nullptr;
  const std::vector<ElementForce>& friction = forces(u, p, regime, derivatives);
  for (Index a = 0; a < harmonics(); ++a) {
    const Order at_order = order(a, u, regime);
    for (Index i = 0; i < coordinates_.size(); ++i) fill_row(at_order, i, friction, u, p, out);
  }
  return true;
}

void NonlinearMode::fill_row(const Order& order, Index coordinate, const std::vector<ElementForce>& elements,
                             const Vector& u, const Vector& p, const continuation::Evaluation& out) const {
  const Index n = harmonics();
  const Index row = 2 * (coordinate * n + order.which);
  const auto store = [row](Complex value, auto&& column) {
    column(row) = value.real();
    column(row + 1) = value.imag();
  };
  const double size = std::hypot(p(amplitude), u.tail(u.size() - 2).norm());
  const double weight = 1 / (std::sqrt(order.norm) * size);
  Complex residual = motion(u, p, coordinate)(order.which);
  Complex by_log_load = 0;
  for (Index j = 0; j < coordinates_.size(); ++j) {
    residual += order.compliance(coordinate, j) * elements[at(j)].harmonics(order.which);
    if (out.jacobian != nullptr || out.parameter_jacobian != nullptr)
      by_log_load += order.compliance(coordinate, j) * elements[at(j)].by_log_load(order.which);
  }
  if (out.residual != nullptr) store(weight * residual, *out.residual);

  const Complex shrink = residual / (size * size);
  // Derivatives by Re and Im of the harmonic that the unknowns from `column` on hold.
  const auto by_motion = [&](Index column) {
    const Index j = column / (2 * n);
    const Index b = column / 2 % n;
    const Complex c = order.compliance(coordinate, j);
    const Complex linear = c * elements[at(j)].linear(order.which, b) + (row == column ? 1.0 : 0.0);
    const Complex conjugate = c * elements[at(j)].conjugate(order.which, b);
    return std::array{linear + conjugate, Complex(0, 1) * (linear - conjugate)};
  };
  if (out.parameter_jacobian != nullptr) {
    store(weight * (by_motion(0)[0] - shrink * p(amplitude)), out.parameter_jacobian->col(amplitude));
    store(weight / load(u, p) * by_log_load, out.parameter_jacobian->col(preload));
  }
  if (out.jacobian == nullptr) return;
  Complex by_eta = by_log_load * (2 * system_.preload_growth * u(frequency) / load(u, p)) -
                   residual * (0.5 * order.norm_eta / order.norm);
  Complex by_zeta = -residual * (0.5 * order.norm_zeta / order.norm);
  for (Index j = 0; j < coordinates_.size(); ++j) {
    by_eta += order.compliance_eta(coordinate, j) * elements[at(j)].harmonics(order.which);
    by_zeta += order.compliance_zeta(coordinate, j) * elements[at(j)].harmonics(order.which);
  }
  store(weight * by_eta, out.jacobian->col(frequency));
  store(weight * by_zeta, out.jacobian->col(damping));
  for (Index column = 2; column < u.size(); column += 2) {
    const auto [real, imaginary] = by_motion(column);
    store(weight * (real - shrink * u(column)), out.jacobian->col(column));
    store(weight * (imaginary - shrink * u(column + 1)), out.jacobian->col(column + 1));
  }
}

void NonlinearMode::scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const {
  constexpr double small_ratio = 1e-4;  // a damping ratio that crosses zero has no size of its own
  unknowns.setConstant(std::hypot(p(amplitude), u.tail(u.size() - 2).norm()));
  unknowns(frequency) = u(frequency);
  unknowns(damping) = std::max(std::abs(u(damping)), small_ratio);
  parameters = p;
}

double NonlinearMode::border(const Vector& u, const Vector& p, int regime, int border,
                             continuation::Gradient* gradient) const {
  const HarmonicVector r = motion(u, p, border);
  const StateBorder at_border = coordinates_.element(border).border(
      system_.orders, OddMotion(system_.orders, r).maximum(), load(u, p), slips(regime, border));
  if (gradient == nullptr) return at_border.value;
  gradient->unknowns.setZero();
  gradient->parameters.setZero();
  for (Index a = 0; a < harmonics(); ++a) {
    const Index place = 2 * (border * harmonics() + a);
    if (place == 0) {
      gradient->parameters(amplitude) = at_border.by_motion(a).real();
    } else {
      gradient->unknowns(place) = at_border.by_motion(a).real();
      gradient->unknowns(place + 1) = at_border.by_motion(a).imag();
    }
  }
  const double by_load = at_border.by_log_load / load(u, p);
  gradient->parameters(preload) = by_load;
  gradient->unknowns(frequency) = 2 * system_.preload_growth * u(frequency) * by_load;
  return at_border.value;
}

std::vector<continuation::Observable> NonlinearMode::observables() const {
  std::vector<continuation::Observable> all = {{"eta", true}, {"zeta", true}, {"S"},          {"R_over_S"},
                                               {"Y"},         {"U"},          {"dissipated"}, {"force"}};
  add_further_contacts(all);
  add_higher_harmonics(all);
  return all;
}

void NonlinearMode::observe(const Vector& u, const Vector& p, int regime, Vector& values) const {
  const Index m = contacts();
  const std::vector<ElementForce>& elements = forces(u, p, regime, false);
  values.resize(8 + 5 * (m - 1) + 3 * (harmonics() - 1));
  const Modal at_first = modal(u, p, regime);
  for (Index a = 0; a < harmonics(); ++a) {
    const double h = system_.orders[at(a)];
    const ContactVector damper =
        system_.damper[at(a)].damped(h * u(frequency), -2 * u(damping) * u(frequency)).compliance *
        coordinates_.forces_on(&Coordinate::damper, elements, a);
    for (Index i = 0; i < m; ++i) {
      const Complex r = motion(u, p, i)(a);
      const double S_i = threshold(i, u, p);
      const double energy = elements[at(i)].energy / (system_.contacts[at(i)].stiffness * S_i * S_i);
      if (a == 0 && i == 0) {
        values.head<8>() << u(frequency), u(damping), S_i, p(amplitude) / S_i, std::abs(damper(0) - r),
            std::abs(damper(0)), energy,
            2 * u(damping) * u(frequency) * u(frequency) * at_first.amplitude / at_first.load;
      } else if (a == 0) {
        values.segment<5>(8 + 5 * (i - 1)) << std::abs(r), std::abs(r) / S_i, std::abs(damper(i) - r),
            std::abs(damper(i)), energy;
      } else if (i == 0) {
        values.segment<3>(8 + 5 * (m - 1) + 3 * (a - 1)) << std::abs(r), std::abs(damper(0) - r),
            std::abs(damper(0));
      }
    }
  }
}

double NonlinearMode::observe(const Vector& u, const Vector& /*p*/, int /*regime*/, Index which,
                              continuation::Gradient& gradient) const {
  const Index unknown = which == eta ? frequency : damping;
  gradient.parameters.setZero();
  gradient.unknowns.setZero();
  gradient.unknowns(unknown) = 1;
  return u(unknown);
}

NonlinearMode::Modal NonlinearMode::modal(const Vector& u, const Vector& p, int regime) const {
  const std::vector<ElementForce>& elements = forces(u, p, regime, false);
  const double mass = -2 * u(damping) * u(frequency);
  double square = 0;
  Complex load = 0;
  const auto add = [&](const ContactModes& structure, double Coordinate::*entry) {
    const ContactVector on_dofs = coordinates_.forces_on(entry, elements, 0);
    for (const ContactMode& mode : structure.modes()) {
      const Complex d =
          ModalDenominator(u(frequency), mode.frequency, structure.loss() + Loss{.mass = mass}).value;
      const Complex q = mode.shape.dot(on_dofs) / d;
      square += std::norm(q);
      load += std::conj(q) * mode.load;
    }
  };
  add(system_.base[0], &Coordinate::base);
  add(system_.damper[0], &Coordinate::damper);
  return {std::sqrt(square), std::abs(load) / std::sqrt(square)};
}

std::optional<std::array<double, 2>> NonlinearMode::flanks(const Vector& u, const Vector& p, int regime,
                                                           double force_value) const {
  const Modal mode = modal(u, p, regime);
  const double square = u(frequency) * u(frequency);
  const double middle = square * (1 - 2 * u(damping) * u(damping));
  const double width =
      std::pow(force_value * mode.load / mode.amplitude, 2) - (square - middle) * (square + middle);
  if (!(width >= 0) || std::sqrt(width) > middle) return std::nullopt;
  return std::array{std::sqrt(middle - std::sqrt(width)), std::sqrt(middle + std::sqrt(width))};
}

continuation::Guess NonlinearMode::guess(double eta_value, double R_value, double preload_value) const {
  if (!(eta_value > 0 && R_value > 0 && preload_value > 0))
    throw std::invalid_argument("NonlinearMode: eta, R and the preload must be positive");
  Vector springs(contacts());
  for (Index i = 0; i < contacts(); ++i) springs(i) = system_.contacts[at(i)].stiffness;
  std::vector<JoinedMode> modes = joined_modes({&system_.base[0], &system_.damper[0]}, springs);
  constexpr double still = 1e-8;  // of the most that any mode moves it: rounding, as of both moving as one
  double most = 0;
  for (const JoinedMode& mode : modes) most = std::max(most, std::abs(mode.relative(0)));
  std::erase_if(modes, [&](const JoinedMode& mode) { return !(std::abs(mode.relative(0)) > still * most); });
  const auto nearest = std::min_element(modes.begin(), modes.end(), [&](const auto& one, const auto& other) {
    return std::abs(one.frequency - eta_value) < std::abs(other.frequency - eta_value);
  });
  if (nearest == modes.end())
    throw std::invalid_argument("NonlinearMode: there is no mode that moves the first contact");
  continuation::Guess guess{Vector::Zero(size()), Vector(2), 0};
  guess.parameters << R_value, preload_value;
  const ContactVector r = R_value / nearest->relative(0) * nearest->relative;
  const double mass = -2 * nearest->damping * nearest->frequency;
  const ContactVector f = springs.asDiagonal() * r;
  const ContactVector y = system_.base[0].damped(nearest->frequency, mass).compliance * f;
  const ContactVector u = -(system_.damper[0].damped(nearest->frequency, mass).compliance * f);
  for (Index i = 1; i < coordinates_.size(); ++i) {
    const Coordinate& one = coordinates_[i];
    const Complex x = i < contacts() ? r(i) : one.base * y(one.dof) + one.damper * u(one.dof);
    guess.unknowns(2 * i * harmonics()) = x.real();
    guess.unknowns(2 * i * harmonics() + 1) = x.imag();
  }
  guess.unknowns(frequency) = nearest->frequency;
  guess.unknowns(damping) = nearest->damping;
  for (Index i = 0; i < contacts(); ++i) {
    if (OddMotion(system_.orders, motion(guess.unknowns, guess.parameters, i)).maximum().value >
        threshold(i, guess.unknowns, guess.parameters))
      throw std::invalid_argument(
          fmt::format("NonlinearMode: contact {} slips at R = {:g}; begin with a smaller R", i + 1, R_value));
  }
  return guess;
}

}  // namespace arcslip::problems
