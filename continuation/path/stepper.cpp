#include "arcslip/continuation/path/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace arcslip::continuation {
namespace {

constexpr double unlike = 1e-3;  // rad: by how much more a branch turns at a corner than on a short step

}  // namespace

Stepper::Stepper(const Problem& problem, Corrector& corrector, std::vector<Index> tracked, double max_step,
                 bool pairs, const Tolerances& tolerances, bool rough_extrema, bool may_bend)
    : problem_(problem),
      corrector_(corrector),
      tolerances_(tolerances),
      max_step_(max_step),
      pairs_(pairs),
      rough_extrema_(rough_extrema),
      may_bend_(may_bend),
      monitors_(problem, corrector.parameter(), std::move(tracked)),
      prober_(corrector, monitors_, step_),
      crossings_(corrector, prober_, step_, tolerances),
      one_curve_(corrector, prober_, step_),
      predictor_(corrector.size() + 1, problem.sparse()),
      aside_(corrector.make_point()) {
  step_.here = step_.there = aside_;
  step_.tiny = tolerances.tiny_step * max_step;
  const Index size = corrector.size() + 1;
  for (Vector* v : {&step_.normal, &step_.slope_from, &step_.slope_to, &step_.chord, &work_})
    v->setZero(size);
  step_.past.reserve(most_past);
  for (std::vector<Monitor>* m : {&at_here_, &step_.from, &step_.to})
    m->reserve(static_cast<std::size_t>(monitors_.tracked_count()) + 8);
}

Correction Stepper::start(const Vector& unknowns, const Vector& parameters, const Regime& regime,
                          double forward) {
  step_.here.unknowns = unknowns;
  step_.here.parameters = parameters;
  step_.here.regime = regime;
  corrector_.set_scale(step_.here);
  if (!corrector_.calibrate(step_.here)) return Correction::cannot_evaluate;
  step_.there = step_.here;
  step_.normal.setZero();
  step_.normal(step_.normal.size() - 1) = forward;
  const Correction result = corrector_.correct(step_.here, step_.there, step_.normal, 0, true);
  if (result != Correction::converged) return result;
  step_.here.parameters = parameters;
  begin_piece(step_.there);
  return result;
}

Correction Stepper::start_along(const Vector& unknowns, const Vector& parameters, const Regime& regime,
                                const Vector& direction) {
  step_.here.unknowns = unknowns;
  step_.here.parameters = parameters;
  step_.here.regime = regime;
  corrector_.set_scale(step_.here);
  if (!corrector_.calibrate(step_.here)) return Correction::cannot_evaluate;
  step_.normal = direction.cwiseQuotient(step_.here.scale);
  step_.normal.normalize();
  if (!step_.normal.allFinite()) return Correction::singular;
  step_.there = step_.here;
  Correction result = corrector_.linearise(step_.here, step_.normal);
  const bool solved = step_.here.residual <= corrector_.tolerance() && result != Correction::cannot_evaluate;
  if (!solved) {
    result = corrector_.correct(step_.here, step_.there, step_.normal, 0, true);
    if (result != Correction::converged) return result;
    begin_piece(step_.there);
    return result;
  }
  step_.here.tangent = step_.normal;
  step_.here.orientation = 0;
  if (result == Correction::converged && !crossings_.starts_singular(max_step_)) {
    result = corrector_.linearise(step_.here, step_.normal);
    if (result != Correction::converged) return result;
    begin_piece(step_.here);
  } else {  // a branch point: the direction is all there is
    step_.here.log_determinant = -std::numeric_limits<double>::infinity();
    monitors_.look(step_.here, step_.here.scale, step_.here.tangent, at_here_);
    // What is the same on both sides has a slope of rounding, or a corner, as the greater of two equal
    // values.
    for (Monitor& monitor : at_here_) monitor.slope = std::numeric_limits<double>::quiet_NaN();
    predictor_.forget();
    step_.past.clear();
    revision_ = problem_.revision();
  }
  return Correction::converged;
}

void Stepper::restore(const Progress& progress) {
  step_.here = progress.start;
  if (progress.residual_size > 0) {
    corrector_.set_residual_size(progress.residual_size);
  } else if (!corrector_.calibrate(step_.here)) {
    throw std::invalid_argument("resume: the problem has no value where the branch started");
  }
  step_.here = progress.here;
  predictor_.set_bends(progress.bends);
  at_here_ = progress.monitors;  // without what follows
  monitors_.look(step_.here, step_.here.scale, step_.here.tangent, step_.to);
  for (std::size_t i = 0; i < at_here_.size(); ++i) {
    at_here_[i].reach = step_.to[i].reach;
    at_here_[i].piece = step_.to[i].piece;
  }
  step_.past = progress.past;
  set_moved(progress.last_value);
  revision_ = problem_.revision() - progress.rescaled;
  if (!std::isnan(step_.here.log_determinant)) return;
  if (corrector_.linearise(step_.here, step_.here.tangent) == Correction::converged)
    step_.here.log_determinant = corrector_.log_determinant();
}

Correction Stepper::enter(const Regime& regime) {
  const bool was_over_parameter = is_over_parameter();
  step_.here.regime = regime;
  if (is_over_parameter() != was_over_parameter) {
    work_ = step_.here.tangent.cwiseProduct(step_.here.scale);
    corrector_.set_scale(step_.here);
    step_.here.tangent = work_.cwiseQuotient(step_.here.scale).normalized();
  }
  double nearest = std::numeric_limits<double>::infinity();
  // The border of the new regime on which the point lies; the new piece leaves it against its gradient.
  for (int b = 0; b < problem_.border_count(regime); ++b) {
    const double value = monitors_.border(step_.here, b, step_.here.scale, work_);
    if (std::abs(value) >= nearest) continue;
    nearest = std::abs(value);
    step_.normal = work_;
  }
  const double length = step_.normal.norm();
  if (!std::isfinite(nearest) || !(length > 0)) return Correction::singular;
  step_.normal /= -length;
  Correction result = corrector_.linearise(step_.here, step_.normal);
  // Where the branch is all but tangent to the border its gradient does not tell the way. As F is continuous
  // across, the determinant that t closes does: it keeps its sign.
  const bool vague =
      result == Correction::singular || tolerances_.tangential * corrector_.direction().norm() > 1;
  if (vague && step_.here.orientation != 0) {
    step_.normal = result == Correction::singular ? step_.here.tangent : corrector_.direction().normalized();
    result = corrector_.linearise(step_.here, step_.normal);
    if (result == Correction::converged && corrector_.orientation() != step_.here.orientation) {
      step_.normal = -corrector_.direction().normalized();
      result = corrector_.linearise(step_.here, step_.normal);
    }
  }
  if (result != Correction::converged) return result;
  begin_piece(step_.here);
  return result;
}

bool Stepper::straighten() {
  if (predictor_.bends().derivatives[0].isZero(0)) return false;
  predictor_.forget();
  return true;
}

// The sign of the determinant that t closes is the same on all pieces of a branch, if t points forward: where
// it tells that the piece ahead is passed against here's direction, it is met behind the corner.
bool Stepper::pass_corner() {
  aside_ = step_.here;
  for (double ahead = 1e-11; ahead < 1e-6; ahead *= 2) {
    corrector_.displace(step_.here, ahead * step_.here.tangent, aside_);
    if (corrector_.linearise(aside_, step_.here.tangent) != Correction::converged) continue;
    const double way = corrector_.orientation() == step_.here.orientation ? 1 : -1;
    step_.normal = way * corrector_.direction().normalized();
    if (step_.normal.dot(step_.here.tangent) > std::cos(unlike) ||
        !finds(aside_, step_.normal, 2 * ahead, step_.here.orientation) ||
        crossed_border(problem_, step_.there.unknowns, step_.there.parameters, step_.there.regime,
                       tolerances_.both_sides) >= 0)
      continue;
    step_.here = step_.there;
    begin_piece(aside_);
    return true;
  }
  return false;
}

/// Whether the branch is met this far from a point along a direction, in which it runs there forwards.
bool Stepper::finds(const CurvePoint& from, const Vector& along, double distance, double orientation) {
  constexpr double solved = 1e-3;  // of the way: at the corner itself there is nothing to see
  constexpr double alike = 0.9;
  step_.there = from;
  work_ = distance * along;
  corrector_.displace(from, work_, step_.there);
  return corrector_.correct(step_.there, from, along, distance, true) == Correction::converged &&
         step_.there.residual < solved * distance * corrector_.residual_size() &&
         corrector_.orientation() == orientation && corrector_.direction().normalized().dot(along) > alike;
}

bool Stepper::look_ahead(double way) {
  set_condition(Hold::tangent);
  step_.distance = way;
  return prober_.probe(0) && prober_.look_beside(way) != 0;
}

void Stepper::begin_piece(const CurvePoint& origin) {
  corrector_.set_tangent(step_.here, origin);
  monitors_.look(step_.here, step_.here.scale, step_.here.tangent, at_here_);
  predictor_.forget();
  step_.past.clear();
  revision_ = problem_.revision();
}

double Stepper::slope_length(Hold hold) const {
  return hold == Hold::tangent ? 1 : 1 / std::abs(step_.here.tangent(step_.here.tangent.size() - 1));
}

double Stepper::parameter_slope(Hold hold) const {
  const double rate = step_.here.tangent(step_.here.tangent.size() - 1);
  return hold == Hold::tangent ? rate : std::copysign(1.0, rate);
}

void Stepper::set_condition(Hold hold) {
  if (is_rescaled()) {
    revision_ = problem_.revision();
    crossings_.rescale(max_step_);
  }
  step_.hold = hold;
  if (hold == Hold::tangent) {
    step_.normal = step_.here.tangent;
  } else {
    step_.normal.setZero();
    step_.normal(step_.normal.size() - 1) = parameter_slope(hold);
  }
  step_.slope_from = step_.here.tangent * slope_length(hold);
}

void Stepper::predict() {
  predictor_.predict(step_, work_);
  corrector_.displace(step_.here, work_, step_.there);
}

bool Stepper::attempt(Hold hold, double distance) {
  set_condition(hold);
  step_.distance = distance;
  if (!(distance > 0) || !step_.slope_from.allFinite()) return false;
  predict();
  return finish(false, 0);
}

bool Stepper::attempt_landing(double value) {
  set_condition(Hold::parameter);
  const Index n = corrector_.size();
  step_.distance = std::abs(value - step_.here.parameters(corrector_.parameter())) / step_.here.scale(n);
  if (!step_.slope_from.allFinite()) return false;
  predict();
  return finish(true, value);
}

bool Stepper::finish(bool lands, double value) {
  signals_ = {};
  if (lands) step_.there.parameters(corrector_.parameter()) = value;
  step_.anchors.clear();
  const Correction result = corrector_.correct(step_.there, step_.here, step_.normal, step_.distance, lands);
  signals_.contraction = corrector_.contraction();
  last_correction_ = result;
  step_.crossing.reset();
  if (result != Correction::converged) {
    signals_.contraction = 1;
    return false;
  }
  if (lands) step_.there.parameters(corrector_.parameter()) = value;
  step_.slope_to = corrector_.direction();
  corrector_.difference(step_.there, step_.here, step_.chord);
  // Held at a parameter whose last bits stay the same, as at an edge of what has a value, it has come back.
  if (!lands && !(step_.normal.dot(step_.chord) > 0.5 * step_.distance)) {
    signals_.contraction = 1;
    return false;
  }
  signals_.prediction_error = (step_.chord - predictor_.parabola()).norm();
  work_ = step_.chord - 0.5 * step_.distance * (step_.slope_from + step_.slope_to);
  constexpr double closer = 3;  // than elsewhere
  if (is_over_parameter() && (lands || on_target_) && !step_.is_tiny(step_.distance))
    work_.head(corrector_.size()) *= closer * not_counted;
  signals_.mismatch = work_.norm();
  if (step_.hold == Hold::tangent) signals_.turn = std::acos(std::min(1.0, 1 / step_.slope_to.norm()));
  const bool corner = signals_.turn > limits_.turn_limit && step_.is_tiny(step_.distance);
  if (corner) signals_.turn = 0;
  if (!acceptable(signals_, limits_, max_step_)) return false;
  if (!lands) {
    constexpr double aside = 1e-3;  // of the step: by more no point is moved
    corrector_.close(step_.there, step_.here, step_.normal, aside * step_.chord.norm());
    step_.slope_to = corrector_.direction();
    corrector_.difference(step_.there, step_.here, step_.chord);
    step_.distance = step_.normal.dot(step_.chord);
  }

  corrector_.set_tangent(step_.there, step_.here);
  predictor_.learn(step_, corrector_.options().tolerance, corner);
  if (ends_singular()) {
    signals_.turn = limits_.turn_limit * 4;
    return false;
  }
  step_.from = at_here_;
  for (Monitor& from : step_.from) from.slope *= slope_length(step_.hold);
  monitors_.look(step_.there, step_.here.scale, step_.slope_to, step_.to);
  if (!is_near_meeting()) {
    const double rough = roughness(step_.distance, step_.to);
    if (is_over_parameter()) signals_.roughness = rough;
    if (rough > 1) {
      signals_.mismatch = limits_.mismatch_limit * 2 * max_step_;
      return false;
    }
  }
  if (!knows_crossings(corner)) return false;
  constexpr double shortest = 1e-5;                                        // of the largest step
  const bool is_smooth = pairs_ && may_bend_ && !corner && !is_regular();  // not made of derivatives
  if (!is_smooth || step_.chord.norm() < shortest * max_step_ || one_curve_.joins(predictor_.parabola()))
    return true;
  signals_.mismatch = limits_.mismatch_limit * 2 * max_step_;
  return false;
}

/// Whether the step has no branch points but those that are found in it, be they at a corner.
bool Stepper::knows_crossings(bool corner) {
  const bool keeps_way = step_.there.orientation == step_.here.orientation;
  if (keeps_way || !turns_at_once() || goes_on()) {
    if (is_regular() ? keeps_way : !crossings_.may_find(pairs_) || crossings_.search(may_bend_)) return true;
    const bool may_leap = may_bend_ && !keeps_way && !corner && !is_regular();
    if (step_.is_tiny(step_.distance) && (keeps_way || (may_leap && crossings_.jumps())))
      return true;  // a corner
  }
  signals_.turn = limits_.turn_limit * 4;
  return false;
}

/// Whether a step so short that on it a curve is straight ends in another direction.
bool Stepper::turns_at_once() const {
  return step_.is_tiny(step_.distance) && step_.there.tangent.dot(step_.here.tangent) < std::cos(unlike);
}

/// Whether the branch goes on from the end of a short step in the direction that it has there. At a corner
/// that is also met but for rounding where what is behind it leads backwards.
bool Stepper::goes_on() {
  constexpr double farthest = 100;
  if (step_.there.tangent.dot(step_.here.tangent) < 0) return false;  // it came back, at a held parameter
  const CurvePoint from = step_.there;
  bool met = false;
  for (double ahead = 4 * step_.chord.norm(); !met && ahead < farthest * step_.tiny; ahead *= 4)
    met = finds(from, from.tangent, ahead, from.orientation);
  step_.there = from;
  return met && corrector_.linearise(step_.there, step_.normal) == Correction::converged;
}

/// Whether the end lies on a branch point but for rounding, from where no step tells where the branch goes
/// on: a shorter step has it between its successor's ends.
bool Stepper::ends_singular() const {
  constexpr double rounding = 1e-12;  // of the determinant
  return !step_.is_tiny(step_.distance) && std::isfinite(step_.here.log_determinant) &&
         step_.there.log_determinant < step_.here.log_determinant + std::log(rounding);
}

double Stepper::roughness(double s, const std::vector<Monitor>& at_s) const {
  constexpr double shallow = 100;  // times the tolerance: the values themselves are no better
  // No more than a factor of two at a time: an observable is wanted as a curve, too.
  Monitors::Limits limits{0.5, 0.15, shallow * corrector_.tolerance()};
  if (is_over_parameter()) {  // where nothing else tells how long a step may be
    limits.change = std::min(limits.change, 5 * max_step_);
    limits.bend = 0.12;
  }
  return monitors_.roughness(step_, s, at_s, limits);
}

void Stepper::settle_on_border(int border) {
  const Index n = corrector_.size();
  for (int i = 0; i < 3; ++i) {
    const double value = monitors_.border(step_.there, border, step_.here.scale, work_);
    aside_ = step_.there;
    const Correction result = corrector_.correct_once(step_.there, step_.here, work_, -value);
    corrector_.difference(step_.there, aside_, work_);
    // No rounding is left: where the branch all but touches the border, a step onto it may lead anywhere.
    const bool far = !(work_.norm() <= tolerances_.settled && std::abs(work_(n)) <= tolerances_.last_bits);
    if (result != Correction::converged || far) return std::swap(step_.there, aside_);
  }
}

void Stepper::advance() {
  const double rate = step_.arc_rate();
  at_here_ = step_.to;
  for (Monitor& monitor : at_here_) monitor.slope /= rate;
  const double length = step_.chord.norm();
  for (PastPoint& past : step_.past) past.behind += length;
  if (step_.past.size() == most_past) step_.past.pop_back();
  step_.past.insert(step_.past.begin(),
                    {length, step_.here.orientation, step_.here.log_determinant, parameter_rate(step_.here)});
  std::swap(step_.here, step_.there);
  set_moved(step_.there.parameters(corrector_.parameter()));
  predictor_.advance();
}

void Stepper::set_moved(double before) {
  const CurvePoint& here = step_.here;
  step_.moved = (here.parameters(corrector_.parameter()) - before) / here.scale(corrector_.size());
}

}  // namespace arcslip::continuation
