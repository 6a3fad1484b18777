#include "arcslip/continuation/curves/half_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "arcslip/continuation/cycles/growth_watch.hpp"
#include "arcslip/continuation/cycles/mesh_watch.hpp"
#include "arcslip/continuation/path/journal.hpp"

namespace arcslip::continuation {

TraceOptions within_window(const TraceOptions& options, const CurveWindow& window, Index n) {
  TraceOptions all = options;
  for (const double edge : {window.low, window.high}) {
    if (!std::isfinite(edge)) continue;
    all.events.push_back(
        {end_of_window, [=](const Vector& u, const Vector&, const Regime&) { return u(n) - edge; }});
  }
  if (all.events.size() > options.events.size())
    all.stop_after.push_back({PointType::event, 1, end_of_window});
  return all;
}

namespace {

/// One part, on the meshes that there are.
Branch follow_borders(ExtendedProblem& problem, const Observer& observer,
                      const std::function<Branch(const Observer& follow)>& trace) {
  // Those at the last point: a step that was not brought to its end may have changed them.
  std::vector<double> borders = problem.borders();
  const auto follow = [&](const BranchPoint& point) {
    const bool fits = problem.follow(problem.split(point.unknowns, point.parameters, point.regime));
    borders = problem.borders();
    return fits && (!observer || observer(point));
  };
  const long before = problem.evaluations();
  Branch part = trace(follow);
  part.work.evaluations = problem.evaluations() - before;
  if (part.points.empty()) return part;
  // An edge that is met together with the end of the other range is told by that.
  part.points.erase(std::remove_if(part.points.begin(), part.points.end() - 1,
                                   [](const BranchPoint& point) { return point.label == end_of_window; }),
                    part.points.end() - 1);
  BranchPoint& last = part.points.back();
  if (last.label == end_of_window) {
    part.checkpoint.reset();
    last.type = PointType::end;
    last.label.clear();
    part.stop = Stop::reached_end;
    part.explanation = fmt::format("{} reached an end of its range", problem.observables().front().name);
    if (!part.warning.empty()) part.explanation += "; " + part.warning;
  }
  if (part.checkpoint) part.checkpoint->ahead->borders = std::move(borders);
  return part;
}

}  // namespace

Branch follow_curve(ExtendedProblem& problem, const TraceOptions& options, const OrbitOptions& orbits,
                    const Observer& observer,
                    const std::function<Branch(const TraceOptions& own, const Observer& follow)>& trace) {
  TraceOptions own = options;
  own.journal = nullptr;
  const auto* of = dynamic_cast<const OrbitProblem*>(&problem.base());
  if (of == nullptr)
    return follow_borders(problem, observer, [&](const Observer& follow) { return trace(own, follow); });
  MeshWatch meshes(*of, orbits, &problem);
  GrowthWatch growth(*of, options.parameter, orbits.tolerance, &problem);
  bool told = false;
  bool worn = false;
  bool grows = false;
  const Observer watching = [&](const BranchPoint& point) {
    told = observer && !observer(point);
    worn = !meshes.serves(point);
    grows = !growth.goes_on(problem.split(point.unknowns, point.parameters, point.regime));
    return !told && !worn && !grows;
  };
  const TimeBudget time(own);
  Branch part = follow_borders(problem, watching, [&](const Observer& follow) { return trace(own, follow); });
  while (part.stop == Stop::interrupted && std::exchange(worn, false) && !told && !grows) {
    if (!meshes.renew(part, own)) {
      meshes.give_up(part, own.parameter);
      return part;
    }
    own.max_seconds = time.rest().max_seconds;
    const long before = part.work.evaluations;
    part = follow_borders(problem, watching, [&](const Observer& follow) {
      return go_on_with(problem, std::move(part), own, follow);
    });
    part.work.evaluations += before;
  }
  if (part.stop == Stop::interrupted && grows && !told) growth.end(part);
  return part;
}

Branch trace_part(ExtendedProblem& problem, const Guess& start, bool towards_to, const TraceOptions& options,
                  const Observer& observer, const std::function<void(Branch&)>& ended,
                  const std::function<void(const BranchPoint&)>& again, const OrbitOptions& orbits) {
  bool is_known = true;
  const auto see_again = [&](const Branch& known) {
    if (again) std::for_each(known.points.begin(), known.points.end(), again);
  };
  using Trace = std::function<Branch(const TraceOptions& own, const Observer& follow)>;
  const auto followed = [&](const Trace& trace) {
    is_known = false;
    JournalEntry entry{follow_curve(problem, options, orbits, observer, trace), {}};
    ended(entry.branch);
    entry.borders = problem.borders();
    return entry;
  };
  const auto begin = [&] {
    return followed([&](const TraceOptions& own, const Observer& follow) {
      return trace_one_way(problem, start, towards_to, own, follow);
    });
  };
  const auto go_on = [&](JournalEntry begun) {
    see_again(begun.branch);
    problem.set_borders(begun.branch.checkpoint->ahead->borders);
    const long before = begun.branch.work.evaluations;
    JournalEntry entry = followed([&](const TraceOptions& own, const Observer& follow) {
      return go_on_with(problem, std::move(begun.branch), own, follow);
    });
    entry.branch.work.evaluations += before;
    return entry;
  };
  const bool is_kept = dynamic_cast<const OrbitProblem*>(&problem.base()) == nullptr;
  if (options.journal == nullptr || !is_kept) return begin().branch;
  JournalEntry entry = options.journal->next(begin, go_on);
  if (is_known) see_again(entry.branch);
  problem.set_borders(entry.borders);
  return std::move(entry.branch);
}

Branch most_telling(Branch curve) {
  if (curve.first_stop && is_end(curve.stop) && !is_end(*curve.first_stop)) {
    std::swap(curve.stop, *curve.first_stop);
    std::swap(curve.explanation, curve.first_explanation);
  }
  return curve;
}

}  // namespace arcslip::continuation
