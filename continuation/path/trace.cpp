#include "arcslip/continuation/path/trace.hpp"

#include "arcslip/continuation/path/journal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/continuation/path/tracer.hpp"

namespace arcslip::continuation {
namespace {

void check(const Problem& problem, const TraceOptions& options) {
  const auto require = [](bool good, const char* what) {
    if (!good) throw std::invalid_argument(std::string("trace: ") + what);
  };
  require(problem.size() >= 1, "the problem has no unknowns");
  require(std::isfinite(options.from) && std::isfinite(options.to), "`from` and `to` must be finite");
  require(options.from != options.to, "`from` and `to` must differ");
  require(options.tolerance > 0, "`tolerance` must be positive");
  require(options.min_step > 0 && options.min_step <= options.max_step, "0 < min_step <= max_step is needed");
  require(options.max_points >= 2, "`max_points` must be at least 2");
  require(options.max_seconds > 0, "`max_seconds` must be positive");
  require(options.bound > 0, "`bound` must be positive");
}

void check(const Problem& problem, const Guess& guess) {
  const auto parameters = static_cast<Index>(problem.parameter_names().size());
  const Index n = problem.size();
  if (guess.unknowns.size() != n || guess.parameters.size() != parameters ||
      (guess.direction.size() != 0 && guess.direction.size() != n + 1)) {
    throw std::invalid_argument(fmt::format(
        "trace: the guess has {} unknowns, {} parameters and a direction of {}; expected {}, {} and "
        "none or {}",
        guess.unknowns.size(), guess.parameters.size(), guess.direction.size(), n, parameters, n + 1));
  }
  if (guess.regime.size() > problem.switch_count())
    throw std::invalid_argument(
        fmt::format("trace: the guess names a regime {} that is not there", digits(guess.regime)));
}

double sense(const TraceOptions& options) { return options.to > options.from ? 1 : -1; }

}  // namespace

double TimeBudget::seconds_left() const {
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begun_;
  return options_.max_seconds - spent.count();
}

TraceOptions unwatched(TraceOptions options) {
  options.extrema_of.clear();
  options.events.clear();
  options.stop_after.clear();
  options.journal = nullptr;
  return options;
}

TraceOptions TimeBudget::rest() const {
  TraceOptions rest = options_;
  rest.max_seconds = std::max(seconds_left(), std::numeric_limits<double>::min());
  return rest;
}

Guess restart(const BranchPoint& point, bool forward) {
  return {point.unknowns, point.parameters, point.regime, forward ? point.tangent : Vector(-point.tangent)};
}

Branch go_on_with(const Problem& problem, Branch begun, const TraceOptions& options,
                  const Observer& observer) {
  check(problem, options);
  return Tracer(problem, options, observer).go_on_with(std::move(begun));
}

namespace {

Branch trace_way(const Problem& problem, const Guess& guess, double forward, const TraceOptions& options,
                 const Observer& observer) {
  const auto begin = [&] { return Tracer(problem, options, observer).run(guess, forward); };
  if (options.journal == nullptr) return begin();
  const auto go_on = [&](JournalEntry begun) {
    return JournalEntry{go_on_with(problem, std::move(begun.branch), options, observer), {}};
  };
  return options.journal->next([&] { return JournalEntry{begin(), {}}; }, go_on).branch;
}

}  // namespace

Branch trace(const Problem& problem, const Guess& guess, const TraceOptions& options,
             const Observer& observer) {
  check(problem, options);
  check(problem, guess);
  if (guess.direction.size() > 0) return trace_way(problem, guess, 1, options, observer);
  Guess start = guess;
  start.parameters(index_of(problem.parameter_names(), options.parameter)) = options.from;
  return trace_way(problem, start, sense(options), options, observer);
}

Branch trace_one_way(const Problem& problem, const Guess& guess, bool towards_to, const TraceOptions& options,
                     const Observer& observer) {
  check(problem, options);
  check(problem, guess);
  const double forward = guess.direction.size() > 0 ? 1 : sense(options);
  return trace_way(problem, guess, towards_to ? forward : -forward, options, observer);
}

Branch trace_both(const Problem& problem, const Guess& guess, const TraceOptions& options,
                  const Observer& observer) {
  const TimeBudget time(options);
  return trace_parts([&] { return trace_one_way(problem, guess, true, options, observer); },
                     [&] { return trace_one_way(problem, guess, false, time.rest(), observer); }, guess);
}

Branch trace_parts(const std::function<Branch()>& ahead, const std::function<Branch()>& back,
                   const Guess& guess) {
  Branch second = ahead();
  if (second.stop == Stop::interrupted && second.checkpoint) second.checkpoint->begin_back = guess;
  if (second.stop == Stop::closed_loop || second.stop == Stop::no_start || second.stop == Stop::interrupted)
    return second;
  Branch first = back();
  const bool is_begun = !first.points.empty();
  Branch whole = join(std::move(first), std::move(second));
  if (!is_begun && whole.checkpoint) whole.checkpoint->begin_back = guess;
  return whole;
}

namespace {

/// Appends all points but the first `skipped`, backwards; `regime` is that of the point before the first.
void append_reversed(std::vector<BranchPoint>& points, std::size_t skipped, const Regime& regime,
                     std::vector<BranchPoint>& out) {
  for (std::size_t i = points.size(); i-- > skipped;) {
    BranchPoint& point = points[i];
    point.arclength = -point.arclength;
    if (point.type == PointType::regime_switch) point.regime = i > 0 ? points[i - 1].regime : regime;
    if (point.arrival.size() > 0) std::swap(point.tangent, point.arrival);
    point.tangent = -point.tangent;
    point.arrival = -point.arrival;
    out.push_back(std::move(point));
  }
}

/// Joins two parts; of the first one `skipped` points are the other's, too, and `regime` is that before the
/// others.
Branch join(Branch first, std::size_t skipped, const Regime& regime, Branch second) {
  Branch whole;
  whole.first_stop = first.stop;
  whole.first_explanation = std::move(first.explanation);
  whole.stop = second.stop;
  whole.explanation = std::move(second.explanation);
  whole.warning = std::move(second.warning);
  if (whole.warning.empty() && !first.warning.empty()) whole.warn(first.warning);
  whole.checkpoint = std::move(second.checkpoint);
  if (first.checkpoint) {
    if (!whole.checkpoint) whole.checkpoint.emplace().of = std::move(first.checkpoint->of);
    whole.checkpoint->back = std::move(first.checkpoint->ahead);
  }
  if (whole.checkpoint) whole.checkpoint->stop_ahead = whole.stop;
  whole.work = first.work + second.work;
  append_reversed(first.points, skipped, regime, whole.points);
  std::move(second.points.begin(), second.points.end(), std::back_inserter(whole.points));
  return whole;
}

}  // namespace

Branch join(Branch first, Branch second) { return join(std::move(first), 1, {}, std::move(second)); }

Branch resume_parts(const Checkpoint& checkpoint, const std::function<Branch(const Progress&)>& go_on,
                    const std::function<Branch(const Guess&)>& begin_back) {
  Branch second;
  second.stop = checkpoint.stop_ahead;
  second.explanation = "the part ahead had ended before";
  if (checkpoint.ahead) second = go_on(*checkpoint.ahead);
  if (!checkpoint.back && !checkpoint.begin_back) return second;
  if (checkpoint.ahead && second.stop == Stop::interrupted && second.checkpoint) {
    second.checkpoint->back = checkpoint.back;
    second.checkpoint->begin_back = checkpoint.begin_back;
    return second;
  }
  if (checkpoint.begin_back) return join(begin_back(*checkpoint.begin_back), std::move(second));
  return join(go_on(*checkpoint.back), 0, checkpoint.back->here.regime, std::move(second));
}

Branch resume(const Problem& problem, const Checkpoint& checkpoint, const TraceOptions& options,
              const Observer& observer) {
  check(problem, options);
  const TimeBudget time(options);
  if (checkpoint.window)
    throw std::invalid_argument(
        "resume: the checkpoint is one of a curve, which goes on as an ExtendedProblem, by curve.hpp");
  return resume_parts(
      checkpoint,
      [&](const Progress& progress) {
        const TraceOptions rest = time.rest();
        Tracer tracer(problem, rest, observer);
        if (checkpoint.of) tracer.require_same(*checkpoint.of);
        return tracer.run(progress);
      },
      [&](const Guess& guess) { return trace_one_way(problem, guess, false, time.rest(), observer); });
}

}  // namespace arcslip::continuation
