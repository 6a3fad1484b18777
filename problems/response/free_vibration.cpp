#include "arcslip/problems/response/free_vibration.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace arcslip::problems {

/// One harmonic of the linear part, with derivatives in eta and in the damping.
struct FreeVibration::Order {
  Index which;
  ContactMatrix compliance;  // C_h
  ContactMatrix compliance_eta;
  ContactMatrix compliance_damping;
  ContactMatrix compliance_varied;
  Matrix drifts = {};  // onto those that go on, of the mean
  double norm = 1;     // 1 + |C_B K|^2 + |C_D K|^2, of the terms that may cancel in C_h K
  double norm_eta = 0;
  double norm_damping = 0;
  double norm_varied = 0;
};

FreeVibration::FreeVibration(HarmonicSystem system, Layout layout)
    : HarmonicProblem(std::move(system), layout), is_odd_(all_odd(system_.orders)) {
  if (rigid_.count() == 0) return;
  double stiffest = 0;
  for (Index j = 0; j < coordinates_.size(); ++j) {
    const Element& element = coordinates_.element(coordinates_.element_of(j));
    stiffest = std::max(stiffest, element.reference_stiffness(coordinates_[j].part));
  }
  const ContactMatrix moved = rigid_.moves() * rigid_.parts();
  still_ = ContactMatrix::Identity(coordinates_.size(), coordinates_.size()) - moved;
  held_ = moved / stiffest;
  const auto mean = static_cast<std::size_t>(rigid_.order());
  for (const Loss& loss : {system_.base[mean].loss(), system_.damper[mean].loss(), system_.base_loss_per_zeta,
                           system_.base_loss_fixed})
    damps_masses_ = damps_masses_ || loss.mass != 0;
}

/// What a row has of the motion itself.
Complex FreeVibration::own(const Order& order, Index coordinate, const Vector& u, const Vector& p) const {
  if (!is_moved(order.which)) return motion(u, p, coordinate)(order.which);
  Complex sum = 0;
  for (Index j = 0; j < coordinates_.size(); ++j) {
    const auto [real, imaginary] = own_rates(order, coordinate, j);
    const Complex x = motion(u, p, j)(order.which);
    sum += real * x.real() + imaginary * x.imag();
  }
  return sum;
}

/// How that changes with Re and Im of the motion of a coordinate. The mean's imaginary parts are drifts that
/// go on, and of these the mean is 0.
std::array<Complex, 2> FreeVibration::own_rates(const Order& order, Index coordinate, Index by) const {
  const double same = coordinate == by ? 1 : 0;
  if (!is_moved(order.which)) return {same, Complex(0, same)};
  const double goes_on = order.drifts(coordinate, by);
  return {Complex(still_(coordinate, by).real(), goes_on), Complex(0, same - goes_on)};
}

/// The unknowns that are no motion stand in front.
double FreeVibration::length(const Vector& u, const Vector& p) const {
  return std::hypot(amplitude(u, p), u.tail(u.size() - 2).norm());
}

FreeVibration::Order FreeVibration::order(Index which, const Vector& u, const Vector& p,
                                          const continuation::Regime& regime) const {
  const Index m = coordinates_.size();
  const ContactMatrix none = ContactMatrix::Zero(m, m);
  Order order{which, none, none, none, none};
  if (all_stick(regime) && is_odd_ && which > 0 && !coordinates_.has_others())
    return order;  // x_h = 0, also at a resonance of C_h
  const auto add = [&](const ContactModes& structure, bool is_base) {
    Response found;
    respond(structure, is_base, which, u, p, found);
    const auto in_coordinates = [&](const ContactMatrix& matrix) {
      ContactMatrix sum = ContactMatrix::Zero(m, m);
      coordinates_.add(matrix, is_base, sum);
      return sum;
    };
    const ContactMatrix compliance = in_coordinates(found.compliance);
    const ContactMatrix by_eta = in_coordinates(found.compliance_eta);
    const ContactMatrix by_damping = in_coordinates(found.by_damping);
    order.compliance += compliance;
    order.compliance_eta += by_eta;
    order.compliance_damping += by_damping;
    if (is_varied()) {
      const ContactMatrix by_varied = in_coordinates(found.by_varied);
      order.compliance_varied += by_varied;
      const SystemParameter::At varied = variation(u, p);
      for (Index j = 0; j < m; ++j) {
        const double square = std::pow(reference_stiffness(j, u, p), 2);
        order.norm_varied +=
            2 * square *
            (std::real(compliance.col(j).dot(by_varied.col(j))) +
             log_force_rate(coordinates_.element_of(j), varied) * compliance.col(j).squaredNorm());
      }
    }
    for (Index j = 0; j < m; ++j) {
      const double square = std::pow(reference_stiffness(j, u, p), 2);
      order.norm += square * compliance.col(j).squaredNorm();
      order.norm_eta += 2 * square * std::real(compliance.col(j).dot(by_eta.col(j)));
      order.norm_damping += 2 * square * std::real(compliance.col(j).dot(by_damping.col(j)));
    }
  };
  add(system_.base[at(which)], true);
  add(system_.damper[at(which)], false);
  if (!is_moved(which)) return order;
  order.drifts = onto_drifts(regime);
  order.compliance = still_ * order.compliance + held_;
  order.compliance_eta = still_ * order.compliance_eta;
  order.compliance_damping = still_ * order.compliance_damping;
  order.compliance_varied = still_ * order.compliance_varied;
  return order;
}

bool FreeVibration::evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                             const continuation::Evaluation& out) const {
  if (!(frequency(u, p) > 0 && amplitude(u, p) > 0 && value(layout_.preload, u, p) > 0 &&
        (!is_varied() || system_.varied->allows(value(layout_.varied, u, p))) && pressing(u, p) > 0))
    return false;
  for (Index e = 1; e < switch_count(); ++e) {
    if (slips(regime, e) && element_motion(u, p, e).isZero(0)) return false;
  }
  const bool derivatives = out.jacobian != nullptr || out.parameter_jacobian != nullptr;
  if (damps_masses_ && drifts(regime)) return false;
  const std::vector<ElementForce>& elements = forces(u, p, regime, derivatives);
  if (derivatives && rigid_.count() > 0 && !holds_mean(changes_by_mean(elements, regime, u, p))) return false;
  for (Index a = 0; a < harmonics(); ++a) {
    const Order at_order = order(a, u, p, regime);
    for (Index i = 0; i < coordinates_.size(); ++i) fill_row(at_order, i, elements, u, p, out);
  }
  return true;
}

/// The derivative of a row but for its weight by the further parameter.
Complex FreeVibration::by_varied(const Order& order, Index coordinate,
                                 const std::vector<ElementForce>& elements, Complex residual, const Vector& u,
                                 const Vector& p) const {
  const SystemParameter::At varied = variation(u, p);
  Complex sum = -residual * (0.5 * order.norm_varied / order.norm);
  for (Index j = 0; j < coordinates_.size(); ++j) {
    const Index e = coordinates_.element_of(j);
    const ElementForce& element = elements[at(e)];
    const Index row = place(j, order.which);
    Complex force_rate = element.by_log_load(row) * log_load_rate(e, u, p) +
                         element.harmonics(row) * log_force_rate(e, varied);
    if (element.by_setting.size() > 0) force_rate += element.by_setting(row);
    sum += order.compliance_varied(coordinate, j) * element.harmonics(row) +
           order.compliance(coordinate, j) * force_rate;
  }
  return sum;
}

void FreeVibration::fill_row(const Order& order, Index coordinate, const std::vector<ElementForce>& elements,
                             const Vector& u, const Vector& p, const continuation::Evaluation& out) const {
  const Index n = harmonics();
  const Index row = 2 * (coordinate * n + order.which);
  const auto store = [row](Complex value, auto&& column) {
    column(row) = value.real();
    column(row + 1) = value.imag();
  };
  const double size = length(u, p);
  const double weight = 1 / (std::sqrt(order.norm) * size);
  Complex residual = own(order, coordinate, u, p);
  for (Index j = 0; j < coordinates_.size(); ++j)
    residual += order.compliance(coordinate, j) *
                elements[at(coordinates_.element_of(j))].harmonics(place(j, order.which));
  if (out.residual != nullptr) store(weight * residual, *out.residual);
  if (out.jacobian == nullptr && out.parameter_jacobian == nullptr) return;

  const auto store_at = [&](const Place& place, Complex value) {
    Matrix* into = place.of == Place::unknowns     ? out.jacobian
                   : place.of == Place::parameters ? out.parameter_jacobian
                                                   : nullptr;
    if (into != nullptr) store(weight * value, into->col(place.index));
  };
  Complex by_log_load = 0;
  Complex by_eta = -residual * (0.5 * order.norm_eta / order.norm);
  Complex by_damping = -residual * (0.5 * order.norm_damping / order.norm);
  for (Index j = 0; j < coordinates_.size(); ++j) {
    const ElementForce& element = elements[at(coordinates_.element_of(j))];
    const Index at_row = place(j, order.which);
    const Complex force = element.harmonics(at_row);
    by_log_load += order.compliance(coordinate, j) * element.by_log_load(at_row);
    by_eta += order.compliance_eta(coordinate, j) * force;
    if (element.by_eta.size() > 0) by_eta += order.compliance(coordinate, j) * element.by_eta(at_row);
    by_damping += order.compliance_damping(coordinate, j) * force;
  }
  if (is_varied()) store_at(layout_.varied, by_varied(order, coordinate, elements, residual, u, p));
  const Complex by_load = by_log_load / pressing(u, p);
  store_at(layout_.preload, by_load);
  store_at(layout_.eta, by_eta + by_load * (2 * growth(u, p) * frequency(u, p)));
  store_at(layout_.damping, by_damping);

  const Complex shrink = residual / (size * size);
  // Derivatives by Re and Im of the harmonic that the unknowns from `column` on hold.
  const auto by_motion = [&](Index column) {
    const Index of = coordinates_.element_of(column / (2 * n));
    const Index by = place(column / (2 * n), column / 2 % n);
    const Index first = coordinates_.first(of);
    Complex linear = 0;
    Complex conjugate = 0;
    for (Index j = first; j < first + coordinates_.element(of).coordinates(); ++j) {
      linear += order.compliance(coordinate, j) * elements[at(of)].linear(place(j, order.which), by);
      conjugate += order.compliance(coordinate, j) * elements[at(of)].conjugate(place(j, order.which), by);
    }
    std::array<Complex, 2> rates{linear + conjugate, Complex(0, 1) * (linear - conjugate)};
    if (column / 2 % n != order.which) return rates;
    const auto [real, imaginary] = own_rates(order, coordinate, column / (2 * n));
    return std::array<Complex, 2>{real + rates[0], imaginary + rates[1]};
  };
  store_at(layout_.real, by_motion(0)[0] - shrink * amplitude(u, p));
  for (Index column = 2; column < u.size() && out.jacobian != nullptr; column += 2) {
    const auto [real, imaginary] = by_motion(column);
    store(weight * (real - shrink * u(column)), out.jacobian->col(column));
    store(weight * (imaginary - shrink * u(column + 1)), out.jacobian->col(column + 1));
  }
}

}  // namespace arcslip::problems
