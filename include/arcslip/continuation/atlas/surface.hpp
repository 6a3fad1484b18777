#pragma once

// The solutions of F(u, p) = 0 over two of the parameters, as a surface in the space of
//
//   x = ((u - u_0)/D, (p_a - low_a)/width_a, (p_b - low_b)/width_b),   N = n + 2 numbers,
//
// with the unknowns u_0 of a guess, a scale D of them, and the box of both parameters as the unit square.

#include <Eigen/LU>
#include <array>
#include <optional>

#include "arcslip/continuation/problem/guess.hpp"
#include "arcslip/continuation/problem/linearization.hpp"

namespace arcslip::continuation {

/// The range of one of the two parameters.
struct AtlasSide {
  Index parameter = 0;  ///< of the problem
  double low = 0;       ///< its least value
  double high = 1;      ///< its greatest one
};

/// Serves one thread. The problem is kept by reference.
class Surface {
 public:
  /// In the regime and at the further parameters of a guess. `scale` is D, n.
  Surface(const Problem& problem, const std::array<AtlasSide, 2>& sides, const Guess& guess,
          const Vector& scale);

  Index size() const { return size_ + 2; }  ///< N

  /// x of a guess, and the solution at x.
  Vector place(const Guess& guess) const;
  Guess solution(const Vector& x) const;

  /// Newton's method from `x` on F = 0 and `rows` x = `values`, 2 x N and 2. False where it does not converge
  /// fast enough to be trusted: `x` is then anything.
  [[nodiscard]] bool settle(Vector& x, const Matrix& rows, const Eigen::Vector2d& values);

  /// The same along the shortest way to the surface.
  [[nodiscard]] bool approach(Vector& x);

  /// The tangent plane at x, N x 2: orthonormal columns, turned as another plane near it, unless that is
  /// empty. False where F_x lacks rank or F a value.
  [[nodiscard]] bool tangent(const Vector& x, const Matrix& like, Matrix& plane);

  /// Whether x lies in the regime, and not beyond one of its borders.
  [[nodiscard]] bool is_inside(const Vector& x) const;

  /// The sign of det [F_x; plane^T] at the point last evaluated: the same all over a surface but for lines
  /// where F_x lacks rank, as where others cross it.
  int orientation(const Matrix& plane);

  /// The part of a plane's area that its shadow on both parameters has: 0 at folds. The sign of det dF/du is
  /// that of this and of the orientation together.
  static double shadow(const Matrix& plane) { return plane.bottomRows<2>().determinant(); }

  /// F_x at the point last evaluated, rows of unit length; `row_lengths` are those they had, without scale.
  const Matrix& derivative() const { return derivative_; }
  const Vector& row_lengths() const { return row_lengths_; }
  const Vector& scale() const { return scale_; }
  const std::array<AtlasSide, 2>& sides() const { return sides_; }
  long evaluations() const { return at_.evaluations(); }  ///< so far

 private:
  [[nodiscard]] bool evaluate(const Vector& x);

  const Problem& problem_;
  Index size_;
  std::array<AtlasSide, 2> sides_;
  Guess guess_;    // of which unknowns and both parameters are replaced
  Vector origin_;  // u_0
  Vector scale_;
  Linearization at_;
  Vector residual_;     // of unit rows
  Matrix derivative_;   // n x N
  Vector row_lengths_;  // n
  Matrix square_;       // N x N: with two conditions below
  Vector step_;
};

}  // namespace arcslip::continuation
