// How a branch begins: from a guess, along a direction, or on a special point.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/path/tracer.hpp"
#include "arcslip/continuation/points/normal_form.hpp"
#include "arcslip/continuation/problem/evaluation.hpp"

namespace arcslip::continuation {

std::string_view reason(Correction correction) {
  switch (correction) {
    case Correction::converged: return "the tangent turns or the branch bends too much";
    case Correction::cannot_evaluate: return "the problem has no value there";
    case Correction::singular: return "the Jacobian is singular";
    case Correction::diverging: return "Newton's method diverges";
    case Correction::too_many_iterations: return "Newton's method converges too slowly";
  }
  return "";
}

namespace {

/// Whether the parameter changes by rounding alone, which tells no way.
bool stands_still(const Vector& tangent) {
  constexpr double least_rate = 1e-14;
  return std::abs(tangent(tangent.size() - 1)) < least_rate;
}

}  // namespace

void Tracer::start(const Guess& guess, double forward) {
  check_functions(problem_, guess.unknowns, guess.parameters, guess.regime, stepper_.monitors().tracked());
  Correction result =
      guess.direction.size() > 0
          ? stepper_.start_along(guess.unknowns, guess.parameters, guess.regime, forward * guess.direction)
          : stepper_.start(guess.unknowns, guess.parameters, guess.regime, forward);
  const bool is_free = guess.direction.size() == 0;
  const auto may_be_singular = [&] {
    return result == Correction::converged ? stepper_.starts_singular()
                                           : result != Correction::cannot_evaluate;
  };
  if (is_free && result == Correction::converged && stands_still(stepper_.here().tangent)) {
    if (start_singular(guess, forward, false) != Correction::converged)
      result = stepper_.start(guess.unknowns, guess.parameters, guess.regime, forward);
  } else if (is_free && may_be_singular() &&
             start_singular(guess, forward, result == Correction::converged) == Correction::converged) {
    result = Correction::converged;
  }
  if (is_free && result != Correction::converged && start_from_afar(guess, forward))
    result = Correction::converged;
  if (result != Correction::converged) {
    look_at_derivatives(guess.unknowns, guess.parameters, guess.regime);
    return stop(Stop::no_start,
                fmt::format("no solution was found from the guess at {} = {:.10g}: {}", options_.parameter,
                            guess.parameters(parameter_), reason(result)));
  }
  for (auto b = static_cast<std::size_t>(stepper_.monitors().tracked_count()); b < stepper_.at_here().size();
       ++b) {
    if (stepper_.at_here()[b].value > options_.tolerances.outside) {
      return stop(Stop::no_start, fmt::format("the start lies outside the regime '{}' that was given for it",
                                              problem_.describe(guess.regime)));
    }
  }
  if (stepper_.is_over_parameter()) state_.distance = options_.max_step;
  storing_ = true;
  const bool on_branch_point = std::isinf(stepper_.here().log_determinant);
  watch_.begin(stepper_.here());
  state_.signs = signs_at_start(stepper_, watch_);
  state_.start = stepper_.here();
  store(PointType::start);
  take_where_it_starts(!is_free || on_branch_point);
  const double same = options_.tolerances.same_value * parameter_scale();
  const double low = std::min(options_.from, options_.to);
  const double high = std::max(options_.from, options_.to);
  if (!(value() >= low - same && value() <= high + same))
    return stop(Stop::no_start, fmt::format("the start lies outside the range, at {}", place()));
  const int way = state_.signs.parameter;  // from a fold the first step tells
  const auto leaves = [&](int sign) {
    return (value() <= low + same && sign < 0) || (value() >= high - same && sign > 0);
  };
  const bool is_ahead = forward * (options_.to - options_.from) > 0;
  if (is_free && is_ahead && on_branch_point) store(PointType::branch_point);
  if (leaves(way))
    return stop(Stop::left_range, fmt::format("the branch leaves the range where it starts, at {}", place()));
  if (is_free) set_signs_of_zeros(is_ahead, leaves(-way));
}

/// Of what vanishes where a branch starts the sign is the one before, so that the first step tells it: on one
/// of the two ways from there. What turns has the same sign on both, and the way ahead tells it; a function
/// is taken as positive before, as those are that end a curve. The only way within the range tells all.
void Tracer::set_signs_of_zeros(bool is_ahead, bool is_only) {
  constexpr double little_way = 1e-3;  // of the largest step
  constexpr double much_less = 1e-5;
  if (!stepper_.look_ahead(little_way * options_.max_step)) return;
  const Probe& ahead = stepper_.prober().beside();
  const auto vanishes = [](double here, double there) {
    return std::abs(here) <= much_less * std::abs(there);
  };
  const auto take_turn = [&](int& sign, double here, double there) {
    if (vanishes(here, there)) sign = is_ahead || is_only ? -sign_of(there) : sign_of(there);
  };
  if (!std::isinf(stepper_.here().log_determinant)) {
    take_turn(state_.signs.parameter, stepper_.parameter_slope(Hold::tangent), ahead.parameter_rate());
    for (std::size_t i = 0; i < state_.signs.observables.size(); ++i)
      take_turn(state_.signs.observables[i], stepper_.at_here()[i].slope, ahead.monitors[i].slope);
  }
  count_unstable_before(ahead.point, is_ahead || is_only);
  if (watch_.searched() == 0) return;
  watch_.look(ahead.point);
  for (std::size_t i = 0; i < watch_.searched(); ++i) {
    const double there = watch_.functions()[i];
    if (there == 0 || !vanishes(watch_.kept().front().functions[i], there)) continue;
    if (is_only) {
      state_.signs.functions[i] = -sign_of(there);
    } else if (!watch_.piece_of(i)) {  // which by its own sign lies on one of the two ways
      state_.signs.functions[i] = 1;
    }
  }
  watch_.look(stepper_.here());
}

/// The same of eigenvalues on the axis but for rounding: on the way that tells of them those are unstable
/// before that are not ahead.
void Tracer::count_unstable_before(const CurvePoint& ahead, bool tells) {
  const bool on_branch_point = std::isinf(stepper_.here().log_determinant);  // where the step itself tells
  if (on_branch_point || state_.signs.unstable < 0 || watch_.eigenvalues().size() == 0) return;
  const std::vector<double>& rates = watch_.kept().front().rates;
  const double near = options_.tolerances.rough * watch_.eigenvalues().cwiseAbs().maxCoeff();
  const auto above = [&](double bound) {
    return std::count_if(rates.begin(), rates.end(), [=](double rate) { return rate > bound; });
  };
  const Index least = above(near);
  const Index most = above(-near);
  if (least == most) return;
  watch_.look(ahead);
  Index unstable = least;
  bool all_leave = watch_.eigenvalues().size() >= most;  // the axis, on which some may stay
  for (Index i = least; i < most && all_leave; ++i) {
    const double there = watch_.eigenvalues()(i).real();
    all_leave = std::abs(there) > near;
    unstable += static_cast<Index>((there > 0) != tells);
  }
  if (all_leave) state_.signs.unstable = static_cast<int>(unstable);
  watch_.look(stepper_.here());
}

/// From a guess so far off that corrections have to be shortened: whether they lead to a solution.
bool Tracer::start_from_afar(const Guess& guess, double forward) {
  NewtonOptions damped;
  damped.max_iterations = 100;
  damped.damped = true;
  damped.watch = corrector_.options().watch;
  const Solution found = solve(problem_, guess, damped);
  Work& work = corrector_.work();
  work.evaluations += found.iterations + 1;
  work.factorizations += found.iterations;
  work.iterations += found.iterations;
  return found.outcome == Correction::converged &&
         stepper_.start(found.unknowns, guess.parameters, guess.regime, forward) == Correction::converged;
}

/// A start on a fold or on a branch point, or where the parameter stands still along the whole branch, where
/// it does not determine the solution.
Correction Tracer::start_singular(const Guess& guess, double forward, bool is_found) {
  const BasePoint near{guess.unknowns, guess.parameters, guess.regime, {}};
  const auto is_there = [&](const BasePoint& point) {
    return std::abs(point.parameters(parameter_) - guess.parameters(parameter_)) <=
           options_.tolerances.start_moves * std::max(1.0, std::abs(guess.parameters(parameter_)));
  };
  const auto along = [&](const BasePoint& from, const Vector& direction) {
    const Correction result = stepper_.start_along(from.unknowns, from.parameters, guess.regime, direction);
    if (result == Correction::converged || !is_found) return result;
    return stepper_.start(guess.unknowns, guess.parameters, guess.regime, forward);
  };
  BasePoint unfolded = near;
  unfolded.extras = Vector::Zero(1);
  long& evaluations = corrector_.work().evaluations;
  BranchPointProblem branch_point(problem_, parameter_);
  const auto located_branch_point = locate(branch_point, unfolded, corrector_.tolerance());
  evaluations += branch_point.evaluations();
  if (located_branch_point && is_there(located_branch_point->point)) {
    const BasePoint& there = located_branch_point->point;
    const Guess at{there.unknowns, there.parameters, guess.regime, {}};
    const auto form = branch_point_form(problem_, parameter_, at, options_.tolerances);
    if (form) evaluations += form->evaluations;
    if (form && form->directions[0].size() > 0) {
      const double rate = form->directions[0](corrector_.size());
      return along(there, (rate != 0 ? std::copysign(1.0, rate) : 1) * forward * form->directions[0]);
    }
  }
  FoldProblem fold(problem_, parameter_);
  auto located = locate(fold, near, corrector_.tolerance());
  if (located && !is_there(located->point)) located.reset();
  const bool is_known = located || (!is_found && nearly_solves(problem_, guess) && fold.adapt(near));
  evaluations += fold.evaluations();
  if (!is_known) return Correction::singular;
  const BasePoint& there = located ? located->point : near;
  Vector direction = Vector::Zero(corrector_.size() + 1);
  direction.head(corrector_.size()) = forward * fold.right_null();
  return along(there, direction);
}

}  // namespace arcslip::continuation
