#include "arcslip/continuation/trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/continuation/events.hpp"

namespace arcslip::continuation {
namespace {

/// A value of the parameter on which the branch puts a point.
struct Target {
  enum class Kind { landmark, user, end, bound };
  double value;
  Kind kind;
};

std::vector<Target> collect_targets(const Problem& problem, Index parameter, const TraceOptions& options) {
  const double low = std::min(options.from, options.to);
  const double high = std::max(options.from, options.to);
  std::vector<Target> targets{{options.to, Target::Kind::end}, {options.from, Target::Kind::bound}};
  for (const double value : options.stop_at) {
    if (!(value >= low && value <= high)) {
      throw std::invalid_argument(fmt::format("stop_at: {} is not between {} and {}", value, low, high));
    }
    targets.push_back({value, Target::Kind::user});
  }
  for (const double value : problem.landmarks(parameter, low, high)) {
    if (value > low && value < high) targets.push_back({value, Target::Kind::landmark});
  }
  // At equal values the more telling kind comes last and wins.
  std::stable_sort(targets.begin(), targets.end(), [](const Target& a, const Target& b) {
    return a.value != b.value ? a.value < b.value : a.kind < b.kind;
  });
  std::vector<Target> distinct;
  for (const Target& target : targets) {
    if (!distinct.empty() && distinct.back().value == target.value) distinct.pop_back();
    distinct.push_back(target);
  }
  return distinct;
}

void check(const TraceOptions& options) {
  const auto require = [](bool good, const char* what) {
    if (!good) throw std::invalid_argument(std::string("trace: ") + what);
  };
  require(std::isfinite(options.from) && std::isfinite(options.to), "`from` and `to` must be finite");
  require(options.from != options.to, "`from` and `to` must differ");
  require(options.tolerance > 0, "`tolerance` must be positive");
  require(options.min_step > 0 && options.min_step <= options.max_step, "0 < min_step <= max_step is needed");
  require(options.max_points >= 2, "`max_points` must be at least 2");
}

std::vector<Index> tracked_observables(const Problem& problem, const TraceOptions& options) {
  const std::vector<Observable> observables = problem.observables();
  std::vector<std::string> names;
  names.reserve(observables.size());
  for (const Observable& observable : observables) names.push_back(observable.name);
  std::vector<Index> tracked;
  for (const std::string& name : options.extrema_of) {
    tracked.push_back(index_of(names, name));
    if (!observables[static_cast<std::size_t>(tracked.back())].has_gradient) {
      throw std::invalid_argument(fmt::format("extrema_of: '{}' has no gradient", name));
    }
  }
  return tracked;
}

class Tracer {
 public:
  Tracer(const Problem& problem, const TraceOptions& options, const Observer& observer)
      : problem_(problem),
        options_(options),
        observer_(observer),
        parameter_(index_of(problem.parameter_names(), options.parameter)),
        corrector_(problem, parameter_, {options.tolerance}),
        stepper_(problem, corrector_, tracked_observables(problem, options), options.max_step),
        targets_(collect_targets(problem, parameter_, options)),
        distance_(0.1 * options.max_step) {
    branch_.points.reserve(1024);
  }

  Branch run(const Guess& guess) {
    if (start(guess)) {
      while (step()) {
      }
    }
    branch_.work = corrector_.work();
    return std::move(branch_);
  }

 private:
  bool start(const Guess& guess);
  bool step();
  bool try_step();
  bool find_event();
  bool take();
  bool take_event(const Event& event, const Signs& before);
  bool take_target(const Target& target);
  bool cross(Index border);
  bool corner_events(const Signs& before);
  const Target* target_ahead(double reach) const;
  bool passes_target(const CurvePoint& point) const;
  double length() const { return distance_ * stepper_.slope_length(hold_); }
  void use(Hold hold);
  bool store(PointType type);
  bool stop(Stop reason, std::string explanation);
  std::string place() const;

  const Problem& problem_;
  const TraceOptions& options_;
  const Observer& observer_;
  Index parameter_;
  Corrector corrector_;
  Stepper stepper_;
  std::vector<Target> targets_;
  Signs signs_;
  Hold hold_ = Hold::tangent;
  double distance_;  // of the next step, in the coordinate of hold_
  double arclength_ = 0;
  const Target* landing_ = nullptr;
  std::optional<Event> event_;
  Branch branch_;
};

bool Tracer::start(const Guess& guess) {
  Vector parameters = guess.parameters;
  parameters(parameter_) = options_.from;
  const double forward = options_.to > options_.from ? 1 : -1;
  if (stepper_.start(guess.unknowns, parameters, guess.regime, forward) != Correction::converged) {
    return stop(Stop::no_start, fmt::format("no solution was found from the guess at {} = {:.10g}",
                                            options_.parameter, options_.from));
  }
  for (auto b = static_cast<std::size_t>(stepper_.tracked_count()); b < stepper_.at_here().size(); ++b) {
    if (stepper_.at_here()[b].value > 1e-12) {
      return stop(Stop::no_start,
                  fmt::format("the start lies outside the regime '{}' that was given for it",
                              problem_.regime_names()[static_cast<std::size_t>(guess.regime)]));
    }
  }
  signs_.reset(stepper_.at_here(), stepper_.tracked_count(), stepper_.parameter_slope(Hold::tangent));
  return store(PointType::start);
}

bool Tracer::step() {
  if (static_cast<long>(branch_.points.size()) >= options_.max_points) {
    return stop(Stop::max_points, fmt::format("max_points = {} points were stored; the branch stands at {}",
                                              options_.max_points, place()));
  }
  while (!try_step()) {
    ++corrector_.work().rejected_steps;
    if (length() < options_.min_step) {
      return stop(Stop::min_step, fmt::format("no step of at least min_step = {:g} is acceptable from {}",
                                              options_.min_step, place()));
    }
  }
  return take();
}

bool Tracer::try_step() {
  distance_ = std::min(distance_, options_.max_step / stepper_.slope_length(hold_));
  landing_ = target_ahead(1.1 * distance_ * std::abs(stepper_.parameter_slope(hold_)));
  if (landing_ != nullptr) {
    if (stepper_.attempt_landing(landing_->value) && find_event()) return true;
    use(Hold::parameter);
    distance_ = 0.5 * stepper_.distance();
    return false;
  }
  if (!stepper_.attempt(hold_, distance_)) {
    const double factor = step_factor(stepper_.signals(), {}, options_.max_step);
    const Hold held = hold_;
    use(hold_ == Hold::tangent ? Hold::parameter : Hold::tangent);
    if (!stepper_.attempt(hold_, distance_)) {
      use(held);
      distance_ *= factor;
      return false;
    }
  }
  if (!passes_target(stepper_.there()) && find_event()) return true;
  distance_ *= 0.5;
  return false;
}

bool Tracer::find_event() {
  const EventSearch search = find_first_event(stepper_, signs_);
  event_ = search.first;
  if (!search.solved || !event_ || event_->kind != Event::Kind::fold) return search.solved;
  return stepper_.probe(event_->s) &&
         !passes_target(stepper_.probed_point());  // a fold's tip reaches farthest
}

/// The nearest target within `reach` (in the parameter's scale) in the direction of travel.
const Target* Tracer::target_ahead(double reach) const {
  const double here = stepper_.here().parameters(parameter_);
  const double limit = reach * stepper_.here().scale(stepper_.here().scale.size() - 1);
  const double direction = stepper_.parameter_slope(Hold::tangent) > 0 ? 1 : -1;
  const Target* nearest = nullptr;
  for (const Target& target : targets_) {
    const double ahead = direction * (target.value - here);
    if (ahead > 0 && ahead <= limit && (nearest == nullptr || ahead < direction * (nearest->value - here))) {
      nearest = &target;
    }
  }
  return nearest;
}

/// Whether a target lies between here and a point of the step, which then has to land on it first.
bool Tracer::passes_target(const CurvePoint& point) const {
  const double a = stepper_.here().parameters(parameter_);
  const double b = point.parameters(parameter_);
  return std::any_of(targets_.begin(), targets_.end(),
                     [&](const Target& target) { return (target.value - a) * (target.value - b) < 0; });
}

void Tracer::use(Hold hold) {
  const double now = length();
  hold_ = hold;
  distance_ = now / stepper_.slope_length(hold);
}

bool Tracer::take() {
  const bool whole = landing_ == nullptr && !event_;
  const double factor = step_factor(stepper_.signals(), {}, options_.max_step);
  if (event_) {
    stepper_.probe(event_->s);
    stepper_.cut(event_->s);
    if (event_->kind == Event::Kind::crossing) stepper_.settle_on_border(static_cast<int>(event_->index));
  }
  arclength_ += stepper_.chord();
  stepper_.advance();
  if (whole) distance_ *= factor;
  const Signs before = signs_;
  signs_.update(stepper_.at_here(), stepper_.parameter_slope(Hold::tangent));
  if (event_) return take_event(*event_, before);
  return landing_ != nullptr ? take_target(*landing_) : store(PointType::regular);
}

bool Tracer::take_event(const Event& event, const Signs& before) {
  switch (event.kind) {
    case Event::Kind::fold: signs_.parameter = -before.parameter; return store(PointType::fold);
    case Event::Kind::extremum: {
      const auto which = static_cast<std::size_t>(event.index);
      signs_.observables[which] = -before.observables[which];
      return store(before.observables[which] > 0 ? PointType::peak : PointType::trough);
    }
    case Event::Kind::crossing: return cross(event.index);
  }
  return false;
}

bool Tracer::take_target(const Target& target) {
  switch (target.kind) {
    case Target::Kind::landmark: return store(PointType::regular);
    case Target::Kind::user: return store(PointType::user);
    case Target::Kind::end:
      return store(PointType::end) && stop(Stop::reached_end, "the last value was reached");
    case Target::Kind::bound:
      return store(PointType::end) && stop(Stop::left_range, "the branch came back to its first value");
  }
  return false;
}

bool Tracer::cross(Index border) {
  const Signs signs_before = signs_;
  const double length_before = length();
  const double change = distance_ * std::abs(stepper_.parameter_slope(hold_));
  const int regime = problem_.regime_beyond(stepper_.here().regime, static_cast<int>(border));
  if (stepper_.enter(regime) != Correction::converged) {
    return store(PointType::regime_switch) &&
           stop(Stop::grazing_border,
                fmt::format("the branch beyond the border does not leave it, at {}", place()));
  }
  if (!store(PointType::regime_switch) || !corner_events(signs_before)) return false;
  // Beyond the corner the parameter is to change as fast as before it, however steep the new piece is.
  distance_ = std::max(change / std::abs(stepper_.parameter_slope(hold_)),
                       1e-3 * length_before / stepper_.slope_length(hold_));
  return true;
}

/// Extrema and folds that are corners: a derivative jumps from one sign to the other.
bool Tracer::corner_events(const Signs& before) {
  signs_.reset(stepper_.at_here(), stepper_.tracked_count(), stepper_.parameter_slope(Hold::tangent));
  if (before.parameter * signs_.parameter < 0 && !store(PointType::fold)) return false;
  for (std::size_t i = 0; i < signs_.observables.size(); ++i) {
    if (before.observables[i] * signs_.observables[i] >= 0) continue;
    if (!store(signs_.observables[i] < 0 ? PointType::peak : PointType::trough)) return false;
  }
  return true;
}

bool Tracer::store(PointType type) {
  const CurvePoint& here = stepper_.here();
  branch_.points.push_back(
      {type, here.regime, here.unknowns, here.parameters, arclength_, here.iterations, here.residual});
  if (!observer_ || observer_(branch_.points.back())) return true;
  return stop(Stop::interrupted, fmt::format("interrupted at {}", place()));
}

bool Tracer::stop(Stop reason, std::string explanation) {
  branch_.stop = reason;
  branch_.explanation = std::move(explanation);
  return false;
}

std::string Tracer::place() const {
  return fmt::format("{} = {:.10g}", options_.parameter, stepper_.here().parameters(parameter_));
}

}  // namespace

Branch trace(const Problem& problem, const Guess& guess, const TraceOptions& options,
             const Observer& observer) {
  check(options);
  return Tracer(problem, options, observer).run(guess);
}

}  // namespace arcslip::continuation
