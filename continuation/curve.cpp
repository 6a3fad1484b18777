#include "arcslip/continuation/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/continuation/border_problem.hpp"
#include "arcslip/continuation/branch_point_problem.hpp"
#include "arcslip/continuation/extremum_problem.hpp"
#include "arcslip/continuation/fold_problem.hpp"
#include "arcslip/continuation/hopf_problem.hpp"
#include "arcslip/continuation/normal_form.hpp"

namespace arcslip::continuation {
namespace {

const std::string end_of_window = "the window's end";

int nearest_border(const Problem& base, const BranchPoint& point) {
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int b = 0; b < base.border_count(point.regime); ++b) {
    const double value = std::abs(base.border(point.unknowns, point.parameters, point.regime, b, nullptr));
    if (!(value < least)) continue;
    least = value;
    nearest = b;
  }
  if (nearest < 0) throw std::invalid_argument("curve_through: the point's regime has no borders");
  if (!(least < 1e-6)) throw std::invalid_argument("curve_through: the point lies on no border");
  return nearest;
}

/// omega^2 of the pair that is nearest to the imaginary axis.
double kappa_of(const ComplexVector& eigenvalues) {
  double kappa = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const Complex& value : eigenvalues) {
    if (value.imag() == 0 || !(std::abs(value.real()) < least)) continue;
    least = std::abs(value.real());
    kappa = value.imag() * value.imag();
  }
  return kappa;
}

/// A half of the curve: the borders of its conditions follow it.
Branch trace_half(ExtendedProblem& problem, const Guess& start, bool towards_to, const TraceOptions& options,
                  const Observer& observer) {
  if (!problem.adapt(problem.split(start.unknowns, start.parameters, start.regime))) return {};
  const auto follow = [&](const BranchPoint& point) {
    return problem.adapt(problem.split(point.unknowns, point.parameters, point.regime)) &&
           (!observer || observer(point));
  };
  Branch half = trace_one_way(problem, start, towards_to, options, follow);
  if (half.points.empty() || half.points.back().label != end_of_window) return half;
  half.points.back().type = PointType::end;
  half.points.back().label.clear();
  half.stop = Stop::reached_end;
  half.explanation = fmt::format("{} reached an end of its range", problem.observables().front().name);
  return half;
}

}  // namespace

CurveStart curve_through(const Problem& base, const std::string& active, const BranchPoint& point,
                         const std::string& observable) {
  const Index parameter = index_of(base.parameter_names(), active);
  CurveStart start{nullptr, {point.unknowns, point.parameters, point.regime, {}}};
  switch (point.type) {
    case PointType::fold: start.problem = std::make_unique<FoldProblem>(base, parameter); break;
    case PointType::branch_point:
      start.problem = std::make_unique<BranchPointProblem>(base, parameter);
      start.point.extras = Vector::Zero(1);
      break;
    case PointType::hopf:
      start.problem = std::make_unique<HopfProblem>(base, parameter);
      start.point.extras = Vector::Constant(1, kappa_of(point.eigenvalues));
      break;
    case PointType::peak:
    case PointType::trough:
      start.problem =
          std::make_unique<ExtremumProblem>(base, parameter, index_of(observable_names(base), observable));
      break;
    case PointType::regime_switch:
    case PointType::corner_fold:
      start.problem = std::make_unique<BorderProblem>(base, parameter, nearest_border(base, point));
      break;
    default:
      throw std::invalid_argument(
          fmt::format("curve_through: no curve is made of points of type {}", to_string(point.type)));
  }
  return start;
}

Branch trace_curve(ExtendedProblem& problem, const BasePoint& start, const TraceOptions& options,
                   const CurveWindow& window, const Observer& observer) {
  const auto located = locate(problem, start, options.tolerance);
  if (!located) {
    Branch none;
    none.explanation = "no special point of this kind was found next to the start";
    return none;
  }
  Guess guess;
  problem.join(located->point, guess.unknowns, guess.parameters);
  guess.regime = start.regime;

  TraceOptions bounded = options;
  const Index active = problem.base().size();
  for (const double edge : {window.low, window.high}) {
    if (!std::isfinite(edge)) continue;
    bounded.events.push_back(
        {end_of_window, [=](const Vector& u, const Vector&, int) { return u(active) - edge; }});
  }
  if (bounded.events.size() > options.events.size())
    bounded.stop_after.push_back({PointType::event, 1, end_of_window});
  if (dynamic_cast<const HopfProblem*>(&problem) != nullptr)
    bounded.stop_after.push_back({PointType::bogdanov_takens, 1, {}});
  Branch second = trace_half(problem, guess, true, bounded, observer);
  if (second.stop == Stop::closed_loop || second.stop == Stop::no_start || second.stop == Stop::interrupted)
    return second;
  Branch first = trace_half(problem, guess, false, bounded, observer);
  // The reason that is told is the one that a user has to know.
  const bool first_matters = is_end(second.stop) && !is_end(first.stop);
  const std::string explanation = first.explanation;
  Branch whole = join(std::move(first), std::move(second));
  if (first_matters) {
    std::swap(whole.stop, *whole.first_stop);
    whole.explanation = explanation;
  }
  return whole;
}

}  // namespace arcslip::continuation
