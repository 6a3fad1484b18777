#include "arcslip/continuation/problem/symmetry.hpp"

#include <algorithm>
#include <utility>

namespace arcslip::continuation {
namespace {

constexpr double lost = 1e-3;  // in the scale: far beyond what rounding and steps leave

/// By how much it is missed, in the scale.
double missed(const Symmetry& symmetry, const Vector& u, const Vector& scale) {
  const Vector change = symmetry.map * u - u;
  return change.cwiseQuotient(scale).lpNorm<Eigen::Infinity>();
}

}  // namespace

std::vector<bool> kept_symmetries(const std::vector<Symmetry>& symmetries, const Vector& u,
                                  const Vector& scale, double tolerance) {
  std::vector<bool> kept;
  for (const Symmetry& symmetry : symmetries) kept.push_back(missed(symmetry, u, scale) <= tolerance);
  return kept;
}

OwnImage::OwnImage(std::vector<Symmetry> symmetries, double tolerance)
    : symmetries_(std::move(symmetries)), tolerance_(tolerance), farthest_(symmetries_.size(), 0.0) {}

const Symmetry* OwnImage::take(const Vector& u, const Vector& tangent, const Vector& scale) {
  constexpr double opposite = 1e-2;  // between unit vectors, where the branch is all but singular
  const Index n = u.size();
  const Symmetry* found = nullptr;
  for (std::size_t i = 0; i < symmetries_.size(); ++i) {
    const double now = missed(symmetries_[i], u, scale.head(n));
    farthest_[i] = std::max(farthest_[i], now);
    if (found != nullptr || now > tolerance_ || farthest_[i] < lost) continue;
    Vector sum = tangent;
    sum.head(n) =
        tangent.head(n) +
        (symmetries_[i].map * tangent.head(n).cwiseProduct(scale.head(n))).cwiseQuotient(scale.head(n));
    if (sum.norm() <= opposite * tangent.norm()) found = &symmetries_[i];
  }
  return found;
}

bool OwnImage::has_gone_over(const Vector& u, const Vector& tangent, const Vector& scale) const {
  constexpr double same_line = 1e-3;  // between unit vectors: one that is turned over is 2 apart
  const Index n = u.size();
  for (std::size_t i = 0; i < symmetries_.size(); ++i) {
    if (farthest_[i] < lost || missed(symmetries_[i], u, scale.head(n)) > tolerance_) continue;
    if (missed(symmetries_[i], tangent.head(n).cwiseProduct(scale.head(n)), scale.head(n)) <=
        same_line * tangent.norm())
      return true;
  }
  return false;
}

}  // namespace arcslip::continuation
