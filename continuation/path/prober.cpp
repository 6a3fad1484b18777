#include "arcslip/continuation/path/prober.hpp"

#include <algorithm>
#include <cmath>

namespace arcslip::continuation {

Prober::Prober(Corrector& corrector, Monitors& monitors, Step& step)
    : corrector_(corrector), monitors_(monitors), step_(step) {
  for (Probe* probe : {&probed_, &beside_}) {
    probe->point = corrector.make_point();
    probe->slope.setZero(corrector.size() + 1);
    probe->monitors.reserve(static_cast<std::size_t>(monitors.tracked_count()) + 8);
  }
  work_.setZero(corrector.size() + 1);
  way_ = work_;
}

bool Prober::probe(double s) {
  if (s == s_ && corrector_.work().evaluations == when_) return true;
  const bool crosses = step_.crossing && s == step_.crossing->s;
  is_known_ = crosses || s == 0 || s == step_.distance;
  if (is_known_) {
    probed_.point = crosses ? step_.crossing->point : s == 0 ? step_.here : step_.there;
    probed_.slope = crosses ? step_.crossing->slope : s == 0 ? step_.slope_from : step_.slope_to;
  } else {
    step_.interpolate(s, work_);
    corrector_.displace(step_.here, work_, probed_.point);
    if (corrector_.correct(probed_.point, step_.here, step_.normal, s, true) != Correction::converged)
      return false;
    probed_.slope = corrector_.direction();
  }
  monitors_.look(probed_.point, step_.here.scale, probed_.slope, probed_.monitors);
  s_ = s;
  when_ = corrector_.work().evaluations;
  return true;
}

double Prober::look_beside(double least) {
  constexpr double apart = 1e-3;  // of the step: where the branch is regular beside a branch point
  const double nearest = offset_beside(s_);
  const double near = std::copysign(std::max(std::abs(nearest), least), nearest);
  const bool is_singular = is_known_ && std::isinf(probed_.point.log_determinant);
  const double offset = is_singular ? std::copysign(apart * step_.distance, near) : near;
  if (linearise_beside(probed_.point, probed_.slope, offset) != Correction::converged) return 0;
  beside_.slope = corrector_.direction();
  monitors_.look(beside_.point, step_.here.scale, beside_.slope, beside_.monitors);
  return offset;
}

double Prober::offset_beside(double s) const {
  constexpr double little = 1e-7;     // of the step
  constexpr double most = 0.01;       // the same
  constexpr double rounding = 1e-13;  // of the parameter's scale, times 10^3
  const double rate = std::max(std::abs(step_.parameter_rate_from()), std::abs(step_.parameter_rate_to()));
  const double offset = std::clamp(rounding / rate, little * step_.distance, most * step_.distance);
  return s > 0 ? -offset : offset;
}

Correction Prober::linearise_beside(const CurvePoint& point, const Vector& slope, double offset) {
  corrector_.difference(point, step_.here, work_);
  work_ += offset * slope;
  corrector_.displace(step_.here, work_, beside_.point);
  beside_.point.scale = step_.here.scale;
  return corrector_.linearise(beside_.point, step_.normal);
}

void Prober::anchor() {
  std::vector<Step::Anchor>& anchors = step_.anchors;
  const auto next =
      std::find_if(anchors.begin(), anchors.end(), [this](const Step::Anchor& a) { return a.s >= s_; });
  if (next != anchors.end() && next->s == s_) return;
  corrector_.difference(probed_.point, step_.here, work_);
  anchors.insert(next, {s_, work_, probed_.slope});
}

std::optional<double> Prober::passes(const CurvePoint& past, double same) {
  if (past.regime != step_.here.regime) return std::nullopt;
  if (step_.crossing) {  // no probe finds a start that is the branch point itself
    const CurvePoint& point = step_.crossing->point;
    corrector_.difference(past, point, way_);
    if (way_.norm() < same && point.tangent.dot(past.tangent) > 0) return step_.crossing->s;
  }
  const double length = step_.chord.norm();
  const Index parameter = corrector_.parameter();
  const double aside = past.parameters(parameter) - step_.here.parameters(parameter);
  if (!(std::abs(aside) < 2 * length * step_.here.scale(corrector_.size())))
    return std::nullopt;  // most often
  corrector_.difference(past, step_.here, way_);
  const double s = step_.normal.dot(way_);
  if (!(way_.norm() < 2 * length) || !(s > 0) || !(s <= step_.distance)) return std::nullopt;
  step_.interpolate(s, work_);
  if (!((work_ - way_).norm() < 0.05 * length) || !probe(s)) return std::nullopt;
  corrector_.difference(past, probed_.point, way_);
  work_ = probed_.slope.cwiseProduct(step_.here.scale).cwiseQuotient(past.scale);
  const bool same_way = work_.dot(past.tangent) > 0;
  if (!(way_.norm() < same) || !same_way) return std::nullopt;
  return s;
}

void Prober::cut() {
  std::swap(step_.there, probed_.point);
  step_.slope_to = probed_.slope;
  std::swap(step_.to, probed_.monitors);
  step_.distance = s_;
  corrector_.difference(step_.there, step_.here, step_.chord);
  if (!is_known_) corrector_.set_tangent(step_.there, step_.here);
  when_ = -1;
  step_.anchors.clear();
}

}  // namespace arcslip::continuation
