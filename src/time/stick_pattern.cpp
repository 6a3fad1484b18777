#include "arcslip/time/stick_pattern.hpp"

#include <algorithm>

namespace arcslip {
namespace {

constexpr double least_slip = 1e-9;

/// Of a contact that slips: its slider rests where it is as it begins to stick.
DisturbedLaw sliding(const std::vector<HysteresisLoop::Arc>& arcs, double spring) {
  DisturbedLaw law;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    const double end = arcs[i].begin + arcs[i].width;
    const double next = i + 1 < arcs.size() ? arcs[i + 1].begin : arcs.front().begin + pi;
    law.pieces.push_back({arcs[i].begin,
                          arcs[i].width,
                          Matrix::Constant(1, 1, spring),
                          {{static_cast<Index>(i), Vector::Constant(1, -spring)}}});
    law.pieces.push_back({end, next - end, Matrix::Zero(1, 1)});
    law.memories.push_back({arcs[i].begin, arcs[i].width, Vector::Ones(1)});
  }
  return arcs.empty() ? DisturbedLaw::constant(Matrix::Zero(1, 1)) : law;
}

}  // namespace

DisturbedLaw law_of(const StickPattern& element, double spring) {
  if (!element.law.pieces.empty()) return element.law;
  if (spring < 0) return law_of(element.stiffness);
  return element.slips ? sliding(element.arcs, spring)
                       : DisturbedLaw::constant(Matrix::Constant(1, 1, spring));
}

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
