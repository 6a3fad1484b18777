#include "arcslip/continuation/curves/half_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

Branch follow_curve(ExtendedProblem& problem, const Observer& observer,
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

Branch trace_part(ExtendedProblem& problem, const Guess& start, bool towards_to, const TraceOptions& options,
                  const Observer& observer, const std::function<void(Branch&)>& ended,
                  const std::function<void(const BranchPoint&)>& again) {
  TraceOptions own = options;
  own.journal = nullptr;
  bool is_known = true;
  const auto see_again = [&](const Branch& known) {
    if (again) std::for_each(known.points.begin(), known.points.end(), again);
  };
  const auto followed = [&](const std::function<Branch(const Observer& follow)>& trace) {
    is_known = false;
    JournalEntry entry{follow_curve(problem, observer, trace), {}};
    ended(entry.branch);
    entry.borders = problem.borders();
    return entry;
  };
  const auto begin = [&] {
    return followed(
        [&](const Observer& follow) { return trace_one_way(problem, start, towards_to, own, follow); });
  };
  const auto go_on = [&](JournalEntry begun) {
    see_again(begun.branch);
    problem.set_borders(begun.branch.checkpoint->ahead->borders);
    const long before = begun.branch.work.evaluations;
    JournalEntry entry = followed(
        [&](const Observer& follow) { return go_on_with(problem, std::move(begun.branch), own, follow); });
    entry.branch.work.evaluations += before;
    return entry;
  };
  if (options.journal == nullptr) return begin().branch;
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
