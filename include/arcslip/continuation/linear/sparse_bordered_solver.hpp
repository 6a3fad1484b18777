#pragma once

// Sparse bordered systems, by KLU [Davis & Palamadai Natarajan, ACM TOMS 37 (2010) 36].

#include <memory>

#include "arcslip/continuation/linear/bordered_solver.hpp"

namespace arcslip::continuation {

/// The matrix is assembled whole. It is ordered once, for as long as J keeps its pattern, by approximate
/// minimum degree of J with the borders last, since a dense row taken as a pivot before them would fill the
/// factors. To keep it last its entries count for 1e-6 of the others' in the search for pivots: that is
/// enough for a J singular to within rounding, and one step of iterative refinement, at 4 % of a
/// factorisation of 10^5 unknowns, gives back the digits that the smaller pivots cost.
///
/// Factors with the pivots of the last factorisation where these still serve, which saves a quarter of the
/// time; then nothing is allocated.
class SparseBorderedSolver final : public BorderedSolver {
 public:
  /// For n = `size` unknowns; neither number may be negative.
  SparseBorderedSolver(Index size, Index borders);
  ~SparseBorderedSolver() override;

  /// The dense one throws.
  using BorderedSolver::set_jacobian;

  /// `jacobian` compressed. Throws std::invalid_argument if it is not or has another size.
  void set_jacobian(const SparseMatrix& jacobian, const Vector& column_scale) override;

  /// Throws std::bad_alloc or std::length_error where the factors do not fit into memory or their indices.
  double factor() override;
  void multiply_determinant(LogProduct& product) const override;

  void solve(Vector& right_hand_side) override;
  void solve_transposed(Vector& right_hand_side) override;

 private:
  struct Factors;

  bool same_pattern(const SparseMatrix& jacobian) const;
  void set_pattern(const SparseMatrix& jacobian);
  void set_borders();
  bool scale_rows();
  void solve_refined(bool transposed);

  SparseMatrix matrix_;  // whole; its rows are multiplied by row_scale_ in scaled_
  SparseMatrix scaled_;
  Vector row_scale_;
  Vector right_hand_side_;
  Vector solution_;
  Vector residual_;
  std::unique_ptr<Factors> factors_;
};

}  // namespace arcslip::continuation
