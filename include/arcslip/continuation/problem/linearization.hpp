#pragma once

// F and its derivatives at one point, whether the problem is dense, sparse or condensed.

#include "arcslip/continuation/linear/bordered_solver.hpp"
#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::continuation {

/// Nothing is allocated after construction, but for the pattern of a sparse Jacobian at the first evaluation.
/// The problem must outlive it.
class Linearization {
 public:
  /// Nothing is evaluated yet. `as_matrix` asks those that condense their Jacobian for a matrix as well.
  explicit Linearization(const Problem& problem, bool as_matrix = false);

  /// Evaluates F with all its derivatives, as `continuation::evaluate` does, or without those by parameters.
  /// `u` n, `p` number of parameters.
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const Regime& regime,
                              bool by_parameters = true);

  long evaluations() const { return evaluations_; }  ///< so far

  const Vector& residual() const { return residual_; }                      ///< F, n
  const Matrix& parameter_jacobian() const { return parameter_jacobian_; }  ///< n x number of parameters

  /// dF/du, n x n: one is set, the other empty, or both are where it is condensed.
  bool sparse() const { return sparse_; }
  const Matrix& jacobian() const { return jacobian_; }
  const SparseMatrix& sparse_jacobian() const { return sparse_jacobian_; }

  /// All of length n, with `x` not `out`.
  void multiply(const Vector& x, Vector& out) const;             ///< out = dF/du x
  void multiply_transposed(const Vector& x, Vector& out) const;  ///< out = (dF/du)^T x
  void multiply_absolute(const Vector& x, Vector& out) const;    ///< out = |dF/du| |x|, by entries

  /// A solver for it with so many borders.
  std::unique_ptr<BorderedSolver> make_solver(Index borders) const;

  /// Sets the solver's J = dF/du diag(column_scale); of the scale, the first n entries count. Throws
  /// std::logic_error if the solver is of another kind.
  void fill(BorderedSolver& solver, const Vector& column_scale) const;

 private:
  const Problem& problem_;
  bool sparse_;
  long evaluations_ = 0;
  Vector residual_;
  Matrix parameter_jacobian_;
  Matrix jacobian_;
  SparseMatrix sparse_jacobian_;
  std::unique_ptr<CondensedJacobian> condensed_;
};

}  // namespace arcslip::continuation
