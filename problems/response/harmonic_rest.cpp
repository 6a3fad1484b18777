// The mean of what is free to move, which the elements alone hold.

#include <fmt/format.h>

#include "arcslip/dense.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"

namespace arcslip::problems {

/// What elements leave free in a regime, as it would be without one of them.
ComplexMatrix HarmonicProblem::loose(const continuation::Regime& regime, Index without) const {
  return rigid_.loose([&](Index i) {
    const Index e = coordinates_.element_of(i);
    return coordinates_.element(e).holds_mean(coordinates_[i].part, e == without || slips(regime, e));
  });
}

void HarmonicProblem::find_drifts() {
  if (rigid_.count() == 0) return;
  for (Index e = 0; e < switch_count(); ++e) {
    const ComplexMatrix free = loose({}, e);
    if (free.cols() != 1 || !coordinates_.let_alone(e)) continue;
    const ComplexVector ways = rigid_.moves() * free;
    const Complex own = ways(coordinates_.first(e));
    drifts_.push_back({e, free / own, (ways / own).real()});
  }
}

std::vector<const HarmonicProblem::Drift*> HarmonicProblem::drifting(
    const continuation::Regime& regime) const {
  std::vector<const Drift*> all;
  for (const Drift& drift : drifts_) {
    if (slips(regime, drift.element)) all.push_back(&drift);
  }
  return all;
}

std::optional<continuation::Regime> HarmonicProblem::regime_beyond(const continuation::Regime& regime,
                                                                   int border) const {
  const continuation::Regime beyond = regime.with(border, 1 - regime[border]);
  if (loose(beyond).cols() > std::ssize(drifting(beyond))) return std::nullopt;
  return beyond;
}

std::string HarmonicProblem::reason_of_end() const {
  if (rigid_.count() == 0) return {};
  const auto free = rigid_.name(ComplexMatrix::Identity(rigid_.count(), rigid_.count()));
  return fmt::format(
      "elements alone hold the mean of {}, which has none where none of them reaches so far or "
      "several that hold it together slip",
      free);
}

void HarmonicProblem::respond_at_rest(const Vector& u, const Vector& p, Rest& rest) const {
  Response base;
  Response damper;
  const Index order = rigid_.order();
  respond(system_.base[at(order)], true, order, u, p, base);
  respond(system_.damper[at(order)], false, order, u, p, damper);
  coordinates_.join(base, damper, rest.joint);
  if (!is_varied()) return;
  rest.by_varied.setZero(coordinates(), coordinates());
  coordinates_.add(base.by_varied, true, rest.by_varied);
  coordinates_.add(damper.by_varied, false, rest.by_varied);
  rest.free_by_varied.resize(coordinates());
  for (Index i = 0; i < coordinates(); ++i)
    rest.free_by_varied(i) = -coordinates_[i].base * base.free_by_varied(coordinates_[i].dof);
}

ContactVector HarmonicProblem::moved_at_rest(const Rest& rest, const std::vector<ElementForce>& elements,
                                             const Vector& u, const Vector& p) const {
  ContactVector force(coordinates());
  ContactVector moved = rest.joint.free;
  for (Index i = 0; i < coordinates(); ++i) {
    force(i) = elements[at(coordinates_.element_of(i))].harmonics(place(i, rigid_.order()));
    moved(i) += motion(u, p, i)(rigid_.order()).real();
  }
  return moved + rest.joint.compliance * force;
}

ComplexMatrix HarmonicProblem::drift_ways(const continuation::Regime& regime) const {
  const auto drifting = this->drifting(regime);
  if (drifting.empty()) return ComplexMatrix::Zero(coordinates_.size(), rigid_.count());
  ComplexMatrix ways(coordinates_.size(), std::ssize(drifting));
  ComplexMatrix motions(rigid_.count(), ways.cols());
  for (Index d = 0; d < ways.cols(); ++d) {
    ways.col(d) = drifting[at(d)]->ways.cast<Complex>();
    motions.col(d) = drifting[at(d)]->motion;
  }
  return ways * pseudo_inverse(motions);
}

ComplexMatrix HarmonicProblem::changes_by_mean(const std::vector<ElementForce>& elements,
                                               const continuation::Regime& regime, const Vector& u,
                                               const Vector& p) const {
  const Index n = harmonics();
  const Index m = coordinates_.size();
  const ComplexMatrix ways = drift_ways(regime);
  ComplexMatrix changes = ComplexMatrix::Zero(2 * n * m, rigid_.count());
  for (Index from = 0; from < m; ++from) {
    const Index of = coordinates_.element_of(from);
    const Index by = place(from, rigid_.order());
    const ElementForce& element = elements[at(of)];
    const double stiffness = reference_stiffness(from, u, p);
    const ComplexVector by_mean = (element.linear.col(by) + element.conjugate.col(by)) / stiffness;
    const ComplexVector by_drift = (element.linear.col(by) - element.conjugate.col(by)) / stiffness;
    const Index first = n * coordinates_.first(of);
    changes.middleRows(first, by_mean.size()) += by_mean * rigid_.moves().row(from);
    changes.middleRows(n * m + first, by_drift.size()) += by_drift * ways.row(from);
  }
  return changes;
}

bool HarmonicProblem::holds_mean(const ComplexMatrix& changes) const {
  constexpr double rounding = 1e-12;
  return least_pivot(changes) > rounding * rigid_.moves().norm();
}

/// (h, -alpha) of h = (1 + C_0 K)^{-1} (x_0 - f_0 - x0_0 - S alpha), S^H K h = -l, is one linear equation.
void HarmonicResponse::border_by_rigid(Order& order, const Vector& p) const {
  const Index m = coordinates_.size();
  const Index n = rigid_.count();
  ContactReceptance& joint = order.joint;
  const auto widened = [&](ContactMatrix& matrix) {
    matrix.conservativeResizeLike(ContactMatrix::Zero(m + n, m + n));
  };
  const auto lengthened = [&](ContactVector& vector, double load) {
    vector.conservativeResize(m + n);
    vector.tail(n) = -load * rigid_.load();
  };
  widened(joint.compliance);
  widened(joint.compliance_eta);
  lengthened(joint.free, is_varied() ? variation({}, p).here.base.load : 1);
  lengthened(joint.free_eta, 0);
  joint.compliance.topRightCorner(m, n) = rigid_.moves();
  joint.compliance.bottomLeftCorner(n, m) = rigid_.moves().adjoint() * order.stiffness.asDiagonal();
  if (is_varied()) {
    const SystemParameter::At varied = variation({}, p);
    widened(order.by_varied);
    lengthened(order.free_by_varied, varied.rate.base.load);
    for (Index j = 0; j < m; ++j)
      order.by_varied.col(j).tail(n) =
          joint.compliance.col(j).tail(n) * log_force_rate(coordinates_.element_of(j), varied);
  }
  order.bordered = joint.compliance;
  invert(order.bordered);
  order.inverse = order.bordered.topLeftCorner(m, m);
}

/// Whether forces change with every rigid motion of the mean, or with a drift in its place: else it is
/// anywhere, or nowhere.
bool HarmonicResponse::remembers_mean(const std::vector<ElementForce>& elements, const Vector& p,
                                      const continuation::Regime& regime) const {
  if (rigid_.count() == 0) return true;
  ComplexMatrix changes = changes_by_mean(elements, regime, {}, p);
  changes.conservativeResize(changes.rows() + rigid_.count(), Eigen::NoChange);
  changes.bottomRows(rigid_.count()) = drag(p) * drift_ways(regime);
  return holds_mean(changes);
}

/// Puts drifts, which the imaginary parts of means are, into the balance of rigid motions.
void HarmonicResponse::take_drifts(Order& order, const Vector& u, const Vector& p, Rows& rows) const {
  const Index m = coordinates_.size();
  const ComplexMatrix by_drift = drag(p);
  ComplexVector drifts(m);
  for (Index j = 0; j < m; ++j) {
    drifts(j) = u(2 * (j * harmonics() + order.which) + 1);
    order.gap(j).imag(0);
  }
  rows.drag = by_drift * drifts;
  order.gap.tail(rows.drag.size()) += rows.drag;
  rows.by_drag =
      order.weight / u.norm() * (order.bordered.topRightCorner(m, rows.drag.size()) * by_drift).real();
}

/// In place of the equation that makes the imaginary parts of means 0, which rigid motions leave singular:
/// they are those that go on, and of these the mean is 0.
void HarmonicResponse::set_drifts(const Vector& u, Rows& rows, Matrix* jacobian) const {
  const Matrix& goes_on = rows.drifts;
  const Index m = coordinates_.size();
  const Matrix stays = Matrix::Identity(m, m) - goes_on;
  const double weight = 1 / u.norm();
  const auto place = [&](Index i) { return 2 * (i * harmonics() + rigid_.order()); };
  for (Index i = 0; i < m; ++i) {
    double value = 0;
    for (Index j = 0; j < m; ++j) value += goes_on(i, j) * u(place(j)) + stays(i, j) * u(place(j) + 1);
    rows.residual(place(i) + 1) = weight * value;
    if (jacobian == nullptr) continue;
    jacobian->row(place(i) + 1) = -weight * weight * weight * value * u.transpose();
    for (Index j = 0; j < m; ++j) {
      (*jacobian)(place(i) + 1, place(j)) += weight * goes_on(i, j);
      (*jacobian)(place(i) + 1, place(j) + 1) += weight * stays(i, j);
      (*jacobian)(place(i), place(j) + 1) += rows.by_drag(i, j);
    }
  }
}

Matrix HarmonicProblem::onto_drifts(const continuation::Regime& regime) const {
  if (rigid_.count() == 0) return {};
  const auto drifting = this->drifting(regime);
  if (drifting.empty()) return Matrix::Zero(coordinates_.size(), coordinates_.size());
  Matrix ways(coordinates_.size(), std::ssize(drifting));
  for (Index d = 0; d < ways.cols(); ++d) ways.col(d) = drifting[at(d)]->ways;
  return ways * pseudo_inverse(ways);
}

/// What the damping of masses takes of the forces on rigid motions, per drift of the coordinates.
ComplexMatrix HarmonicResponse::drag(const Vector& p) const {
  const auto loss = [&](const ContactModes& structure) { return structure.loss().part_eta(0); };
  const Vector each =
      rigid_.of_each(loss(system_.base[at(rigid_.order())]), loss(system_.damper[at(rigid_.order())]));
  return (p(eta) / system_.periods() * each).asDiagonal() * rigid_.parts();
}

}  // namespace arcslip::problems
