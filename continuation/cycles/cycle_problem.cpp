#include "arcslip/continuation/cycles/cycle_problem.hpp"

#include <cmath>

#include "arcslip/continuation/cycles/floquet.hpp"
#include "arcslip/continuation/cycles/orbit_observables.hpp"

namespace arcslip::continuation {

CycleProblem::CycleProblem(std::shared_ptr<const Field> field, const OrbitMesh& mesh, const Matrix& orbit,
                           const Vector& p, int periods)
    : PeriodicOrbit(field, !field->is_periodic()), periods_(periods), winding_(Vector::Zero(orbit.rows())) {
  for (Index i = 0; i < orbit.rows(); ++i) {
    if (const double turn = field->turn(i); turn > 0)
      winding_(i) = turn * std::round((orbit(i, orbit.cols() - 1) - orbit(i, 0)) / turn);
  }
  begin(mesh, orbit, p);
}

/// What its halves differ by, halved: of this nothing is left at an equilibrium, either.
Matrix CycleProblem::part_apart(const OrbitFrame& frame, const Eigen::Ref<const Matrix>& orbit) const {
  if (!has_duration() && periods_ % 2 != 0) return {};
  Matrix part = frame.mesh.at(orbit, frame.points) - frame.mesh.at(orbit, frame.opposite);
  part += winding_ * (frame.opposite.s - frame.points.s).transpose();
  return 0.5 * part;
}

std::shared_ptr<CycleProblem> CycleProblem::on_intervals(const Vector& u, const Vector& p,
                                                         const Regime& regime, Vector& unknowns) const {
  constexpr Index least = 20;
  const OrbitMesh mesh(CollocationRule(CollocationRule::most), std::max(least, 2 * resolution()));
  const Matrix carried = frame(regime).mesh.carried(orbit(u), mesh);
  unknowns.resize(carried.size() + (has_duration() ? 1 : 0));
  unknowns.head(carried.size()) = carried.reshaped();
  if (has_duration()) unknowns.tail(1) = u.tail(1);
  return std::make_shared<CycleProblem>(shared_field(), mesh, carried, p, periods_);
}

OrbitMesh CycleProblem::mesh_of_two(const OrbitMesh& once) const {
  Vector borders(2 * once.intervals() + 1);
  borders << 0.5 * once.borders(), 0.5 + 0.5 * once.borders().tail(once.intervals()).array();
  return {once.rule(), borders};
}

Matrix CycleProblem::two_rounds(const Matrix& once, double sign) const {
  const Index further = once.cols() - 1;
  Matrix both(once.rows(), once.cols() + further);
  both << once, sign * once.rightCols(further);
  if (sign > 0) both.rightCols(further).colwise() += winding_;
  return both;
}

bool CycleProblem::end_conditions(const Vector& left, const Vector& right, const Vector& /*p*/,
                                  const EndConditions& out) const {
  if (out.values != nullptr) *out.values = right - left - winding_;
  if (out.by_left != nullptr) *out.by_left = -Matrix::Identity(left.size(), left.size());
  if (out.by_right != nullptr) out.by_right->setIdentity();
  if (out.by_parameters != nullptr) out.by_parameters->setZero();
  return true;
}

double CycleProblem::given_duration(const Vector& p, Vector* by_parameters) const {
  const double period = field().period(p, by_parameters);
  if (by_parameters != nullptr) *by_parameters *= periods_;
  return periods_ * period;
}

ComplexVector CycleProblem::found_multipliers(const Vector& u, const Vector& p, const Regime& regime) const {
  if (!is_trigonometric()) return PeriodicOrbit::found_multipliers(u, p, regime);
  Vector unknowns;
  return on_intervals(u, p, regime, unknowns)->found_multipliers(unknowns, p, {});
}

ComplexVector CycleProblem::multipliers_by(const Vector& u, const Vector& p, const Regime& regime,
                                           const FactoredJacobian& jacobian) const {
  constexpr Index count = 20;
  if (has_duration() && field().size() == 2)  // in the plane the multiplier, over any number of decades
    return ComplexVector::Constant(1, growth_of_volumes(frame(regime), jacobian.entries));
  Matrix velocities;
  if (has_duration() && !find_velocities(u, p, velocities)) return {};
  if (field().sparse())
    return largest_log_multipliers(jacobian.entries, field().size(), intervals(), degree(), velocities,
                                   count);
  const std::vector<Matrix> factors = transfers(jacobian);
  return has_duration() ? log_multipliers_beside(factors, velocities)
                        : continuation::log_multipliers(factors);
}

bool CycleProblem::find_velocities(const Vector& u, const Vector& p, Matrix& out) const {
  out.resize(field().size(), intervals() + 1);
  Matrix ends(out.rows(), out.cols());
  for (Index j = 0; j < ends.cols(); ++j) ends.col(j) = orbit(u).col(j * degree());
  return field().evaluate_columns(Vector::Zero(ends.cols()), ends, p, {&out});
}

std::vector<Observable> CycleProblem::observables() const {
  std::vector<Observable> all{{duration_name(field().names(), parameter_names()), true}};
  for (const Observable& one : orbit_observables(*this)) all.push_back(one);
  return all;
}

void CycleProblem::observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  values.resize(1 + orbit_observables(*this).size());
  values(0) = duration(u, p);
  values.tail(values.size() - 1) = observed_on_orbit(*this, u, regime);
}

double CycleProblem::observe(const Vector& u, const Vector& p, const Regime& regime, Index which,
                             Gradient& gradient) const {
  gradient.unknowns.setZero();
  gradient.parameters.setZero();
  if (which > 0) return observed_on_orbit(*this, u, regime, which - 1, gradient);
  if (has_duration()) gradient.unknowns(size() - 1) = 1;
  return duration(u, p, &gradient.parameters);
}

}  // namespace arcslip::continuation
