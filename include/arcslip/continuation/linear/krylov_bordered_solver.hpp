#pragma once

// Bordered systems of the active part A = 1 + K_aa of a condensed Jacobian, by GMRES [Saad & Schultz, SIAM J.
// Sci. Stat. Comput. 7 (1986) 856] on M^{-1} A, with a matrix M close to A, bordered as A is. The determinant
// is that of M times that of M^{-1} A, of which the iterations tell the eigenvalues far from 1: those below
// zero for its sign; its size is that much of an estimate.

#include "arcslip/continuation/linear/bordered_solver.hpp"
#include "arcslip/continuation/linear/condensed_jacobian.hpp"
#include "arcslip/continuation/linear/dense_bordered_solver.hpp"

namespace arcslip::continuation {

/// For Jacobians that have a preconditioner.
class KrylovBorderedSolver final : public BorderedSolver {
 public:
  /// For so many active unknowns; neither number may be negative.
  KrylovBorderedSolver(Index size, Index borders);

  /// Kept by reference; must not change until the last `solve`. The scale is not used.
  using BorderedSolver::set_jacobian;
  void set_jacobian(const CondensedJacobian& jacobian, const Vector& column_scale) override;

  /// The sign is nan where iterations do not converge.
  double factor() override;
  void multiply_determinant(LogProduct& product) const override;

  /// Fill with nan where iterations do not converge.
  void solve(Vector& right_hand_side) override;
  void solve_transposed(Vector& right_hand_side) override;

 private:
  void multiply(const Vector& x, bool transposed, Vector& out);
  void precondition(Vector& x, bool transposed);
  void iterate(Vector& x, bool transposed);
  double cycle(Vector& x, double enough, bool transposed);

  const CondensedJacobian* jacobian_ = nullptr;
  std::unique_ptr<Preconditioner> near_;
  Matrix borders_;               // M^{-1} B
  Matrix borders_transposed_;    // M^{-T} C
  DenseBorderedSolver between_;  // D - C^T M^{-1} B
  double sign_ = 0;
  ComplexVector values_;  // the eigenvalues of M^{-1} A that iterations tell
  Matrix basis_;          // of the iterations
  Matrix hessenberg_;     // M^{-1} A in it
  Index steps_ = 0;       // of the last cycle
  Vector spread_;         // work space, as long as the whole Jacobian
  Vector coupled_;
};

}  // namespace arcslip::continuation
