#include "arcslip/continuation/cycles/periodic_orbit.hpp"

#include <cmath>

#include "arcslip/continuation/cycles/floquet.hpp"
#include "arcslip/continuation/cycles/torus_problem.hpp"
#include "arcslip/continuation/problem/guess.hpp"

namespace arcslip::continuation {

/// What is left of one that shrinks is all but a sine.
bool PeriodicOrbit::is_two_rounds(const Vector& u, const Regime& regime) const {
  return !has_duration() || is_nearly_simpler(u, regime);
}

std::string PeriodicOrbit::end_of_kind(const Vector& u, const Regime& regime) const {
  return is_two_rounds(u, regime) ? "the cycle becomes two rounds of one of half the period"
                                  : "the cycle shrinks onto an equilibrium";
}

std::atomic<long> PeriodicOrbit::made_ = 0;

/// Stability and period doublings are asked for one after the other, at the end of a step and as it is taken.
struct PeriodicOrbit::Last {
  long problem = 0;  // its number
  Vector unknowns;
  Vector parameters;
  Regime regime;
  ComplexVector logs;
};

PeriodicOrbit::Last& PeriodicOrbit::last() {
  thread_local Last last;
  return last;
}

bool PeriodicOrbit::is_last(const Vector& u, const Vector& p, const Regime& regime) const {
  const Last& known = last();
  return known.problem == number_ && known.regime == regime && known.unknowns == u && known.parameters == p;
}

ComplexVector PeriodicOrbit::log_multipliers(const Vector& u, const Vector& p, const Regime& regime) const {
  if (!is_last(u, p, regime)) last() = {number_, u, p, regime, found_multipliers(u, p, regime)};
  return last().logs;
}

void PeriodicOrbit::take_jacobian(const Vector& u, const Vector& p, const Regime& regime,
                                  const FactoredJacobian& jacobian) const {
  if (!is_last(u, p, regime)) last() = {number_, u, p, regime, multipliers_by(u, p, regime, jacobian)};
}

ComplexVector PeriodicOrbit::found_multipliers(const Vector& u, const Vector& p, const Regime& regime) const {
  SparseMatrix jacobian;
  Evaluation out;
  out.sparse_jacobian = &jacobian;
  if (!evaluate(u, p, regime, out)) return {};
  return multipliers_by(u, p, regime, {jacobian});
}

bool PeriodicOrbit::eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                                ComplexVector& values) const {
  values = exponents(log_multipliers(u, p, regime), period(u, p));
  return values.size() > 0 && values.allFinite();
}

void PeriodicOrbit::test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const {
  const ComplexVector logs = log_multipliers(u, p, regime);
  values.setConstant(1, logs.size() == 0 && most_multipliers() > 0 ? std::nan("") : doubling_test(logs));
}

std::unique_ptr<ExtendedProblem> PeriodicOrbit::special(PointType type, Index active, const Guess& at,
                                                        Vector& extras) const {
  if (is_trigonometric()) return nullptr;
  return special_of_multipliers(*this, type, active, log_multipliers(at.unknowns, at.parameters, at.regime),
                                extras);
}

ComplexVector log_multipliers(const Problem& problem, const Linearization& at, const BasePoint& point) {
  if (const auto* orbits = dynamic_cast<const PeriodicOrbit*>(&problem))
    return orbits->log_multipliers(point.unknowns, point.parameters, point.regime);
  if (!problem.is_map() || at.sparse()) return {};
  return log_multipliers({at.jacobian() + Matrix::Identity(problem.size(), problem.size())});
}

ComplexVector log_multipliers_anew(const Problem& problem, Linearization& at, const BasePoint& point) {
  const bool is_known = dynamic_cast<const PeriodicOrbit*>(&problem) != nullptr ||
                        at.evaluate(point.unknowns, point.parameters, point.regime);
  return is_known ? log_multipliers(problem, at, point) : ComplexVector();
}

ComplexVector rates_of(const Problem& problem, const ComplexVector& logs, const BasePoint& point) {
  const auto* orbits = dynamic_cast<const PeriodicOrbit*>(&problem);
  return exponents(logs, orbits == nullptr ? 1 : orbits->period(point.unknowns, point.parameters));
}

Index count_beside_duration(const Problem& problem) {
  const auto* orbits = dynamic_cast<const PeriodicOrbit*>(&problem);
  return problem.size() - (orbits != nullptr && orbits->has_duration() ? 1 : 0);
}

}  // namespace arcslip::continuation
