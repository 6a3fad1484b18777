#pragma once

// Dense bordered systems, by LU with partial pivoting.

#include <Eigen/LU>
#include <vector>

#include "arcslip/continuation/linear/bordered_solver.hpp"

namespace arcslip::continuation {

/// Up to 100 rows, where blocks do not pay, columns are eliminated one by one; beyond, Eigen's blocked
/// factorisation takes over, and beyond 300 LAPACK's, which takes a third of the time and rounds as its
/// number of threads has it. Nothing is allocated after construction.
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
  bool large() const { return matrix_.rows() > 300; }
  void set_borders();
  double factor_small();
  double factor_large();
  void eliminate(Index j);  // the columns before j from column j

  Matrix matrix_;
  Matrix factors_;              // small or large: unit lower and upper triangle in one
  std::vector<Index> pivots_;   // small: row exchanged with row i
  std::vector<int> exchanges_;  // large: the same, the first row being 1
  Eigen::PartialPivLU<Matrix> lu_;
  Vector solution_;
  std::vector<char> seen_;  // of a permutation
};

}  // namespace arcslip::continuation
