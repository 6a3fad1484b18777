#include "arcslip/continuation/path/step.hpp"

#include <algorithm>
#include <array>

#include "arcslip/continuation/events/first_zero.hpp"

namespace arcslip::continuation {

bool Step::may_turn_twice() const {
  std::array<double, 2 + most_past> places{chord.norm(), 0};
  std::array<double, 2 + most_past> rates{parameter_rate(there), parameter_rate(here)};
  std::size_t count = 2;
  for (const PastPoint& before : past) {
    places[count] = -before.behind;
    rates[count++] = before.rate;
  }
  return may_vanish_twice({places.data(), count}, {rates.data(), count});
}

double Step::arc_rate() const {
  return (slope_to.array() * here.scale.array() / there.scale.array()).matrix().norm();
}

void Step::interpolate(double s, Vector& out) const {
  const auto next =
      std::find_if(anchors.begin(), anchors.end(), [s](const Anchor& anchor) { return anchor.s >= s; });
  const Anchor* const before = next == anchors.begin() ? nullptr : &*(next - 1);
  const Anchor* const behind = next == anchors.end() ? nullptr : &*next;
  const double begin = before != nullptr ? before->s : 0;
  const double width = (behind != nullptr ? behind->s : distance) - begin;
  const double x = (s - begin) / width;
  const double y = 1 - x;
  out = x * x * (3 - 2 * x) * (behind != nullptr ? behind->place : chord) +
        width * (x * y * y * (before != nullptr ? before->slope : slope_from) -
                 x * x * y * (behind != nullptr ? behind->slope : slope_to));
  if (before != nullptr) out += y * y * (1 + 2 * x) * before->place;
}

}  // namespace arcslip::continuation
