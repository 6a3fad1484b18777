#include "arcslip/continuation/curves/half_curve.hpp"

#include <fmt/format.h>

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
  const auto follow = [&](const BranchPoint& point) {
    return problem.follow(problem.split(point.unknowns, point.parameters, point.regime)) &&
           (!observer || observer(point));
  };
  const long before = problem.evaluations();
  Branch part = trace(follow);
  part.work.evaluations = problem.evaluations() - before;
  if (part.points.empty()) return part;
  BranchPoint& last = part.points.back();
  if (last.label == end_of_window) {
    part.checkpoint.reset();
    last.type = PointType::end;
    last.label.clear();
    part.stop = Stop::reached_end;
    part.explanation = fmt::format("{} reached an end of its range", problem.observables().front().name);
    if (!part.warning.empty()) part.explanation += "; " + part.warning;
  }
  if (part.checkpoint) part.checkpoint->ahead->borders = problem.borders();
  return part;
}

TraceOptions without_journal(const TraceOptions& options) {
  TraceOptions own = options;
  own.journal = nullptr;
  return own;
}

Branch kept_half(ExtendedProblem& problem, Journal* journal, const std::function<Branch()>& begin,
                 const std::function<Branch(Branch begun)>& go_on) {
  if (journal == nullptr) return begin();
  const auto with_borders = [&](Branch half) { return JournalEntry{std::move(half), problem.borders()}; };
  JournalEntry entry =
      journal->next([&] { return with_borders(begin()); },
                    [&](JournalEntry begun) { return with_borders(go_on(std::move(begun.branch))); });
  problem.set_borders(entry.borders);
  return std::move(entry.branch);
}

Branch most_telling(Branch curve, const std::string& why_first_ended) {
  if (curve.first_stop && is_end(curve.stop) && !is_end(*curve.first_stop)) {
    std::swap(curve.stop, *curve.first_stop);
    curve.explanation = why_first_ended;
  }
  return curve;
}

}  // namespace arcslip::continuation
