#pragma once

// Bordered linear systems
//
//   [ J    B ] [x]   [f]
//   [ C^T  D ] [y] = [g]
//
// with J n x n and 1 to 3 borders, factored whole, so that J itself may be singular.

#include <Eigen/LU>

#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// Dense, by LU with partial pivoting. The matrix is filled in place by its blocks, then factored; nothing is
/// allocated after construction for the sizes (up to 16) that Eigen factors unblocked.
class BorderedSolver {
 public:
  BorderedSolver(Index size, Index borders);

  Index size() const { return size_; }
  Index borders() const { return matrix_.rows() - size_; }

  auto jacobian() { return matrix_.topLeftCorner(size_, size_); }                ///< J, n x n
  auto columns() { return matrix_.topRightCorner(size_, borders()); }            ///< B, n x borders
  auto rows() { return matrix_.bottomLeftCorner(borders(), size_); }             ///< C^T, borders x n
  auto corner() { return matrix_.bottomRightCorner(borders(), borders()); }      ///< D, borders x borders
  Matrix& matrix() { return matrix_; }

  void factor() { lu_.compute(matrix_); }

  /// Overwrites (f, g) by (x, y); entries that are not finite say that the matrix is singular.
  void solve(Vector& right_hand_side);

  /// The same with the transposed matrix.
  void solve_transposed(Vector& right_hand_side);

  /// Sign of the determinant: -1, 0 or 1.
  double determinant_sign() const;

 private:
  double permutation_sign() const;

  Index size_;
  Matrix matrix_;
  Eigen::PartialPivLU<Matrix> lu_;
  Vector solution_;
  mutable Eigen::VectorXi visited_;  // work of permutation_sign
};

}  // namespace arcslip::continuation
