#pragma once

// F along a curve u(h) = sum_k u_k h^k at fixed parameters, as a series in h: the problem's own where it
// gives it. Else dF/du(u(h)) u'(h), of which the exact Jacobian is a part, is interpolated in Chebyshev
// points, so that derivatives of order k take k - 1 differences.

#include "arcslip/continuation/problem/linearization.hpp"

namespace arcslip::continuation {

/// Serves one thread. The problem is kept by reference.
class Expansion {
 public:
  /// Where series are not the problem's own h goes as far as u_1 changes by `reach`, in the problem's scale.
  Expansion(const Problem& problem, double reach);

  /// `u` and `out`: see Problem::series, of order 1 to 5; the first column of `out` need not be filled. False
  /// where F has no value on the way.
  [[nodiscard]] bool along(const Matrix& u, const Vector& p, const Regime& regime, Matrix& out);

  /// Whether any was found by differences.
  bool is_approximate() const { return is_approximate_; }

 private:
  [[nodiscard]] bool interpolate(const Matrix& u, const Vector& p, const Regime& regime, Matrix& out);

  const Problem& problem_;
  double reach_;
  Linearization at_;
  Vector scale_;
  Vector parameter_scale_;
  bool is_approximate_ = false;
};

/// A number found with a reach, and again with another.
struct Estimated {
  double error = 0;     ///< how far those of the two reaches that agree best are apart; 0 where it is exact
  bool exists = false;  ///< whether any two could be found
};

/// Calls `find(expansion, numbers)` with reaches, each half of the one before, and gives the numbers of those
/// that agree best, or first to rounding: once where series are exact. `find` returns false where there are
/// none.
template <class Find>
Estimated with_best_reach(const Problem& problem, Vector& numbers, const Find& find) {
  constexpr double longest = 0.4;
  constexpr int reaches = 8;
  constexpr double rounding = 1e-12;  // of the numbers: what shorter reaches would add to
  Estimated best;
  Vector before;
  double reach = longest;
  for (int i = 0; i < reaches; ++i, reach *= 0.5) {
    Expansion expansion(problem, reach);
    Vector here;
    if (!find(expansion, here) || !here.allFinite()) {
      before.resize(0);
      continue;
    }
    if (!expansion.is_approximate()) {
      numbers = here;
      return {0, true};
    }
    const double apart = before.size() > 0 ? (here - before).template lpNorm<Eigen::Infinity>() : 0;
    if (before.size() > 0 && (!best.exists || apart < best.error)) {
      best = {apart, true};
      numbers = here;
      if (apart <= rounding * here.template lpNorm<Eigen::Infinity>()) return best;
    }
    before = here;
  }
  return best;
}

}  // namespace arcslip::continuation
