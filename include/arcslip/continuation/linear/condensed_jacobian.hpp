#pragma once

// Jacobians that differ from a diagonal in some of their columns only, and by a product of two vectors,
//
//   J = diag(w) (1 + K) - r v^T,
//
// such as those of structures with local nonlinearities: the columns of K that are not zero belong to what is
// not linear at present. K is known by its products, which cost less than its entries.

#include <memory>
#include <vector>

#include "arcslip/continuation/linear/log_product.hpp"
#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// A matrix close to another one whose inverse is at hand.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  virtual void solve(Vector& x) = 0;                                 ///< x <- M^{-1} x
  virtual void solve_transposed(Vector& x) = 0;                      ///< x <- M^{-T} x
  virtual double sign() const = 0;                                   ///< of det M; 0 where it is singular
  virtual void multiply_determinant(LogProduct& product) const = 0;  ///< by det M
};

/// Filled by a problem's `evaluate`.
class CondensedJacobian {
 public:
  virtual ~CondensedJacobian() = default;

  const Vector& weight() const { return weight_; }              ///< w, n, without zeros
  const Vector& column() const { return column_; }              ///< r, n
  const Vector& row() const { return row_; }                    ///< v, n
  const std::vector<Index>& active() const { return active_; }  ///< the columns of K that may not be zero

  virtual void couple(const Vector& x, Vector& out) const = 0;             ///< out = K x
  virtual void couple_transposed(const Vector& x, Vector& out) const = 0;  ///< out = K^T x
  virtual void couple_absolute(const Vector& x, Vector& out) const = 0;    ///< out >= |K| |x|, as large

  /// Fills those rows and columns of K that are active.
  virtual void fill(Matrix& k) const = 0;

  /// A matrix close to the same of 1 + K, and cheaper to solve with; null where there is none.
  virtual std::unique_ptr<Preconditioner> precondition() const { return nullptr; }

  /// All of length n, with `x` not `out`.
  void multiply(const Vector& x, Vector& out) const;             ///< out = J x
  void multiply_transposed(const Vector& x, Vector& out) const;  ///< out = J^T x
  void multiply_absolute(const Vector& x, Vector& out) const;    ///< out >= |J| |x|, as large

 protected:
  Vector weight_;
  Vector column_;
  Vector row_;
  std::vector<Index> active_;
};

}  // namespace arcslip::continuation
