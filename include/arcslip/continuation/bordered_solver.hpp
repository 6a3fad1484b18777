#pragma once

// Bordered linear systems
//
//   [ J    B ] [x]   [f]
//   [ C^T  D ] [y] = [g]
//
// with J n x n and 1 to 3 borders, factored whole, so that J itself may be singular.

#include <Eigen/LU>
#include <vector>

#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// Dense, by LU with partial pivoting. The matrix is filled by its blocks, then factored. Up to 16 rows,
/// where calls would cost more than arithmetic, elimination is done in place and nothing is allocated;
/// beyond, Eigen's blocked factorisation takes over.
class BorderedSolver {
 public:
  BorderedSolver(Index size, Index borders);

  Index size() const { return size_; }
  Index borders() const { return matrix_.rows() - size_; }

  auto jacobian() { return matrix_.topLeftCorner(size_, size_); }            ///< J, n x n
  auto columns() { return matrix_.topRightCorner(size_, borders()); }        ///< B, n x borders
  auto rows() { return matrix_.bottomLeftCorner(borders(), size_); }         ///< C^T, borders x n
  auto corner() { return matrix_.bottomRightCorner(borders(), borders()); }  ///< D, borders x borders

  /// Factors the matrix and returns the sign of its determinant: 0 if it is singular or not finite.
  double factor();

  /// Overwrites (f, g) by (x, y), after `factor` has returned a sign.
  void solve(Vector& right_hand_side);

  /// The same with the transposed matrix.
  void solve_transposed(Vector& right_hand_side);

 private:
  bool small() const { return matrix_.rows() <= 16; }
  double factor_small();
  double permutation_sign();

  Index size_;
  Matrix matrix_;
  Matrix factors_;             // small: unit lower and upper triangle in one
  std::vector<Index> pivots_;  // small: row exchanged with row i
  Eigen::PartialPivLU<Matrix> lu_;
  Vector solution_;
};

}  // namespace arcslip::continuation
