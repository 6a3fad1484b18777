#include "arcslip/time/stick_pattern.hpp"

#include <algorithm>

namespace arcslip {
namespace {

constexpr double least_slip = 1e-9;

}  // namespace

StickPattern stick_pattern(std::span<const int> orders, const HarmonicVector& motion, double slip_threshold,
                           bool slips) {
  if (!slips) return {};
  const OddMotion odd(orders, motion);
  const HysteresisLoop loop(odd, slip_threshold);
  StickPattern pattern{true, {loop.stick().begin(), loop.stick().end()}};
  for (std::size_t i = 0; i < pattern.arcs.size(); ++i) {
    const bool last = i + 1 == pattern.arcs.size();
    const double next = last ? pattern.arcs.front().begin + pi : pattern.arcs[i + 1].begin;
    pattern.arcs[i].width = std::min(pattern.arcs[i].width, next - pattern.arcs[i].begin - least_slip);
  }
  std::erase_if(pattern.arcs, [](const HysteresisLoop::Arc& arc) { return !(arc.width > 0); });
  return pattern;
}

}  // namespace arcslip
