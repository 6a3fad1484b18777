// How a branch begins: from a guess, along a direction, or on a special point.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

void Tracer::start(const Guess& guess, double forward) {
  check_functions(problem_, guess.unknowns, guess.parameters, guess.regime, stepper_.monitors().tracked());
  Correction result =
      guess.direction.size() > 0
          ? stepper_.start_along(guess.unknowns, guess.parameters, guess.regime, forward * guess.direction)
          : stepper_.start(guess.unknowns, guess.parameters, guess.regime, forward);
  if (result != Correction::converged && result != Correction::cannot_evaluate &&
      guess.direction.size() == 0) {
    if (start_singular(guess, forward) == Correction::converged) result = Correction::converged;
  }
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
  watch_.look(stepper_.here());
  watch_.begin();
  state_.signs = signs_at_start(stepper_, watch_);
  // The eigenvalue that vanishes at a branch point has no sign but that of rounding.
  if (std::isinf(stepper_.here().log_determinant)) state_.signs.unstable = -1;
  state_.start = stepper_.here();
  store(PointType::start);
  take_where_it_starts(guess.direction.size() > 0);
  const double same = options_.tolerances.same_value * parameter_scale();
  const double low = std::min(options_.from, options_.to);
  const double high = std::max(options_.from, options_.to);
  if (!(value() >= low - same && value() <= high + same))
    return stop(Stop::no_start, fmt::format("the start lies outside the range, at {}", place()));
  const int way = state_.signs.parameter;  // from a fold the first step tells
  if ((value() <= low + same && way < 0) || (value() >= high - same && way > 0))
    stop(Stop::left_range, fmt::format("the branch leaves the range where it starts, at {}", place()));
}

/// A start on a fold or on a branch point, where the parameter does not determine the solution.
Correction Tracer::start_singular(const Guess& guess, double forward) {
  const BasePoint near{guess.unknowns, guess.parameters, guess.regime, {}};
  const auto is_there = [&](const BasePoint& point) {
    return std::abs(point.parameters(parameter_) - guess.parameters(parameter_)) <=
           options_.tolerances.start_moves * std::max(1.0, std::abs(guess.parameters(parameter_)));
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
      return stepper_.start_along(at.unknowns, at.parameters, guess.regime,
                                  (rate != 0 ? std::copysign(1.0, rate) : 1) * forward * form->directions[0]);
    }
  }
  FoldProblem fold(problem_, parameter_);
  const auto located = locate(fold, near, corrector_.tolerance());
  evaluations += fold.evaluations();
  if (located && is_there(located->point)) {
    Vector direction = Vector::Zero(corrector_.size() + 1);
    direction.head(corrector_.size()) = forward * fold.right_null();
    return stepper_.start_along(located->point.unknowns, located->point.parameters, guess.regime, direction);
  }
  return Correction::singular;
}

}  // namespace arcslip::continuation
