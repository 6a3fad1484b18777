#include "arcslip/continuation/curves/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/continuation/curves/extremum_curve.hpp"
#include "arcslip/continuation/curves/half_curve.hpp"
#include "arcslip/continuation/curves/orbit_curve.hpp"
#include "arcslip/continuation/cycles/end_of_kind.hpp"
#include "arcslip/continuation/cycles/mesh_watch.hpp"
#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/points/border_problem.hpp"
#include "arcslip/continuation/points/branch_point_problem.hpp"
#include "arcslip/continuation/points/extremum_problem.hpp"
#include "arcslip/continuation/points/fold_problem.hpp"
#include "arcslip/continuation/points/hopf_problem.hpp"
#include "arcslip/continuation/points/level_problem.hpp"
#include "arcslip/continuation/points/normal_form.hpp"

namespace arcslip::continuation {
namespace {

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

/// With the events that end a curve which begins there.
TraceOptions bounded(const ExtendedProblem& problem, const TraceOptions& options, const CurveWindow& window,
                     const Vector& unknowns, const Regime& regime) {
  TraceOptions all = within_window(options, window, problem.base().size());
  for (const PointType last : problem.last_of_curve()) all.stop_after.push_back({last, 1, {}});
  if (const auto* orbits = dynamic_cast<const OrbitProblem*>(&problem.base()))
    end_with_kind(*orbits, all, orbits->apart(unknowns, regime),
                  dynamic_cast<const FoldProblem*>(&problem) != nullptr);
  return all;
}

/// With the events of a curve that goes on.
TraceOptions bounded(const ExtendedProblem& problem, const TraceOptions& options,
                     const Checkpoint& checkpoint) {
  const std::optional<Progress>& part = checkpoint.ahead ? checkpoint.ahead : checkpoint.back;
  if (part) return bounded(problem, options, *checkpoint.window, part->start.unknowns, part->start.regime);
  const Guess& guess = checkpoint.begin_back.value();
  return bounded(problem, options, *checkpoint.window, guess.unknowns, guess.regime);
}

/// One that has come to the last point of its kind goes no further.
void settle(const ExtendedProblem& problem, const std::string& parameter, Branch& half) {
  const auto* orbits = dynamic_cast<const OrbitProblem*>(&problem.base());
  if (orbits != nullptr && tell_end_of_kind(*orbits, problem, parameter, half)) return;
  const std::vector<PointType> last = problem.last_of_curve();
  if (half.stop != Stop::requested) return;
  const auto end = std::find_if(half.points.rbegin(), half.points.rend(), [&](const BranchPoint& point) {
    return std::count(last.begin(), last.end(), point.type) > 0;
  });
  if (end == half.points.rend() || end->arclength != half.points.back().arclength) return;
  half.checkpoint.reset();
  half.explanation = fmt::format("the curve ends on a {} point", end->type_name());
}

/// But for how well points are located.
bool lies_within(const CurveWindow& window, double value, double tolerance) {
  constexpr double loosely = 100;
  const double margin = loosely * tolerance * std::max(1.0, std::abs(value));
  return value >= window.low - margin && value <= window.high + margin;
}

/// Without what lies outside of the window, as a start may that was corrected far.
void leave_window(Branch& half, const CurveWindow& window, Index n, double tolerance) {
  std::erase_if(half.points,
                [&](const BranchPoint& point) { return !lies_within(window, point.unknowns(n), tolerance); });
  half.checkpoint.reset();
  half.stop = half.points.empty() ? Stop::no_start : Stop::left_range;
  half.explanation = "the curve was found to go on only outside of the window";
}

Branch begin_half(ExtendedProblem& problem, const Guess& start, bool towards_to, const TraceOptions& options,
                  const CurveWindow& window, const OrbitOptions& orbits, const Observer& observer) {
  if (!problem.adapt(problem.split(start.unknowns, start.parameters, start.regime))) return {};
  const Index n = problem.base().size();
  bool is_outside = false;
  const Observer inside = [&](const BranchPoint& point) {
    is_outside = !lies_within(window, point.unknowns(n), options.tolerance);
    return !is_outside && (!observer || observer(point));
  };
  const auto ended = [&](Branch& half) {
    if (is_outside) leave_window(half, window, n, options.tolerance);
    settle(problem, options.parameter, half);
  };
  return trace_part(problem, start, towards_to, options, inside, ended, {}, orbits);
}

/// By how much an observable is above the value of a level.
class Above {
 public:
  Above(const Level& level, const Problem& problem)
      : problem_(problem),
        value_(level.value),
        which_(index_of(observable_names(problem), level.observable)),
        what_(problem.observables()[static_cast<std::size_t>(which_)]) {}

  double operator()(const Vector& u, const Vector& p, const Regime& regime) const {
    Vector values;
    problem_.observe(u, p, regime, values);
    return what_.near(values(which_), value_) - value_;
  }
  double period() const { return what_.period; }

 private:
  const Problem& problem_;
  double value_;
  Index which_;
  Observable what_;
};

Branch told(Branch curve, const CurveWindow& window) {
  if (curve.checkpoint) curve.checkpoint->window = window;
  return curve;
}

}  // namespace

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
      start.problem = base.special(point.type, parameter, {point.unknowns, point.parameters, point.regime},
                                   start.point.extras);
      if (start.problem != nullptr) break;
      throw std::invalid_argument(
          fmt::format("curve_through: no curve is made of points of type {}", to_string(point.type)));
  }
  return start;
}

double above(const Level& level, const Problem& problem, const Vector& u, const Vector& p,
             const Regime& regime) {
  return Above(level, problem)(u, p, regime);
}

UserEvent event_at(const Level& level, const Problem& problem) {
  return {level.observable,
          [above = Above(level, problem)](const Vector& u, const Vector& p, const Regime& regime) {
            const double difference = above(u, p, regime);
            return above.period() > 0 ? std::sin(two_pi / above.period() * difference) : difference;
          }};
}

bool is_at(const Level& level, const Problem& problem, const BranchPoint& event) {
  const Above above(level, problem);
  const double difference = above(event.unknowns, event.parameters, event.regime);
  return event.label == level.observable &&
         (above.period() == 0 || std::abs(difference) < 0.25 * above.period());
}

CurveStart curve_at(const Level& level, const Problem& base, const std::string& active,
                    const BranchPoint& point) {
  return {std::make_unique<LevelProblem>(base, index_of(base.parameter_names(), active),
                                         index_of(observable_names(base), level.observable), level.value),
          {point.unknowns, point.parameters, point.regime, {}}};
}

namespace {

/// From where it begins along its direction, or through a special point both ways.
Branch trace_from(ExtendedProblem& problem, const BasePoint& start, const Vector& direction,
                  const TraceOptions& options, const CurveWindow& window, const OrbitOptions& orbits,
                  const Observer& observer) {
  const long before = problem.evaluations();
  Guess guess{{}, {}, start.regime, direction};
  problem.join(start, guess.unknowns, guess.parameters);
  if (direction.size() == 0) {
    const auto located = locate(problem, start, options.tolerance);
    const bool is_inside =
        located && lies_within(window, located->point.parameters(problem.active()), options.tolerance);
    if (is_inside) {
      problem.join(located->point, guess.unknowns, guess.parameters);
    } else if (!problem.adapt(start) || !nearly_solves(problem, guess)) {  // else its parameter stands still
      Branch none;
      none.explanation = located ? "the special point that was found lies outside of the window"
                                 : "no special point of this kind was found next to the start";
      return none;
    }
  }
  const long to_locate = problem.evaluations() - before;
  const TraceOptions all = bounded(problem, options, window, guess.unknowns, guess.regime);
  const TimeBudget time(all);
  const auto ahead = [&] { return begin_half(problem, guess, true, all, window, orbits, observer); };
  const auto back = [&] { return begin_half(problem, guess, false, time.rest(), window, orbits, observer); };
  Branch curve = direction.size() > 0 ? ahead() : trace_parts(ahead, back, guess);
  curve.work.evaluations += to_locate;
  return told(most_telling(std::move(curve)), window);
}

/// On twice as many intervals.
OrbitCurveStart finer(const OrbitCurveStart& start) {
  const BasePoint& at = start.point;
  OrbitStart orbit = refined({start.orbits, {at.unknowns, at.parameters, at.regime, start.direction}},
                             2 * start.orbits->resolution());
  const Guess& guess = orbit.guess;
  return {std::move(orbit.problem),
          start.make,
          {guess.unknowns, guess.parameters, guess.regime, at.extras},
          guess.direction};
}

}  // namespace

Branch trace_curve(ExtendedProblem& problem, const BasePoint& start, const TraceOptions& options,
                   const CurveWindow& window, const Observer& observer, const OrbitOptions& orbits) {
  if (problem.extremum_of()) return told(trace_extrema(problem, start, options, window, observer), window);
  return trace_from(problem, start, {}, options, window, with_these_intervals(orbits), observer);
}

OrbitCurveStart orbit_curve_through(const OrbitProblem& orbits, const std::string& active,
                                    const BranchPoint& point) {
  CurveStart start = curve_through(orbits, active, point);
  const auto make = [active, type = point.type](const OrbitProblem& others, const BasePoint& at) {
    BranchPoint there;
    there.type = type;
    there.unknowns = at.unknowns;
    there.parameters = at.parameters;
    there.regime = at.regime;
    return curve_through(others, active, there).problem;
  };
  start.point.regime = {};
  return {about(orbits, point.unknowns, point.parameters, point.regime), make, std::move(start.point), {}};
}

Curve trace_orbit_curve(const OrbitCurveStart& start, const TraceOptions& options, const CurveWindow& window,
                        const OrbitOptions& orbits, const Observer& observer) {
  const TimeBudget time(options);
  OrbitCurveStart at = start;
  while (true) {
    Curve curve{at.orbits, at.make(*at.orbits, at.point), {}};
    try {
      curve.branch =
          trace_from(*curve.problem, at.point, at.direction, time.rest(), window, orbits, observer);
      return curve;
    } catch (const TooCoarse&) {
      at = finer(at);
    }
  }
}

Curve trace_curve_through(std::shared_ptr<const Problem> base, const std::string& active,
                          const BranchPoint& point, const std::string& observable,
                          const TraceOptions& options, const CurveWindow& window, const OrbitOptions& orbits,
                          const Observer& observer) {
  if (const auto* of_orbits = dynamic_cast<const OrbitProblem*>(base.get()))
    return trace_orbit_curve(orbit_curve_through(*of_orbits, active, point), options, window, orbits,
                             observer);
  CurveStart start = curve_through(*base, active, point, observable);
  Branch branch = trace_curve(*start.problem, start.point, options, window, observer);
  return {std::move(base), std::move(start.problem), std::move(branch)};
}

Branch resume(ExtendedProblem& problem, const Checkpoint& checkpoint, const TraceOptions& options,
              const Observer& observer, const OrbitOptions& orbits) {
  const auto& as_branch = static_cast<const Problem&>(problem);
  if (!checkpoint.of)
    throw std::invalid_argument(
        "resume: the checkpoint was written by a version that keeps no curve's window");
  if (!checkpoint.window) return resume(as_branch, checkpoint, options, observer);
  const TimeBudget time(bounded(problem, options, checkpoint));
  const OrbitOptions fixed = with_these_intervals(orbits);
  const auto go_on = [&](const Progress& progress) {
    problem.set_borders(progress.borders);
    Checkpoint half;
    half.of = checkpoint.of;
    half.ahead = progress;
    Branch rest = follow_curve(problem, time.rest(), fixed, observer,
                               [&](const TraceOptions& own, const Observer& follow) {
                                 return resume(as_branch, half, own, follow);
                               });
    settle(problem, options.parameter, rest);
    return rest;
  };
  const auto begin_back = [&](const Guess& guess) {
    return begin_half(problem, guess, false, time.rest(), *checkpoint.window, fixed, observer);
  };
  return told(most_telling(resume_parts(checkpoint, go_on, begin_back)), *checkpoint.window);
}

}  // namespace arcslip::continuation
