#pragma once

// What a sparse bordered system is factored by.

#include <memory>
#include <vector>

#include "arcslip/continuation/linear/factored_jacobian.hpp"
#include "arcslip/continuation/linear/log_product.hpp"
#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// Factors of square matrices of one pattern, whose columns are in scale; rows are scaled for the choice of
/// pivots. The borders' rows, the last ones, are kept for the end.
class SparseFactors {
 public:
  virtual ~SparseFactors() = default;

  /// The sign of the determinant; 0 if the matrix is singular or not finite. Throws std::bad_alloc or
  /// std::length_error where the factors do not fit into memory or their indices.
  virtual double factor(const SparseMatrix& matrix) = 0;

  /// By the size of the determinant.
  virtual void multiply_determinant(LogProduct& product) const = 0;

  /// To how much entries of about 1 in each row grew in the elimination, or by how much its rows were
  /// multiplied before they were subtracted from rows for the end: solutions lose as many digits.
  virtual double growth() const = 0;

  /// What was left of blocks; null where there are none.
  virtual const RowsLeft* rows_left() const { return nullptr; }

  virtual void solve(Vector& x) = 0;             ///< x <- A^{-1} x, after `factor` has returned a sign
  virtual void solve_transposed(Vector& x) = 0;  ///< x <- A^{-T} x
};

/// By KLU [Davis & Palamadai Natarajan, ACM TOMS 37 (2010) 36], with rows and columns in this order but for
/// the exchanges of rows that pivots need, and the entries of some rows for 1e-6 of the others' where these
/// are to come last. Takes the pivots of the last factorisation where these still serve, which saves a
/// quarter of the time. Throws as `factor` does.
std::unique_ptr<SparseFactors> make_klu_factors(SparseMatrix& pattern, std::vector<int>& order,
                                                const std::vector<Index>& last_rows = {});

/// By fronts [Irons, Int. J. Numer. Meth. Engng 2 (1970) 5]: rows enter a dense matrix in the order of their
/// first columns, and columns that no later row has are eliminated, with pivots from the largest entries of
/// these rows. The rows that are nearly full and those of the borders are eliminated from and stay. Made for
/// the chains of blocks that discretisations of lines and of periodic orbits give: what is left of a block
/// goes into the next one, so that growth along the chain is met by pivots of both. Null where it would cost
/// more than `most` multiplications.
std::unique_ptr<SparseFactors> make_frontal_factors(const SparseMatrix& pattern, Index borders, double most);

/// By blocks of rows that have the same columns, as those of one interval of an orbit have: the columns that
/// each has alone are eliminated in several of them side by side, then those that two neighbours have alone,
/// as long as there are many of these, and what is left by fronts. Null where the blocks are few or large.
std::unique_ptr<SparseFactors> make_alike_factors(const SparseMatrix& pattern, Index borders);

}  // namespace arcslip::continuation
