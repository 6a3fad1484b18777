#include "arcslip/continuation/curves/extremum_curve.hpp"

#include <cmath>

#include "arcslip/continuation/curves/extremum_tracer.hpp"
#include "arcslip/continuation/curves/half_curve.hpp"
#include "arcslip/continuation/curves/response_extremum.hpp"
#include "arcslip/continuation/points/normal_form.hpp"

namespace arcslip::continuation {

namespace {

bool is_outside(const ExtendedProblem& problem, const BasePoint& at) {
  constexpr double rounding = 1e-9;
  return crossed_border(problem.base(), at.unknowns, at.parameters, at.regime, rounding) >= 0;
}

/// The extremum next to a point, of either kind, without second derivatives.
std::optional<BasePoint> bracketed(const ExtendedProblem& problem, const BasePoint& point, double farthest) {
  ResponseExtremum extrema(problem.base(), problem.active(), *problem.extremum_of());
  if (!extrema.begin(point)) return std::nullopt;
  for (const bool peak : {true, false}) {
    if (const auto found = extrema.next_to(point, peak, farthest)) return found->at;
  }
  return std::nullopt;
}

}  // namespace

Branch trace_extrema(ExtendedProblem& problem, const BasePoint& start, const TraceOptions& options,
                     const CurveWindow& window, const Observer& observer) {
  const long before = problem.evaluations();
  const auto nearest = nearest_border(problem.base(), problem.active(), start, start.regime);
  const bool corner = nearest && std::abs(nearest->distance) <= options.tolerances.together;
  std::optional<LocatedPoint> located;
  if (corner) {
    BorderProblem edge(problem.base(), problem.active(), nearest->border);
    located = locate(edge, start, options.tolerance);
  } else {
    located = locate(problem, start, options.tolerance);
  }
  const long to_locate = problem.evaluations() - before;
  if (!corner && (!located || is_outside(problem, located->point))) {
    if (const auto found = bracketed(problem, start, options.tolerances.beside_extremum))
      located = LocatedPoint{*found};
  }
  if (!located) {
    Branch none;
    none.explanation = "no special point of this kind was found next to the start";
    return none;
  }
  const TimeBudget time(options);
  Guess guess;
  problem.join(located->point, guess.unknowns, guess.parameters);
  guess.regime = start.regime;
  const auto half = [&](bool towards_to, const TraceOptions& rest) {
    return ExtremumTracer(problem, rest, window, observer).half(located->point, corner, towards_to);
  };
  Branch curve =
      trace_parts([&] { return half(true, options); }, [&] { return half(false, time.rest()); }, guess);
  curve.work.evaluations += to_locate;
  return most_telling(std::move(curve));
}

}  // namespace arcslip::continuation
