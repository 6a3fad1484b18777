// Solutions next to the corners of responses.

#include <cmath>
#include <stdexcept>

#include "arcslip/continuation/path/corrector.hpp"
#include "arcslip/problems/ridges/response_peaks.hpp"

namespace arcslip::problems {

using continuation::Branch;
using continuation::BranchPoint;
using continuation::Guess;

/// A solution next to a point, forwards (way = 1) or backwards (-1) along the response: reached from the
/// point there, for at a corner Newton's method may go to and fro between both sides.
Guess ResponsePeaks::beside(const Branch& branch, std::size_t i, int way) const {
  constexpr double nearest = 1e-9;  // in the problem's scale
  constexpr double farthest = 1e-6;
  constexpr double quickly = 0.1;  // a step takes this part of the way that is left, or more where it fails
  constexpr double slowly = 0.9;
  const BranchPoint& point = branch.points[i];
  continuation::Corrector corrector(*response_.problem, along_, {});
  continuation::CurvePoint origin = corrector.make_point();
  origin.unknowns = point.unknowns;
  origin.parameters = point.parameters;
  origin.regime = point.regime;
  corrector.set_scale(origin);
  continuation::CurvePoint near = origin;
  Vector chord = Vector::Zero(point.tangent.size());
  for (std::size_t k = i; chord.norm() < nearest && k > 0 && k + 1 < branch.points.size();) {
    k = way > 0 ? k + 1 : k - 1;
    near.unknowns = branch.points[k].unknowns;
    near.parameters = branch.points[k].parameters;
    corrector.difference(near, origin, chord);
  }
  const Vector normal = chord.normalized();
  double distance = chord.norm();
  double nearer = quickly;
  for (continuation::CurvePoint next = near; distance > 10 * nearest && nearer < slowly;) {
    corrector.difference(near, origin, chord);
    corrector.displace(origin, nearer * chord, next);
    if (corrector.correct(next, origin, normal, nearer * distance) == continuation::Correction::converged) {
      near = next;
      distance *= nearer;
      nearer = quickly;
    } else {
      nearer = std::sqrt(nearer);
    }
  }
  if (!(distance < farthest)) throw std::runtime_error("no solution beside a corner");
  return {near.unknowns, near.parameters, point.regime, {}};
}

}  // namespace arcslip::problems
