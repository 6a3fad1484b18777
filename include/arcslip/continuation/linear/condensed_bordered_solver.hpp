#pragma once

// Bordered systems of a Jacobian J = diag(w) (1 + K) - r v^T whose K has few columns: with t = v^T x and
// beta = diag(w)^{-1} [B, -r], gamma = [C^T; -v^T], delta = diag(D, 1),
//
//   x = q - K x_a - beta (y, t),   q = diag(w)^{-1} f,
//
// of which the active x_a alone are solved for, with the borders,
//
//   [ 1 + K_aa      beta_a           ] [x_a   ]   [ q_a           ]
//   [ -gamma K_a    delta - gamma beta ] [(y, t)] = [ (g, 0) - gamma q ].
//
// The determinant is that of this matrix times the product of w, whatever J is, singular too.

#include "arcslip/continuation/linear/bordered_solver.hpp"
#include "arcslip/continuation/linear/condensed_jacobian.hpp"

namespace arcslip::continuation {

/// What is left is solved by factors where it is small, else by iterations, or by factors again where these
/// do not converge.
class CondensedBorderedSolver final : public BorderedSolver {
 public:
  /// For n = `size` unknowns, of which up to so many active ones are solved for by factors; no number may be
  /// negative.
  CondensedBorderedSolver(Index size, Index borders, Index factored_up_to = 1000);

  /// The Jacobian is kept by reference and must not change until the last `solve`.
  using BorderedSolver::set_jacobian;
  void set_jacobian(const CondensedJacobian& jacobian, const Vector& column_scale) override;
  double factor() override;
  void multiply_determinant(LogProduct& product) const override;
  void solve(Vector& right_hand_side) override;
  void solve_transposed(Vector& right_hand_side) override;

 private:
  void set_borders();
  double factor_matrix();
  double iterate();
  void solve_inner(Vector& reduced, bool transposed);
  Vector chosen(const Vector& all) const;  // of n those that are active
  Vector spread(const Vector& active) const;

  Index factored_up_to_;
  const CondensedJacobian* jacobian_ = nullptr;
  double unit_ = 1;                           // in which x is measured, so that it is as large as y
  Vector scale_;                              // n, of the columns, in this unit
  Vector weight_;                             // w, in it
  Matrix beta_;                               // n x (borders + 1)
  Matrix gamma_;                              // (borders + 1) x n
  Matrix k_;                                  // the active rows and columns of 1 + K
  Vector coupled_;                            // work space, n
  std::unique_ptr<BorderedSolver> matrix_;    // of 1 + K_aa as a matrix
  std::unique_ptr<BorderedSolver> iterated_;  // by its products
  BorderedSolver* inner_ = nullptr;           // which of them
};

}  // namespace arcslip::continuation
