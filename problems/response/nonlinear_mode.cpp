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

NonlinearMode::NonlinearMode(HarmonicSystem system) : system_(std::move(system)) { check(system_); }

HarmonicVector NonlinearMode::motion(const Vector& u, const Vector& p, Index contact) const {
  HarmonicVector r(harmonics());
  for (Index a = 0; a < harmonics(); ++a) {
    const Index place = 2 * (contact * harmonics() + a);
    r(a) = place == 0 ? Complex(p(amplitude)) : Complex(u(place), u(place + 1));
  }
  return r;
}

double NonlinearMode::load(const Vector& u, const Vector& p) const {
  return p(preload) + system_.preload_growth * u(frequency) * u(frequency);
}

double NonlinearMode::threshold(Index contact, const Vector& u, const Vector& p) const {
  return system_.contacts[at(contact)].slip_per_preload * load(u, p);
}

const std::vector<ContactForce>& NonlinearMode::forces(const Vector& u, const Vector& p, int regime,
                                                       bool derivatives) const {
  thread_local std::vector<ContactForce> all;
  all.resize(at(contacts()));
  for (Index i = 0; i < contacts(); ++i) {
    all[at(i)].set(system_.orders, motion(u, p, i), system_.contacts[at(i)].stiffness, threshold(i, u, p),
                   slips(regime, i), derivatives);
  }
  return all;
}

NonlinearMode::Order NonlinearMode::order(Index which, const Vector& u, int regime) const {
  const double h = system_.orders[at(which)];
  Order order{which, ContactMatrix::Zero(contacts(), contacts()), ContactMatrix::Zero(contacts(), contacts()),
              ContactMatrix::Zero(contacts(), contacts())};
  if (regime == 0 && which > 0) return order;  // r_h = 0, also where C_h has an undamped resonance
  for (const ContactModes* structure : {&system_.base[at(which)], &system_.damper[at(which)]}) {
    const DampedReceptance found = structure->damped(h * u(frequency), -2 * u(damping) * u(frequency));
    const ContactMatrix by_eta = h * found.compliance_eta - 2 * u(damping) * found.compliance_mass;
    const ContactMatrix by_zeta = -2 * u(frequency) * found.compliance_mass;
    order.compliance += found.compliance;
    order.compliance_eta += by_eta;
    order.compliance_zeta += by_zeta;
    for (Index j = 0; j < contacts(); ++j) {
      const double square = std::pow(system_.contacts[at(j)].stiffness, 2);
      order.norm += square * found.compliance.col(j).squaredNorm();
      order.norm_eta += 2 * square * std::real(found.compliance.col(j).dot(by_eta.col(j)));
      order.norm_zeta += 2 * square * std::real(found.compliance.col(j).dot(by_zeta.col(j)));
    }
  }
  return order;
}

bool NonlinearMode::evaluate(const Vector& u, const Vector& p, int regime,
                             const continuation::Evaluation& out) const {
  if (!(u(frequency) > 0 && p(amplitude) > 0 && p(preload) > 0 && load(u, p) > 0)) return false;
  for (Index i = 1; i < contacts(); ++i) {
    if (slips(regime, i) && motion(u, p, i).isZero(0)) return false;
  }
  const bool derivatives = out.jacobian != nullptr || out.parameter_jacobian != nullptr;
  const std::vector<ContactForce>& friction = forces(u, p, regime, derivatives);
  for (Index a = 0; a < harmonics(); ++a) {
    const Order at_order = order(a, u, regime);
    for (Index i = 0; i < contacts(); ++i) fill_row(at_order, i, friction, u, p, out);
  }
  return true;
}

void NonlinearMode::fill_row(const Order& order, Index contact, const std::vector<ContactForce>& friction,
                             const Vector& u, const Vector& p, const continuation::Evaluation& out) const {
  const Index n = harmonics();
  const Index row = 2 * (contact * n + order.which);
  const auto store = [row](Complex value, auto&& column) {
    column(row) = value.real();
    column(row + 1) = value.imag();
  };
  const double size = std::hypot(p(amplitude), u.tail(u.size() - 2).norm());
  const double weight = 1 / (std::sqrt(order.norm) * size);
  Complex residual = motion(u, p, contact)(order.which);
  Complex by_log_S = 0;
  for (Index j = 0; j < contacts(); ++j) {
    residual += order.compliance(contact, j) * friction[at(j)].harmonics(order.which);
    if (out.jacobian != nullptr || out.parameter_jacobian != nullptr)
      by_log_S += order.compliance(contact, j) * friction[at(j)].by_log_threshold(order.which);
  }
  if (out.residual != nullptr) store(weight * residual, *out.residual);

  const Complex shrink = residual / (size * size);
  // Derivatives by Re and Im of the harmonic that the unknowns from `column` on hold.
  const auto by_motion = [&](Index column) {
    const Index j = column / (2 * n);
    const Index b = column / 2 % n;
    const Complex c = order.compliance(contact, j);
    const Complex linear = c * friction[at(j)].linear(order.which, b) + (row == column ? 1.0 : 0.0);
    const Complex conjugate = c * friction[at(j)].conjugate(order.which, b);
    return std::array{linear + conjugate, Complex(0, 1) * (linear - conjugate)};
  };
  if (out.parameter_jacobian != nullptr) {
    store(weight * (by_motion(0)[0] - shrink * p(amplitude)), out.parameter_jacobian->col(amplitude));
    store(weight / load(u, p) * by_log_S, out.parameter_jacobian->col(preload));
  }
  if (out.jacobian == nullptr) return;
  Complex by_eta = by_log_S * (2 * system_.preload_growth * u(frequency) / load(u, p)) -
                   residual * (0.5 * order.norm_eta / order.norm);
  Complex by_zeta = -residual * (0.5 * order.norm_zeta / order.norm);
  for (Index j = 0; j < contacts(); ++j) {
    by_eta += order.compliance_eta(contact, j) * friction[at(j)].harmonics(order.which);
    by_zeta += order.compliance_zeta(contact, j) * friction[at(j)].harmonics(order.which);
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
  const SlipBorder at_border =
      slip_border(system_.orders, motion(u, p, border), threshold(border, u, p), slips(regime, border));
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
  const double by_load = at_border.by_log_threshold / load(u, p);
  gradient->parameters(preload) = by_load;
  gradient->unknowns(frequency) = 2 * system_.preload_growth * u(frequency) * by_load;
  return at_border.value;
}

std::vector<continuation::Observable> NonlinearMode::observables() const {
  std::vector<continuation::Observable> all = {{"eta", true}, {"zeta", true}, {"S"},          {"R_over_S"},
                                               {"Y"},         {"U"},          {"dissipated"}, {"force"}};
  for (Index i = 1; i < contacts(); ++i) {
    for (const char* name : {"R", "R_over_S", "Y", "U", "dissipated"})
      all.push_back({fmt::format("{}_contact_{}", name, i + 1)});
  }
  for (Index a = 1; a < harmonics(); ++a) {
    for (const char* name : {"R", "Y", "U"})
      all.push_back({fmt::format("{}_h{}", name, system_.orders[at(a)])});
  }
  return all;
}

void NonlinearMode::observe(const Vector& u, const Vector& p, int regime, Vector& values) const {
  const Index m = contacts();
  const std::vector<ContactForce>& friction = forces(u, p, regime, false);
  values.resize(8 + 5 * (m - 1) + 3 * (harmonics() - 1));
  const Modal at_first = modal(u, p, regime);
  ContactVector f(m);
  for (Index a = 0; a < harmonics(); ++a) {
    for (Index j = 0; j < m; ++j) f(j) = friction[at(j)].harmonics(a);
    const double h = system_.orders[at(a)];
    const ContactVector damper =
        -(system_.damper[at(a)].damped(h * u(frequency), -2 * u(damping) * u(frequency)).compliance * f);
    for (Index i = 0; i < m; ++i) {
      const Complex r = motion(u, p, i)(a);
      const double S_i = threshold(i, u, p);
      if (a == 0 && i == 0) {
        values.head<8>() << u(frequency), u(damping), S_i, p(amplitude) / S_i, std::abs(damper(0) - r),
            std::abs(damper(0)), friction[0].energy,
            2 * u(damping) * u(frequency) * u(frequency) * at_first.amplitude / at_first.load;
      } else if (a == 0) {
        values.segment<5>(8 + 5 * (i - 1)) << std::abs(r), std::abs(r) / S_i, std::abs(damper(i) - r),
            std::abs(damper(i)), friction[at(i)].energy;
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
  const std::vector<ContactForce>& friction = forces(u, p, regime, false);
  ContactVector f(contacts());
  for (Index j = 0; j < contacts(); ++j) f(j) = friction[at(j)].harmonics(0);
  const double mass = -2 * u(damping) * u(frequency);
  double square = 0;
  Complex load = 0;
  for (const ContactModes* structure : {&system_.base[0], &system_.damper[0]}) {
    for (const ContactMode& mode : structure->modes()) {
      const Complex d =
          ModalDenominator(u(frequency), mode.frequency, structure->loss() + Loss{.mass = mass}).value;
      const Complex q = mode.shape.dot(f) / d;
      square += std::norm(q);
      load += std::conj(q) * mode.load;
    }
  }
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
  for (Index i = 1; i < contacts(); ++i) {
    const Complex r = R_value * nearest->relative(i) / nearest->relative(0);
    guess.unknowns(2 * i * harmonics()) = r.real();
    guess.unknowns(2 * i * harmonics() + 1) = r.imag();
  }
  guess.unknowns(frequency) = nearest->frequency;
  guess.unknowns(damping) = nearest->damping;
  for (Index i = 0; i < contacts(); ++i) {
    if (slip_border(system_.orders, motion(guess.unknowns, guess.parameters, i),
                    threshold(i, guess.unknowns, guess.parameters), false)
            .value > 0)
      throw std::invalid_argument(
          fmt::format("NonlinearMode: contact {} slips at R = {:g}; begin with a smaller R", i + 1, R_value));
  }
  return guess;
}

}  // namespace arcslip::problems
