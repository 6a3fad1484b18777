#include "arcslip/continuation/path/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace arcslip::continuation {

Stepper::Stepper(const Problem& problem, Corrector& corrector, std::vector<Index> tracked, double max_step,
                 bool pairs, const Tolerances& tolerances)
    : problem_(problem),
      corrector_(corrector),
      tracked_(std::move(tracked)),
      max_step_(max_step),
      pairs_(pairs),
      tolerances_(tolerances),
      here_(corrector.make_point()),
      there_(corrector.make_point()),
      probe_(corrector.make_point()),
      beside_(corrector.make_point()) {
  const Index size = corrector.size() + 1;
  for (Vector* v : {&normal_, &slope_from_, &slope_to_, &probe_slope_, &predicted_, &step_, &work_, &bend_,
                    &next_bend_, &expected_}) {
    v->setZero(size);
  }
  gradient_.unknowns.setZero(corrector.size());
  gradient_.parameters.setZero(here_.parameters.size());
  const std::vector<Observable> observables = problem.observables();
  for (const Index which : tracked_) observed_.push_back(observables[static_cast<std::size_t>(which)]);
  past_.reserve(most_past);
  for (std::vector<Monitor>* m : {&at_here_, &from_, &to_, &probed_, &at_beside_})
    m->reserve(tracked_.size() + 8);
}

Correction Stepper::start(const Vector& unknowns, const Vector& parameters, const Regime& regime,
                          double forward) {
  here_.unknowns = unknowns;
  here_.parameters = parameters;
  here_.regime = regime;
  corrector_.set_scale(here_);
  if (!corrector_.calibrate(here_)) return Correction::cannot_evaluate;
  there_ = here_;
  normal_.setZero();
  normal_(normal_.size() - 1) = forward;
  const Correction result = corrector_.correct(here_, there_, normal_, 0, true);
  if (result != Correction::converged) return result;
  here_.parameters = parameters;
  begin_piece(there_);
  return result;
}

Correction Stepper::start_along(const Vector& unknowns, const Vector& parameters, const Regime& regime,
                                const Vector& direction) {
  here_.unknowns = unknowns;
  here_.parameters = parameters;
  here_.regime = regime;
  corrector_.set_scale(here_);
  if (!corrector_.calibrate(here_)) return Correction::cannot_evaluate;
  normal_ = direction.cwiseQuotient(here_.scale);
  normal_.normalize();
  if (!normal_.allFinite()) return Correction::singular;
  there_ = here_;
  Correction result = corrector_.linearise(here_, normal_);
  const bool solved = here_.residual <= corrector_.tolerance() && result != Correction::cannot_evaluate;
  if (!solved) {
    result = corrector_.correct(here_, there_, normal_, 0, true);
    if (result != Correction::converged) return result;
    begin_piece(there_);
    return result;
  }
  here_.tangent = normal_;
  here_.orientation = 0;
  if (result == Correction::converged && !starts_singular()) {
    result = corrector_.linearise(here_, normal_);
    if (result != Correction::converged) return result;
    begin_piece(here_);
  } else {  // a branch point: the direction is all there is
    here_.log_determinant = -std::numeric_limits<double>::infinity();
    monitor(here_, here_.scale, here_.tangent, at_here_);
    bend_.setZero();
    past_.clear();
    revision_ = problem_.revision();
  }
  return Correction::converged;
}

void Stepper::restore(const Progress& progress) {
  here_ = progress.start;
  if (progress.residual_size > 0) {
    corrector_.set_residual_size(progress.residual_size);
  } else if (!corrector_.calibrate(here_)) {
    throw std::invalid_argument("resume: the problem has no value where the branch started");
  }
  here_ = progress.here;
  bend_ = progress.bend;
  at_here_ = progress.monitors;
  past_ = progress.past;
  revision_ = problem_.revision();
  if (!std::isnan(here_.log_determinant)) return;
  if (corrector_.linearise(here_, here_.tangent) == Correction::converged)
    here_.log_determinant = corrector_.log_determinant();
}

Correction Stepper::enter(const Regime& regime) {
  here_.regime = regime;
  double nearest = std::numeric_limits<double>::infinity();
  // The border of the new regime on which the point lies; the new piece leaves it against its gradient.
  for (int b = 0; b < problem_.border_count(regime); ++b) {
    const double value = problem_.border(here_.unknowns, here_.parameters, regime, b, &gradient_);
    if (std::abs(value) >= nearest) continue;
    nearest = std::abs(value);
    scale_gradient(here_.scale, normal_);
  }
  const double length = normal_.norm();
  if (!std::isfinite(nearest) || !(length > 0)) return Correction::singular;
  normal_ /= -length;
  Correction result = corrector_.linearise(here_, normal_);
  // Where the branch is all but tangent to the border its gradient does not tell the way. As F is continuous
  // across, the determinant that t closes does: it keeps its sign.
  const bool vague =
      result == Correction::singular || tolerances_.tangential * corrector_.direction().norm() > 1;
  if (vague && here_.orientation != 0) {
    normal_ = result == Correction::singular ? here_.tangent : corrector_.direction().normalized();
    result = corrector_.linearise(here_, normal_);
    if (result == Correction::converged && corrector_.orientation() != here_.orientation) {
      normal_ = -corrector_.direction().normalized();
      result = corrector_.linearise(here_, normal_);
    }
  }
  if (result != Correction::converged) return result;
  begin_piece(here_);
  return result;
}

// The sign of the determinant that t closes is the same on all pieces of a branch, if t points forward. Where
// it tells that the piece ahead is passed against here's direction, it is met behind the corner.
bool Stepper::turn_back() {
  probe_ = here_;
  probed_when_ = -1;
  for (double ahead = 1e-11; ahead < 1e-6; ahead *= 2) {
    corrector_.displace(here_, ahead * here_.tangent, probe_);
    if (corrector_.linearise(probe_, here_.tangent) != Correction::converged) return false;
    if (corrector_.orientation() == here_.orientation) continue;
    normal_ = -corrector_.direction().normalized();
    corrector_.displace(probe_, 2 * ahead * normal_, there_);
    if (corrector_.correct(there_, probe_, normal_, 2 * ahead, false) != Correction::converged ||
        corrector_.orientation() != here_.orientation || !(corrector_.direction().dot(here_.tangent) < 0))
      continue;
    here_ = there_;
    begin_piece(probe_);
    return true;
  }
  return false;
}

void Stepper::begin_piece(const CurvePoint& origin) {
  corrector_.set_tangent(here_, origin);
  monitor(here_, here_.scale, here_.tangent, at_here_);
  bend_.setZero();
  past_.clear();
  revision_ = problem_.revision();
}

void Stepper::scale_gradient(const Vector& scale, Vector& out) const {
  const Index n = corrector_.size();
  out.head(n) = gradient_.unknowns.cwiseProduct(scale.head(n));
  out(n) = gradient_.parameters(corrector_.parameter()) * scale(n);
}

double Stepper::slope_length(Hold hold) const {
  return hold == Hold::tangent ? 1 : 1 / std::abs(here_.tangent(here_.tangent.size() - 1));
}

double Stepper::parameter_slope(Hold hold) const {
  const double rate = here_.tangent(here_.tangent.size() - 1);
  return hold == Hold::tangent ? rate : std::copysign(1.0, rate);
}

void Stepper::set_condition(Hold hold) {
  if (revision_ != problem_.revision()) rescale_determinant();
  hold_ = hold;
  if (hold == Hold::tangent) {
    normal_ = here_.tangent;
  } else {
    normal_.setZero();
    normal_(normal_.size() - 1) = parameter_slope(hold);
  }
  slope_from_ = here_.tangent * slope_length(hold);
}

// With a = 1/(normal . t) the curve's second derivative in the step's coordinate is a^2 (b - a (normal . b)
// t).
void Stepper::bend_along(Vector& out) const {
  const double a = 1 / normal_.dot(here_.tangent);
  out = a * a * (bend_ - a * normal_.dot(bend_) * here_.tangent);
}

void Stepper::predict() {
  bend_along(work_);
  predicted_ = distance_ * slope_from_ + 0.5 * distance_ * distance_ * work_;
  corrector_.displace(here_, predicted_, there_);
}

bool Stepper::attempt(Hold hold, double distance) {
  set_condition(hold);
  distance_ = distance;
  if (!(distance > 0) || !slope_from_.allFinite()) return false;
  predict();
  return finish(false, 0);
}

bool Stepper::attempt_landing(double value) {
  set_condition(Hold::parameter);
  const Index n = corrector_.size();
  distance_ = std::abs(value - here_.parameters(corrector_.parameter())) / here_.scale(n);
  if (!slope_from_.allFinite()) return false;
  predict();
  return finish(true, value);
}

bool Stepper::finish(bool lands, double value) {
  signals_ = {};
  if (lands) there_.parameters(corrector_.parameter()) = value;
  anchors_.clear();
  const Correction result = corrector_.correct(there_, here_, normal_, distance_, lands);
  signals_.contraction = corrector_.contraction();
  last_correction_ = result;
  crossing_.reset();
  if (result != Correction::converged) {
    signals_.contraction = 1;
    return false;
  }
  if (lands) there_.parameters(corrector_.parameter()) = value;
  slope_to_ = corrector_.direction();
  corrector_.difference(there_, here_, step_);
  signals_.prediction_error = (step_ - predicted_).norm();
  signals_.mismatch = (step_ - 0.5 * distance_ * (slope_from_ + slope_to_)).norm();
  if (hold_ == Hold::tangent) signals_.turn = std::acos(std::min(1.0, 1 / slope_to_.norm()));
  const bool corner = signals_.turn > limits_.turn_limit && is_tiny(distance_);
  if (corner) signals_.turn = 0;
  if (!acceptable(signals_, limits_, max_step_)) return false;
  if (!lands) {
    constexpr double aside = 1e-3;  // of the step: by more no point is moved
    corrector_.close(there_, here_, normal_, aside * step_.norm());
    slope_to_ = corrector_.direction();
    corrector_.difference(there_, here_, step_);
    distance_ = normal_.dot(step_);
  }

  next_bend_ = (slope_to_ - slope_from_) / distance_;
  const bool straight = (slope_to_ - slope_from_).norm() < 1e-6 * slope_to_.norm();
  // rounding, or a corner in between
  if (straight || corner || slope_to_.dot(slope_from_) < 0) next_bend_.setZero();
  corrector_.set_tangent(there_, here_);
  next_bend_.array() *= here_.scale.array() / there_.scale.array();
  next_bend_ /= arc_rate() * arc_rate();
  from_ = at_here_;
  for (Monitor& from : from_) from.slope *= slope_length(hold_);
  monitor(there_, here_.scale, slope_to_, to_);
  if (!resolved(distance_, to_)) {
    signals_.mismatch = limits_.mismatch_limit * 2 * max_step_;
    return false;
  }
  if (!may_cross() || search_crossing()) return true;
  if (there_.orientation == here_.orientation && is_tiny(distance_)) return true;  // a corner
  signals_.turn = limits_.turn_limit * 4;
  return false;
}

void Stepper::monitor(const CurvePoint& point, const Vector& scale, const Vector& slope,
                      std::vector<Monitor>& out) {
  out.clear();
  const auto add = [&](double value) {
    out.push_back({value, rate(gradient_, corrector_.parameter(), scale, slope)});
  };
  for (const Index which : tracked_) {
    add(problem_.observe(point.unknowns, point.parameters, point.regime, which, gradient_));
  }
  for (int b = 0; b < problem_.border_count(point.regime); ++b) {
    add(problem_.border(point.unknowns, point.parameters, point.regime, b, &gradient_));
  }
}

void Stepper::cut() {
  std::swap(there_, probe_);
  slope_to_ = probe_slope_;
  std::swap(to_, probed_);
  distance_ = probed_s_;
  corrector_.difference(there_, here_, step_);
  if (!probe_is_known_) corrector_.set_tangent(there_, here_);
  probed_when_ = -1;
  anchors_.clear();
}

void Stepper::settle_on_border(int border) {
  const Index n = corrector_.size();
  for (int i = 0; i < 3; ++i) {
    const double value =
        problem_.border(there_.unknowns, there_.parameters, there_.regime, border, &gradient_);
    scale_gradient(here_.scale, work_);
    probe_ = there_;
    probed_when_ = -1;
    const Correction result = corrector_.correct_once(there_, here_, work_, -value);
    corrector_.difference(there_, probe_, work_);
    // No rounding is left: where the branch all but touches the border, a step onto it may lead anywhere.
    const bool far = !(work_.norm() <= tolerances_.settled && std::abs(work_(n)) <= tolerances_.last_bits);
    if (result == Correction::converged && !far) continue;
    std::swap(there_, probe_);
    return;
  }
}

double Stepper::arc_rate() const {
  return (slope_to_.array() * here_.scale.array() / there_.scale.array()).matrix().norm();
}

void Stepper::advance() {
  const double rate = arc_rate();
  at_here_ = to_;
  for (Monitor& monitor : at_here_) monitor.slope /= rate;
  remember();
  std::swap(here_, there_);
  bend_ = next_bend_;
}

/// Keeps the determinant at `here`, which is to be left.
void Stepper::remember() {
  const double length = step_.norm();
  for (PastPoint& past : past_) past.behind += length;
  if (past_.size() == most_past) past_.pop_back();
  past_.insert(past_.begin(), {length, here_.orientation, here_.log_determinant, rate_at(here_)});
}

}  // namespace arcslip::continuation
