#pragma once

// Dense bordered systems, by LU with partial pivoting.

#include <vector>

#include "arcslip/continuation/linear/bordered_solver.hpp"

namespace arcslip::continuation {

/// Up to 100 rows, where blocks do not pay, columns are eliminated one by one; beyond, LAPACK takes over.
/// Nothing is allocated after construction.
class DenseBorderedSolver final : public BorderedSolver {
 public:
  /// For n = `size` unknowns; neither number may be negative.
  DenseBorderedSolver(Index size, Index borders);

  /// The sparse one throws.
  using BorderedSolver::set_jacobian;
  void set_jacobian(const Matrix& jacobian, const Vector& column_scale) override;
  double factor() override;
  void multiply_determinant(LogProduct& product) const override;
  void solve(Vector& right_hand_side) override;
  void solve_transposed(Vector& right_hand_side) override;

 private:
  bool small() const { return matrix_.rows() <= 100; }
  void set_borders();
  double factor_small();
  double factor_large();
  void eliminate(Index j);  // the columns before j from column j

  Matrix matrix_;
  Matrix factors_;           // unit lower and upper triangle in one
  std::vector<int> pivots_;  // row exchanged with row i, the first being 1
};

}  // namespace arcslip::continuation
