#include "arcslip/continuation/curves/cycle_curves.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/curves/meeting_curves.hpp"
#include "arcslip/continuation/cycles/cycle_branch.hpp"
#include "arcslip/continuation/cycles/torus_problem.hpp"
#include "arcslip/continuation/linear/borders.hpp"
#include "arcslip/continuation/points/codimension_two.hpp"
#include "arcslip/continuation/points/fold_problem.hpp"
#include "arcslip/continuation/points/hopf_problem.hpp"

namespace arcslip::continuation {
namespace {

/// From a small cycle, or a small difference of two rounds, which grows along the direction.
template <class Special>
OrbitCurveStart from_small(const auto& orbit, Index active, const Vector& extras) {
  const Guess& guess = orbit.guess;
  OrbitCurveStart start;
  start.orbits = orbit.problem;
  start.make = [active](const OrbitProblem& others, const BasePoint& /*at*/) {
    return std::make_unique<Special>(others, active);
  };
  start.point = {guess.unknowns, guess.parameters, guess.regime, extras};
  start.direction = Vector::Zero(guess.direction.size() + 1 + extras.size());
  start.direction.head(guess.direction.size()) = guess.direction;
  return start;
}

double coefficient(const NormalForm& form, const std::string& name) {
  const auto found = std::find_if(form.coefficients.begin(), form.coefficients.end(),
                                  [&](const Coefficient& one) { return one.name == name; });
  return found == form.coefficients.end() ? std::nan("") : found->value;
}

/// A number, unless it is none.
std::optional<double> known(double number) {
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

}  // namespace

std::vector<OrbitCurveStart> cycle_curves_from(const std::shared_ptr<const Field>& field,
                                               const ExtendedProblem& curve, const BranchPoint& point,
                                               const OrbitOptions& options) {
  if (dynamic_cast<const HopfProblem*>(&curve) == nullptr) return {};
  const BasePoint at = curve.split(point.unknowns, point.parameters, point.regime);
  const Guess there{at.unknowns, at.parameters, at.regime, {}};
  const double own = std::sqrt(std::max(0.0, at.extras(0)));
  const auto form = codimension_two_form(curve, curve.active(), point);
  const auto number = [&](const char* name) { return form ? coefficient(*form, name) : std::nan(""); };
  std::vector<OrbitCurveStart> starts;
  const auto add_tori = [&](const SmallCycle& cycle, double turn) {
    starts.push_back(
        from_small<TorusProblem>(cycle.start, curve.active(), Vector::Constant(1, std::cos(turn))));
  };
  switch (point.type) {
    case PointType::generalized_hopf: {
      constexpr double apart = 1e-8;  // both cycles' growth in a radian: far above rounding
      const double size = std::pow(apart / std::abs(number("l2")), 0.25);
      const SmallCycle cycle = cycle_of_pair(field, there, own, known(size), options);
      starts.push_back(from_small<FoldProblem>(cycle.start, curve.active(), Vector()));
      break;
    }
    case PointType::hopf_hopf: {
      ComplexVector values;
      if (!curve.base().eigenvalues(at.unknowns, at.parameters, at.regime, values)) break;
      remove_nearest(values, Complex(0, own));
      remove_nearest(values, Complex(0, -own));
      const double other = std::sqrt(kappa_of(values));
      if (!(own > 0 && other > 0)) break;
      add_tori(cycle_of_pair(field, there, own, {}, options), two_pi * other / own);
      add_tori(cycle_of_pair(field, there, other, {}, options), two_pi * own / other);
      break;
    }
    case PointType::zero_hopf: {  // the null vector and |w| oscillate with omega_2^2 = -2 c d |w|^2
      constexpr double turn = 0.2;
      const double rate = std::sqrt(-2 * number("c") * number("d"));
      if (!(rate > 0)) break;
      const SmallCycle cycle = cycle_of_pair(field, there, own, turn * own / (two_pi * rate), options);
      add_tori(cycle, two_pi / own * rate * cycle.size);
      break;
    }
    default: break;
  }
  return starts;
}

std::vector<OrbitCurveStart> cycle_curves_meeting(const ExtendedProblem& curve, const BranchPoint& point) {
  const auto* cycles = dynamic_cast<const PeriodicOrbit*>(&curve.base());
  if (cycles == nullptr) return {};
  const BasePoint at = curve.split(point.unknowns, point.parameters, point.regime);
  if (point.type == PointType::generalized_period_doubling) {
    constexpr double far = 0.03;  // of the range
    BranchPoint doubling;
    doubling.unknowns = at.unknowns;
    doubling.parameters = at.parameters;
    doubling.regime = at.regime;
    const auto both = orbit_from_doubling(*cycles, curve.active(), doubling, far);
    if (!both) return {};
    return {from_small<FoldProblem>(*both, curve.active(), Vector())};
  }
  const auto other = multiplier_curve_meeting(curve, point.type, at);
  if (!other) return {};
  const auto make = [make = other->make](const OrbitProblem& orbits, const BasePoint& /*at*/) {
    return make(orbits);
  };
  return {{about(*cycles, at.unknowns, at.parameters, at.regime),
           make,
           {at.unknowns, at.parameters, {}, other->extras},
           {}}};
}

}  // namespace arcslip::continuation
