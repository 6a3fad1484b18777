#include "arcslip/continuation/path/monitors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

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

Monitors::Monitors(const Problem& problem, Index parameter, std::vector<Index> tracked)
    : problem_(problem),
      parameter_(parameter),
      tracked_(std::move(tracked)),
      gradient_{Vector::Zero(problem.size()), Vector::Zero(std::ssize(problem.parameter_names()))} {
  const std::vector<Observable> observables = problem.observables();
  for (const Index which : tracked_) observed_.push_back(observables[static_cast<std::size_t>(which)]);
}

void Monitors::look(const CurvePoint& point, const Vector& scale, const Vector& slope,
                    std::vector<Monitor>& out) {
  out.clear();
  const Index n = problem_.size();
  const auto add = [&](double value) { out.push_back({value, rate(gradient_, parameter_, scale, slope)}); };
  for (const Index which : tracked_) {
    gradient_.piece = 0;
    add(problem_.observe(point.unknowns, point.parameters, point.regime, which, gradient_));
    out.back().reach = gradient_.unknowns.cwiseProduct(point.scale.head(n)).norm() / std::sqrt(n) +
                       std::abs(gradient_.parameters(parameter_) * point.scale(n));
    out.back().piece = gradient_.piece;
  }
  for (int b = 0; b < problem_.border_count(point.regime); ++b) {
    add(problem_.border(point.unknowns, point.parameters, point.regime, b, &gradient_));
  }
}

double Monitors::border(const CurvePoint& point, int border, const Vector& scale, Vector& gradient) {
  const double value = problem_.border(point.unknowns, point.parameters, point.regime, border, &gradient_);
  const Index n = problem_.size();
  gradient.head(n) = gradient_.unknowns.cwiseProduct(scale.head(n));
  gradient(n) = gradient_.parameters(parameter_) * scale(n);
  return value;
}

double Monitors::rounding(const CurvePoint& point, double slope) const {
  const Index n = problem_.size();
  const double largest = std::max(point.unknowns.cwiseQuotient(point.scale.head(n)).lpNorm<Eigen::Infinity>(),
                                  std::abs(point.parameters(parameter_) / point.scale(n)));
  return 2 * std::numeric_limits<double>::epsilon() * largest * std::abs(slope);
}

double Monitors::roughness(const Step& step, double s, const std::vector<Monitor>& at_s,
                           const Limits& limits) const {
  constexpr double hidden = 2;  // a pair of extrema may be
  double most = 0;
  if (step.is_tiny(s)) return most;
  for (std::size_t i = 0; i < step.from.size(); ++i) {
    const Monitor& a = step.from[i];
    const Monitor& b = at_s[i];
    const bool is_tracked = i < tracked_.size();
    const double change = (is_tracked ? observed_[i].near(b.value, a.value) : b.value) - a.value;
    const double size = is_tracked ? size_between(i, a, b) : 1;
    if (is_tracked && a.value != 0 && a.value * b.value >= 0) {
      // One that is gone may be that of a branch which crosses this one.
      const double of_change = b.value == 0 ? size_of(i, a.value) : size;
      most = std::max(most, std::abs(change) / (limits.change * of_change));
    }
    // The mean of the end slopes is to give the change, or else there is more between than these can tell.
    const double error = std::abs(change - 0.5 * s * (a.slope + b.slope));
    const double turned = 0.5 * s * (std::abs(a.slope) + std::abs(b.slope));
    const double allowed = std::min(0.1 * size, limits.bend * turned + limits.shallow * size);
    most = std::max(most, std::sqrt(error / allowed));
    if (dip(a.slope * s, b.slope * s, change, limits.shallow * size)) most = std::max(most, hidden);
  }
  return most;
}

}  // namespace arcslip::continuation
