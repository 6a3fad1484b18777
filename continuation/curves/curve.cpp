#include "arcslip/continuation/curves/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/continuation/points/border_problem.hpp"
#include "arcslip/continuation/points/branch_point_problem.hpp"
#include "arcslip/continuation/points/extremum_problem.hpp"
#include "arcslip/continuation/points/fold_problem.hpp"
#include "arcslip/continuation/points/hopf_problem.hpp"
#include "arcslip/continuation/points/normal_form.hpp"

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

/// Hopf curves end where their pair of eigenvalues meets at 0.
bool ends_at_bogdanov_takens(const ExtendedProblem& problem) {
  return dynamic_cast<const HopfProblem*>(&problem) != nullptr;
}

/// With the events that end a curve.
TraceOptions bounded(const ExtendedProblem& problem, const TraceOptions& options, const CurveWindow& window) {
  TraceOptions all = options;
  const Index active = problem.base().size();
  for (const double edge : {window.low, window.high}) {
    if (!std::isfinite(edge)) continue;
    all.events.push_back(
        {end_of_window, [=](const Vector& u, const Vector&, int) { return u(active) - edge; }});
  }
  if (all.events.size() > options.events.size())
    all.stop_after.push_back({PointType::event, 1, end_of_window});
  if (ends_at_bogdanov_takens(problem)) all.stop_after.push_back({PointType::bogdanov_takens, 1, {}});
  return all;
}

/// A half of a curve, which `trace` traces with an observer: the borders of its conditions follow it.
Branch follow_half(ExtendedProblem& problem, const Observer& observer,
                   const std::function<Branch(const Observer& follow)>& trace) {
  const auto follow = [&](const BranchPoint& point) {
    return problem.follow(problem.split(point.unknowns, point.parameters, point.regime)) &&
           (!observer || observer(point));
  };
  const long before = problem.evaluations();
  Branch half = trace(follow);
  half.work.evaluations = problem.evaluations() - before;
  if (half.points.empty()) return half;
  BranchPoint& last = half.points.back();
  const bool is_over = last.label == end_of_window ||
                       (half.stop == Stop::requested && last.type == PointType::bogdanov_takens &&
                        ends_at_bogdanov_takens(problem));
  if (is_over) half.checkpoint.reset();
  if (half.checkpoint) half.checkpoint->ahead->borders = problem.borders();
  if (last.label != end_of_window) return half;
  last.type = PointType::end;
  last.label.clear();
  half.stop = Stop::reached_end;
  half.explanation = fmt::format("{} reached an end of its range", problem.observables().front().name);
  if (!half.warning.empty()) half.explanation += "; " + half.warning;
  return half;
}

Branch begin_half(ExtendedProblem& problem, const Guess& start, bool towards_to, const TraceOptions& options,
                  const Observer& observer) {
  if (!problem.adapt(problem.split(start.unknowns, start.parameters, start.regime))) return {};
  return follow_half(problem, observer, [&](const Observer& follow) {
    return trace_one_way(problem, start, towards_to, options, follow);
  });
}

/// The reason that is told of a curve is the one that a user has to know.
Branch told(Branch curve, const CurveWindow& window, const std::string& why_first_ended) {
  if (curve.checkpoint) curve.checkpoint->window = window;
  if (curve.first_stop && is_end(curve.stop) && !is_end(*curve.first_stop)) {
    std::swap(curve.stop, *curve.first_stop);
    curve.explanation = why_first_ended;
  }
  return curve;
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
  const long before = problem.evaluations();
  const auto located = locate(problem, start, options.tolerance);
  const long to_locate = problem.evaluations() - before;
  if (!located) {
    Branch none;
    none.explanation = "no special point of this kind was found next to the start";
    return none;
  }
  Guess guess;
  problem.join(located->point, guess.unknowns, guess.parameters);
  guess.regime = start.regime;

  const TraceOptions all = bounded(problem, options, window);
  const TimeBudget time(all);
  std::string why_first_ended;
  Branch curve = trace_parts([&] { return begin_half(problem, guess, true, all, observer); },
                             [&] {
                               Branch first = begin_half(problem, guess, false, time.rest(), observer);
                               why_first_ended = first.explanation;
                               return first;
                             },
                             guess);
  curve.work.evaluations += to_locate;
  return told(std::move(curve), window, why_first_ended);
}

Branch resume(ExtendedProblem& problem, const Checkpoint& checkpoint, const TraceOptions& options,
              const Observer& observer) {
  const auto& as_branch = static_cast<const Problem&>(problem);
  if (!checkpoint.of)
    throw std::invalid_argument(
        "resume: the checkpoint was written by a version that keeps no curve's window");
  if (!checkpoint.window) return resume(as_branch, checkpoint, options, observer);
  const TimeBudget time(bounded(problem, options, *checkpoint.window));
  std::string why_first_ended;
  const auto go_on = [&](const Progress& progress) {
    problem.set_borders(progress.borders);
    Checkpoint half;
    half.of = checkpoint.of;
    half.ahead = progress;
    Branch rest = follow_half(problem, observer, [&](const Observer& follow) {
      return resume(as_branch, half, time.rest(), follow);
    });
    why_first_ended = rest.explanation;
    return rest;
  };
  const auto begin_back = [&](const Guess& guess) {
    Branch first = begin_half(problem, guess, false, time.rest(), observer);
    why_first_ended = first.explanation;
    return first;
  };
  return told(resume_parts(checkpoint, go_on, begin_back), *checkpoint.window, why_first_ended);
}

}  // namespace arcslip::continuation
