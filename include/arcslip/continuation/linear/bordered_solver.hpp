#pragma once

// Bordered linear systems
//
//   [ J    B ] [x]   [f]
//   [ C^T  D ] [y] = [g]
//
// with J n x n, dense or sparse, and a few borders, factored whole, so that J itself may be singular.

#include <memory>
#include <vector>

#include "arcslip/continuation/linear/condensed_jacobian.hpp"
#include "arcslip/continuation/linear/factored_jacobian.hpp"
#include "arcslip/continuation/linear/log_product.hpp"
#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// Set the blocks, factor, solve. Blocks stay as they were set until they are set again.
class BorderedSolver {
 public:
  virtual ~BorderedSolver() = default;
  BorderedSolver(const BorderedSolver&) = delete;
  BorderedSolver& operator=(const BorderedSolver&) = delete;

  /// n, and how many columns and rows border J.
  Index size() const { return rows_.cols(); }
  Index borders() const { return rows_.rows(); }

  Matrix& columns() { return columns_; }  ///< B, n x borders
  Matrix& rows() { return rows_; }        ///< C^T, borders x n
  Matrix& corner() { return corner_; }    ///< D, borders x borders

  /// Sets J = `jacobian` diag(`column_scale`), n x n; of the scale, the first n entries count. They throw
  /// std::logic_error in a solver of another kind.
  virtual void set_jacobian(const Matrix& jacobian, const Vector& column_scale);
  virtual void set_jacobian(const SparseMatrix& jacobian, const Vector& column_scale);
  virtual void set_jacobian(const CondensedJacobian& jacobian, const Vector& column_scale);

  /// Factors the whole and returns the sign of its determinant: 0 if it is singular or not finite.
  virtual double factor() = 0;

  /// Multiplies by the determinant of what has been factored.
  virtual void multiply_determinant(LogProduct& product) const = 0;

  /// What was left of blocks of rows of J; null where it has not been factored so.
  virtual const RowsLeft* rows_left() const { return nullptr; }

  /// Overwrites (f, g), n + borders, by (x, y), after `factor` has returned a sign.
  virtual void solve(Vector& right_hand_side) = 0;

  /// The same with the transposed matrix.
  virtual void solve_transposed(Vector& right_hand_side) = 0;

 protected:
  /// All blocks zero. Neither number may be negative.
  BorderedSolver(Index size, Index borders);

 private:
  Matrix columns_;
  Matrix rows_;
  Matrix corner_;
};

/// Sign of the permutation i -> image[i] of as many numbers as `seen`, which is work space.
double permutation_sign(const int* image, std::vector<char>& seen);

/// A solver for n = `size` unknowns; throws std::invalid_argument for a negative number of either.
std::unique_ptr<BorderedSolver> make_bordered_solver(Index size, Index borders, bool sparse);

}  // namespace arcslip::continuation
