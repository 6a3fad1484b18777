#pragma once

// Sparse bordered systems: by blocks and fronts where dense arithmetic pays, else by single entries.

#include <memory>

#include "arcslip/continuation/linear/bordered_solver.hpp"
#include "arcslip/continuation/linear/sparse_factors.hpp"

namespace arcslip::continuation {

/// The matrix is assembled whole. It is ordered once, for as long as J keeps its pattern, by approximate
/// minimum degree of J with the borders last and full rows of J before them, since one of these taken as a
/// pivot earlier would fill the factors. To keep them last their entries count for 1e-6 of the others' in the
/// search for pivots: that is enough for a J singular to within rounding, and iterative refinement, a step
/// of which takes 4 % of a factorisation of 10^5 unknowns, gives back the digits that the smaller pivots
/// cost.
///
/// Small blocks that are alike are eliminated first, side by side, and what they leave by fronts. Without
/// such, fronts are used where they cost no more than six times the multiplications of KLU's order; where
/// more digits are lost there than refinement gives back, KLU takes over. Nothing is allocated in fronts, and
/// by KLU where the pivots of its last factorisation still serve.
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
  const RowsLeft* rows_left() const override { return factors_->rows_left(); }

  void solve(Vector& right_hand_side) override;
  void solve_transposed(Vector& right_hand_side) override;

 private:
  bool same_pattern(const SparseMatrix& jacobian) const;
  void set_pattern(const SparseMatrix& jacobian);
  void set_borders();
  double factor_by_entries();
  void find_last_rows(const SparseMatrix& jacobian);
  void solve_refined(bool transposed);
  bool refine(bool transposed);

  /// What the pattern alone tells, and room for values.
  struct Plan {
    Index borders = -1;                    // -1 where there is none
    std::vector<int> begins;               // of J's columns
    std::vector<int> rows;                 // of J's entries
    SparseMatrix matrix;                   // whole
    std::vector<int> order;                // of elimination, with the least fill
    std::vector<Index> last_rows;          // for its end
    std::unique_ptr<SparseFactors> dense;  // by fronts, or by blocks that are alike and then by fronts
  };
  /// Of a solver that is gone: on each new mesh of an orbit there is a new one for the same pattern.
  static thread_local Plan spare;

  Plan plan_;
  Vector right_hand_side_;
  Vector solution_;
  Vector residual_;
  std::unique_ptr<SparseFactors> klu_;
  SparseFactors* factors_ = nullptr;  // which of them
};

}  // namespace arcslip::continuation
