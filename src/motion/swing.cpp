#include "arcslip/motion/swing.hpp"

#include <cmath>

namespace arcslip {

bool all_odd(std::span<const int> orders) {
  return std::all_of(orders.begin(), orders.end(), [](int h) { return h % 2 == 1; });
}

Swing Swing::of(std::span<const int> orders, const HarmonicVector& x) {
  if (all_odd(orders)) return of_odd(OddMotion(orders, x).maximum());
  const PeriodicMotion motion(orders, x, highest_order(orders));
  return at(motion, motion.derivative().zeros());
}

Swing Swing::at(const PeriodicMotion& motion, std::span<const double> angles) {
  const double begin = motion.value(0);
  Swing swing{{0, begin}, {0, begin}, false};
  for (const double angle : angles) {
    const double here = motion.value(angle);
    if (here > swing.greatest.value) swing.greatest = {angle, here};
    if (here < swing.least.value) swing.least = {angle, here};
  }
  return swing;
}

Farthest farthest_of(std::span<const int> orders, const HarmonicVector& x) {
  constexpr double rounding = 1e-13;
  const PeriodicMotion motion(orders, x, highest_order(orders));
  std::vector<double> places;
  if (all_odd(orders)) {  // the other half period has the same
    const Angles turns = OddMotion(orders, x).turning_points();
    places.assign(turns.all().begin(), turns.all().end());
  } else {
    places = motion.derivative().zeros();
  }
  if (places.empty()) places.push_back(0);
  Farthest peak{0, HarmonicVector::Zero(x.size())};
  for (const double angle : places) peak.value = std::max(peak.value, std::abs(motion.value(angle)));
  int count = 0;
  for (const double angle : places) {
    const double here = motion.value(angle);
    if (std::abs(here) < (1 - rounding) * peak.value) continue;
    ++count;
    for (Index a = 0; a < x.size(); ++a)
      peak.by(a) += std::polar(1.0, -orders[static_cast<std::size_t>(a)] * angle) * (here < 0 ? -1.0 : 1.0);
  }
  peak.by /= count;
  return peak;
}

Complex Swing::half_by(int h) const {
  const Complex top = std::polar(1.0, -h * greatest.angle);
  return is_odd ? top : 0.5 * (top - std::polar(1.0, -h * least.angle));
}

/// Where both sides are as far, whatever is greater by rounding, the mean of both one-sided derivatives.
Complex Swing::peak_by(int h) const {
  constexpr double rounding = 1e-13;
  if (std::abs(greatest.value + least.value) <= rounding * peak()) return half_by(h);
  return greatest.value >= -least.value ? std::polar(1.0, -h * greatest.angle)
                                        : -std::polar(1.0, -h * least.angle);
}

}  // namespace arcslip
