// What lies within a step: whether it is seen, and the branch at any place of it.

#include <algorithm>
#include <array>
#include <cmath>

#include "arcslip/continuation/path/stepper.hpp"

namespace arcslip::continuation {
namespace {

/// Where the slope of the cubic on [0, 1] with these end slopes of one sign and this change is least, if that
/// is less than a third of the slope at either end, by more than `shallow`: there may be a pair of extrema.
std::optional<double> dip(double slope_0, double slope_1, double change, double shallow) {
  if (!(slope_0 * slope_1 > 0)) return std::nullopt;
  const double sign = slope_0 > 0 ? 1 : -1;
  const double a = sign * slope_0;
  const double b = 6 * sign * change - 4 * a - 2 * sign * slope_1;  // slope a + b x + c x^2
  const double c = -b + sign * slope_1 - a;
  if (!(c > 0) || !(b < 0) || !(-b < 2 * c)) return std::nullopt;
  const double least = std::min(a, sign * slope_1);
  const double lowest = a - b * b / (4 * c);
  if (!(lowest < least / 3) || !(least - lowest > shallow)) return std::nullopt;
  return -b / (2 * c);
}

}  // namespace

double Stepper::rate_at(const CurvePoint& point) const {
  const Index n = corrector_.size();
  return point.tangent(n) * point.scale(n);
}

bool Stepper::may_turn_twice() const {
  std::array<double, 2 + most_past> places{step_.norm(), 0};
  std::array<double, 2 + most_past> rates{rate_at(there_), rate_at(here_)};
  std::size_t count = 2;
  for (const PastPoint& past : past_) {
    places[count] = -past.behind;
    rates[count++] = past.rate;
  }
  return may_vanish_twice({places.data(), count}, {rates.data(), count});
}

bool Stepper::resolved(double s, const std::vector<Monitor>& at_s) const {
  if (is_tiny(s)) return true;
  const double shallow = 100 * corrector_.tolerance();  // the values themselves are no better
  for (std::size_t i = 0; i < from_.size(); ++i) {
    const Monitor& a = from_[i];
    const Monitor& b = at_s[i];
    const double change = (i < tracked_.size() ? observed_[i].near(b.value, a.value) : b.value) - a.value;
    const double size = i < tracked_.size() ? size_of(i, std::max(std::abs(a.value), std::abs(b.value))) : 1;
    // No more than a factor of two at a time: the observable is wanted as a curve, too.
    if (i < tracked_.size() && a.value * b.value > 0 && std::abs(change) > 0.5 * size) return false;
    // The mean of the end slopes is to give the change, or else there is more between than these can tell.
    const double error = std::abs(change - 0.5 * s * (a.slope + b.slope));
    const double turned = 0.5 * s * (std::abs(a.slope) + std::abs(b.slope));
    if (error > 0.1 * size || error > 0.15 * turned + shallow * size) return false;
    if (dip(a.slope * s, b.slope * s, change, shallow * size)) return false;
  }
  return true;
}

/// What is still unlike a curve on so short a step is rounding, or a corner.
bool Stepper::is_tiny(double s) const { return s * slope_from_.norm() < tolerances_.tiny_step * max_step_; }

/// By the cubic between the nearest points of the branch that are known.
void Stepper::interpolate(double s, Vector& out) const {
  const auto next =
      std::find_if(anchors_.begin(), anchors_.end(), [s](const Anchor& anchor) { return anchor.s >= s; });
  const Anchor* const from = next == anchors_.begin() ? nullptr : &*(next - 1);
  const Anchor* const to = next == anchors_.end() ? nullptr : &*next;
  const double begin = from != nullptr ? from->s : 0;
  const double width = (to != nullptr ? to->s : distance_) - begin;
  const double x = (s - begin) / width;
  const double y = 1 - x;
  out = x * x * (3 - 2 * x) * (to != nullptr ? to->place : step_) +
        width * (x * y * y * (from != nullptr ? from->slope : slope_from_) -
                 x * x * y * (to != nullptr ? to->slope : slope_to_));
  if (from != nullptr) out += y * y * (1 + 2 * x) * from->place;
}

bool Stepper::probe(double s) {
  if (s == probed_s_ && corrector_.work().evaluations == probed_when_) return true;
  const bool crosses = crossing_ && s == crossing_->s;
  probe_is_known_ = crosses || s == 0 || s == distance_;
  if (probe_is_known_) {
    probe_ = crosses ? crossing_->point : s == 0 ? here_ : there_;
    probe_slope_ = crosses ? crossing_->slope : s == 0 ? slope_from_ : slope_to_;
  } else {
    interpolate(s, work_);
    corrector_.displace(here_, work_, probe_);
    if (corrector_.correct(probe_, here_, normal_, s, true) != Correction::converged) return false;
    probe_slope_ = corrector_.direction();
  }
  monitor(probe_, here_.scale, probe_slope_, probed_);
  probed_s_ = s;
  probed_when_ = corrector_.work().evaluations;
  return true;
}

double Stepper::look_beside() {
  constexpr double apart = 1e-3;  // of the step: where the branch is regular beside a branch point
  const double near = beside(probed_s_);
  const bool is_singular = probe_is_known_ && std::isinf(probe_.log_determinant);
  const double offset = is_singular ? std::copysign(apart * distance_, near) : near;
  if (linearise_beside(probe_, probe_slope_, offset) != Correction::converged) return 0;
  monitor(beside_, here_.scale, corrector_.direction(), at_beside_);
  beside_rate_ = corrector_.direction()(corrector_.size());
  return offset;
}

/// How far beside a point in s slopes are taken: as near as the rounding of the parameter lets them be told.
double Stepper::beside(double s) const {
  constexpr double little = 1e-7;     // of the step
  constexpr double most = 0.01;       // the same
  constexpr double rounding = 1e-13;  // of the parameter's scale, times 10^3
  const double rate = std::max(std::abs(parameter_rate_from()), std::abs(parameter_rate_to()));
  const double offset = std::clamp(rounding / rate, little * distance_, most * distance_);
  return s > 0 ? -offset : offset;
}

Correction Stepper::linearise_beside(const CurvePoint& point, const Vector& slope, double offset) {
  corrector_.difference(point, here_, work_);
  work_ += offset * slope;
  corrector_.displace(here_, work_, beside_);
  beside_.scale = here_.scale;
  return corrector_.linearise(beside_, normal_);
}

}  // namespace arcslip::continuation
