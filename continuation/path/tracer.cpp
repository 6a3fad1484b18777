#include "arcslip/continuation/path/tracer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "arcslip/continuation/events/corner.hpp"
#include "arcslip/continuation/points/extended_problem.hpp"
#include "arcslip/continuation/problem/evaluation.hpp"

namespace arcslip::continuation {
namespace {

std::vector<Index> tracked_observables(const Problem& problem, const TraceOptions& options) {
  const std::vector<Observable> observables = problem.observables();
  const std::vector<std::string> names = observable_names(problem);
  std::vector<Index> tracked;
  for (const std::string& name : options.extrema_of) {
    tracked.push_back(index_of(names, name));
    if (!observables[static_cast<std::size_t>(tracked.back())].has_gradient) {
      throw std::invalid_argument(fmt::format("extrema_of: '{}' has no gradient", name));
    }
  }
  return tracked;
}

bool looks_for_pairs(const Problem& problem, const TraceOptions& options) {
  constexpr Index many = 24;
  return options.branch_point_pairs.value_or(problem.switch_count() <= 1 || problem.size() <= many);
}

/// Whether F is continuous at corners within a regime: conditions on special points are made of derivatives.
bool may_bend(const Problem& problem) { return dynamic_cast<const ExtendedProblem*>(&problem) == nullptr; }

/// Ends a branch in the midst of a step.
struct Halt {
  Stop reason;
};

}  // namespace

Tracer::Tracer(const Problem& problem, const TraceOptions& options, const Observer& observer)
    : problem_(problem),
      options_(options),
      observer_(observer),
      parameter_(index_of(problem.parameter_names(), options.parameter)),
      corrector_(
          problem, parameter_,
          {.tolerance = options.tolerance, .watch = [this] { watch_clock(); }, .over_parameter = true}),
      stepper_(problem, corrector_, tracked_observables(problem, options), options.max_step,
               looks_for_pairs(problem, options), options.tolerances, options.rough_extrema,
               may_bend(problem)),
      watch_(problem, options.events),
      targets_(problem, parameter_, options),
      image_(options.symmetries, options.tolerances.same_solution) {
  state_.distance = 0.1 * options.max_step;
  if (!options.symmetries.empty()) stepper_.set_meeting([this](const CurvePoint& at) { return meets(at); });
  branch_.points.reserve(256);
}

Branch Tracer::run(const Guess& guess, double forward) {
  return finished([&] { start(guess, forward); });
}

Branch Tracer::run(const Progress& progress) {
  require_same(progress);
  return finished([&] {
    storing_ = true;
    state_ = progress;
    stepper_.restore(progress);
    targets_.restore(progress.taken);
    watch_.begin(stepper_.here());
    if (!progress.looks.empty()) watch_.restore(progress.looks);
  });
}

void Tracer::go_on() {
  while (!stopped_) {
    storing_ = false;
    state_.rescaled = static_cast<int>(stepper_.is_rescaled());
    if (stepper_.is_rescaled()) watch_.begin(stepper_.here());  // whose tests have other units from here on
    check_limits();
    if (!stopped_) step();
  }
}

/// The branch that begins so.
template <class Begin>
Branch Tracer::finished(const Begin& begin) {
  try {
    begin();
    go_on();
  } catch (const Halt& ended) {
    if (!branch_.points.empty()) forget_tries();
    halt(ended.reason);
  }
  if (!branch_.points.empty() && !is_unfinished(branch_.stop))
    look_at_derivatives(stepper_.here().unknowns, stepper_.here().parameters, stepper_.here().regime);
  if (!branch_.warning.empty()) branch_.explanation += "; " + branch_.warning;
  branch_.work = corrector_.work();
  branch_.work.spectra = spectra_before_ + watch_.spectra();
  const bool further =
      branch_.stop == Stop::max_points || branch_.stop == Stop::requested || is_unfinished(branch_.stop);
  if (further && !branch_.points.empty()) {
    state_.taken = targets_.taken();
    state_.here = stepper_.here();
    state_.bends = stepper_.bends();
    state_.monitors = stepper_.at_here();
    state_.past = stepper_.step().past;
    state_.looks = watch_.kept();
    state_.residual_size = corrector_.residual_size();
    branch_.checkpoint.emplace().of = identity();
    branch_.checkpoint->ahead = std::move(state_);
  }
  return std::move(branch_);
}

bool Tracer::out_of_time() const {
  if (!std::isfinite(options_.max_seconds)) return false;
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begun_;
  return spent.count() >= options_.max_seconds;
}

/// A point that was found is stored first.
void Tracer::watch_clock() const {
  if (storing_) return;
  if (options_.go_on && !options_.go_on()) throw Halt{Stop::interrupted};
  if (out_of_time()) throw Halt{Stop::time_limit};
}

void Tracer::halt(Stop reason) {
  const std::string why = reason == Stop::interrupted ? "told to end" : "max_seconds have passed";
  if (branch_.points.empty()) return stop(reason, why + " before the first point was found");
  const double last = branch_.points.back().parameters(parameter_);
  stop(reason, fmt::format("{}; the branch stands at {} = {:.10g}", why, options_.parameter, last));
}

void Tracer::check_limits() {
  const CurvePoint& here = stepper_.here();
  const Index n = corrector_.size();
  if (satisfied_) return stop(Stop::requested, fmt::format("stop_after was satisfied at {}", place()));
  if (interrupted_) return halt(Stop::interrupted);
  if (static_cast<long>(branch_.points.size()) >= options_.max_points) {
    return stop(Stop::max_points, fmt::format("max_points = {} points were stored; the branch stands at {}",
                                              options_.max_points, place()));
  }
  if (out_of_time()) return halt(Stop::time_limit);
  if (const Symmetry* symmetry = image_.take(here.unknowns, here.tangent, here.scale)) {
    return stop(Stop::own_image,
                fmt::format("the branch has the symmetry \"{}\" again and would go on as its own "
                            "image, at {}",
                            symmetry->name, place()));
  }
  const double largest = here.unknowns.cwiseQuotient(state_.start.scale.head(n)).lpNorm<Eigen::Infinity>();
  if (largest > options_.bound) {
    stop(Stop::unbounded,
         fmt::format("an unknown grew beyond bound = {:g} times its scale at the start, at {}",
                     options_.bound, place()));
  }
}

void Tracer::step() {
  first_hold_ = state_.hold;
  first_distance_ = state_.distance;
  first_taken_ = targets_.taken();
  while (!try_step()) {
    ++corrector_.work().rejected_steps;
    if (stopped_) return;
    if (length() >= options_.min_step) continue;
    if (stepper_.straighten()) {
      state_.distance = careful();
      continue;
    }
    if (options_.turns_at_corners && pass_corner()) return;
    return stop_stepping();
  }
  take();
}

bool Tracer::try_step() {
  double& distance = state_.distance;
  distance = std::min(distance, longest_step() / stepper_.slope_length(state_.hold));
  stepper_.set_on_target(!targets_.taken().empty());
  const double rate = stepper_.parameter_slope(state_.hold);
  landing_ = next_target(1.1 * distance * std::abs(rate) * parameter_scale(), rate > 0 ? 1 : -1);
  if (landing_ != nullptr) {
    if (!comes_by_halves(*landing_)) return try_landing();
    halve_way_to(*std::exchange(landing_, nullptr));
  }
  if (stepper_.is_over_parameter()) {
    use(Hold::parameter);
    distance = to_even_value(distance, rate);
  }
  if (!stepper_.attempt(state_.hold, distance)) {
    const double factor = step_factor(stepper_.signals(), {}, options_.max_step);
    if (stepper_.signals().roughness > 1) {
      distance *= factor;
      return false;
    }
    const Hold held = state_.hold;
    const double tried = distance;
    use(state_.hold == Hold::tangent ? Hold::parameter : Hold::tangent);
    if (!stepper_.attempt(state_.hold, distance)) {  // on a fold it cannot be: the parameter does not change
      state_.hold = held;
      distance = tried * factor;
      return false;
    }
  }
  if (find_events()) return true;
  distance *= 0.5;
  return false;
}

/// Looks for events in the step, and probes it where it ends at one; false if it has to be shorter. A target
/// must not be passed, but by a step that ends before it.
bool Tracer::find_events() {
  closing_.reset();
  const Step& step = stepper_.step();
  const CurvePoint& there = step.there;
  if (!step.is_tiny(step.distance) && image_.has_gone_over(there.unknowns, there.tangent, there.scale))
    return false;
  watch_.look(there, corrector_.jacobian_at(there));
  looks_to_end_ = watch_.looks();
  EventSearch search = find_first_events(stepper_, watch_, state_.signs);
  events_ = std::move(search.events);
  if (!search.solved) return false;
  if (branch_.points.size() > 2 || state_.arclength > 0)
    closing_ = stepper_.prober().passes(state_.start, options_.tolerances.same_point);
  if (closing_ && is_told_before(*closing_)) closing_.reset();
  if (closing_) events_.clear();
  if (events_.empty() && !closing_) return landing_ != nullptr || !passes_target(stepper_.step().there, 0);
  const double s = closing_ ? *closing_ : events_.front().s;
  return stepper_.prober().probe(s) &&
         !passes_target(stepper_.prober().probed().point, options_.tolerances.same_value);
}

void Tracer::use(Hold hold) {
  const double now = length();
  state_.hold = hold;
  state_.distance = now / stepper_.slope_length(hold);
}

void Tracer::take() {
  landing_failed_ = false;
  storing_ = true;
  const bool whole = landing_ == nullptr && events_.empty() && !closing_;
  if (whole && leaves_range()) {
    if (branch_.points.size() > 1) store(PointType::end);
    return stop(Stop::left_range, fmt::format("the branch leaves the range at {}", place()));
  }
  const double factor = step_factor(stepper_.signals(), {}, options_.max_step);
  if (!events_.empty() || closing_) {
    stepper_.prober().cut();
    for (const Event& event : events_) {
      if (event.kind->ends_regime) stepper_.settle_on_border(static_cast<int>(event.index));
    }
  }
  state_.last_value = value();
  state_.last_chord = stepper_.step().chord.norm();
  state_.arclength += state_.last_chord;
  stepper_.advance();
  targets_.keep_taken(value(), options_.tolerances.same_value * parameter_scale());
  if (whole) state_.distance *= factor;
  signs_before_ = state_.signs;
  if (!whole || watch_.looks() != looks_to_end_) watch_.look(stepper_.here());
  watch_.keep(state_.last_chord);
  update(state_.signs, stepper_, watch_, !events_.empty());
  if (closing_) {
    store(PointType::end);
    return stop(Stop::closed_loop, "the branch came back to its start");
  }
  if (!events_.empty()) return take_events(signs_before_);
  if (landing_ != nullptr) return take_target(*landing_);
  store(PointType::regular);
}

Correction Tracer::leave(int border, bool several) {
  const CurvePoint& here = stepper_.here();
  if (!several) {
    const Regime beyond = *problem_.regime_beyond(here.regime, border);
    if (!seen_in_regime_.contains(beyond))
      check_functions(problem_, here.unknowns, here.parameters, beyond, stepper_.monitors().tracked());
    return stepper_.enter(beyond);
  }
  const Vector arrival = raw_tangent().cwiseQuotient(here.scale);
  const Guess corner{here.unknowns, here.parameters, here.regime, {}};
  const Guess* best = nullptr;
  double straightest = -0.999999;  // the piece that the branch came on is none of them
  const std::vector<Guess> pieces = leaving_pieces(problem_, parameter_, corner, options_.tolerances);
  for (const Guess& piece : pieces) {
    const double along = piece.direction.cwiseQuotient(here.scale).normalized().dot(arrival);
    if (along > straightest) {
      straightest = along;
      best = &piece;
    }
  }
  if (best == nullptr) return Correction::singular;
  const Guess next = *best;
  return stepper_.start_along(next.unknowns, next.parameters, next.regime, next.direction);
}

void Tracer::cross(int border, bool several) {
  if (!several && !problem_.regime_beyond(stepper_.here().regime, border)) {
    store(PointType::end);
    return stop(Stop::left_regime,
                fmt::format("the branch ends on the border of its regime, at {}", place()));
  }
  const Signs before = state_.signs;
  const double length_before = length();
  const double change = state_.distance * std::abs(stepper_.parameter_slope(state_.hold));
  const Vector arrival = raw_tangent();
  if (leave(border, several) != Correction::converged) {
    store(PointType::regime_switch, {}, arrival);
    return stop(Stop::grazing_border,
                fmt::format("the branch beyond the border does not leave it, at {}", place()));
  }
  const std::vector<double> sizes = watch_.sizes();
  watch_.begin(stepper_.here());
  store(PointType::regime_switch, {}, arrival);
  corner_events(before, sizes);
  stop_in_place();
  // Beyond the corner the parameter is to change as fast as before it, however steep the new piece is. The
  // last step may have been one of rounding, on the way to a value.
  state_.distance =
      std::max(change / std::abs(stepper_.parameter_slope(state_.hold)),
               std::max(1e-3 * length_before, 1e-6 * options_.max_step) / stepper_.slope_length(state_.hold));
}

/// Corners within a regime that no step can pass.
bool Tracer::pass_corner() {
  storing_ = true;
  const Signs before = state_.signs;
  const std::size_t stored = branch_.points.size();
  if (!stepper_.pass_corner()) return false;
  const std::vector<double> sizes = watch_.sizes();
  watch_.begin(stepper_.here());
  corner_events(before, sizes);
  if (branch_.points.size() == stored) store(PointType::regular);
  state_.distance = careful();
  return true;
}

/// Extrema and folds that are corners: a derivative jumps from one sign to the other; and what vanishes
/// there, of functions that came from these sizes.
void Tracer::corner_events(const Signs& before, const std::vector<double>& sizes) {
  state_.signs = signs_at_start(stepper_, watch_);
  user_events_on_corner(before, sizes);
  if (before.parameter * state_.signs.parameter < 0) store(PointType::corner_fold);
  for (std::size_t i = 0; i < state_.signs.observables.size(); ++i) {
    if (before.observables[i] * state_.signs.observables[i] >= 0) continue;
    store(state_.signs.observables[i] < 0 ? PointType::peak : PointType::trough);
  }
}

/// d(u, p_a)/d arclength.
Vector Tracer::raw_tangent() const { return stepper_.here().tangent.cwiseProduct(stepper_.here().scale); }

std::string Tracer::place() const { return fmt::format("{} = {:.10g}", options_.parameter, value()); }

void Tracer::store(PointType type, const std::string& label, const Vector& arrival) {
  const CurvePoint& here = stepper_.here();
  BranchPoint& point = branch_.points.emplace_back();
  point.type = type;
  point.regime = here.regime;
  point.unknowns = here.unknowns;
  point.parameters = here.parameters;
  point.arclength = state_.arclength;
  point.iterations = here.iterations;
  point.residual = here.residual;
  point.tangent = here.tangent.cwiseProduct(here.scale);
  point.arrival = arrival;
  point.eigenvalues = watch_.eigenvalues();
  point.unstable = watch_.unstable();
  point.label = label;
  if (type != PointType::regular && (type != PointType::start) && !options_.stop_after.empty()) {
    const long found = ++state_.found[std::string(to_string(type)) + label];
    for (const StopAfter& rule : options_.stop_after)
      satisfied_ = satisfied_ || (rule.type == type && rule.label == label && found >= rule.count);
  }
  if (is_time_to_look(type)) look_at_derivatives(here.unknowns, here.parameters, here.regime);
  if (observer_ && !observer_(branch_.points.back())) interrupted_ = true;
}

void Tracer::stop(Stop reason, std::string explanation) {
  if (stopped_) return;
  stopped_ = true;
  branch_.stop = reason;
  branch_.explanation = std::move(explanation);
  const std::string why = problem_.reason_of_end();
  const bool is_told = reason == Stop::left_regime || reason == Stop::no_value || reason == Stop::min_step ||
                       reason == Stop::no_start;
  if (is_told && !why.empty()) branch_.explanation += ": " + why;
}

}  // namespace arcslip::continuation
