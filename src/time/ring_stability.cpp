#include "arcslip/time/ring_stability.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/structure/spectrum.hpp"

namespace arcslip {
namespace {

/// Whether what a family remembers at this place stays what it is at all nodes, but for the turn: part of an
/// element may hold while the rest of it slips.
bool stays(const Matrix& derivative, Index first, Index count) {
  for (Index i = first; i < first + count; ++i) {
    const auto row = derivative.row(i);
    if ((row.array() != 0).count() != 1 || row.segment(first, count).maxCoeff() != 1) return false;
  }
  return true;
}

}  // namespace

double RingStability::growth() const { return std::pow(std::abs(turned(0)), periods); }

Index RingStability::unstable(double margin) const {
  return std::count_if(turned.begin(), turned.end(), [&](const Complex& multiplier) {
    return std::pow(std::abs(multiplier), periods) > 1 + margin;
  });
}

RingStability floquet_stability(RingMotion& motion, const RingState& state) {
  const Ring& ring = motion.ring();
  const Index coordinates = ring.coordinates();
  StateDerivative here = next_derivative(motion, state);
  here.derivative.middleRows(coordinates, coordinates) /= motion.frequency();
  here.derivative.middleCols(coordinates, coordinates) *= motion.frequency();
  std::vector<Index> kept;
  for (Index i = 0; i < 2 * coordinates; ++i) kept.push_back(i);
  for (std::size_t f = 0; f < here.moved.size(); ++f) {
    const RingMotion::Family& one = motion.families()[f];
    for (Index j = 0; here.moved[f] && j < one.law->memories(); ++j) {
      const Index first = 2 * coordinates + one.memory + j * ring.nodes();
      if (stays(here.derivative, first, ring.nodes())) continue;
      for (Index i = 0; i < ring.nodes(); ++i) kept.push_back(first + i);
    }
  }
  const Matrix derivative = here.derivative(kept, kept);
  const Matrix drifts = neutral_drifts(motion, true, here.moved)(kept, Eigen::all);

  RingStability stability;
  stability.periods = 1 / ring.periods_of_turn();
  stability.slips = std::find(here.moved.begin(), here.moved.end(), true) != here.moved.end();
  stability.turned = spectrum(drifts.cols() > 0 ? deflated(derivative, drifts) : derivative);
  return stability;
}

Matrix monodromy(RingMotion& motion, const RingState& state) {
  RingTangent tangent(motion);
  RingState end = state;
  motion.advance(end, motion.period(), &tangent);
  return tangent.at(end);
}

}  // namespace arcslip
