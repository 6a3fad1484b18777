#pragma once

// Hopf points as an extended problem.

#include "arcslip/continuation/points/pair_problem.hpp"

namespace arcslip::continuation {

/// Hopf points of an equilibrium: dF/du has a pair of eigenvalues z = +-i omega, z^2 = -kappa, so that
/// dF/du - z is singular, with e_0 = kappa = omega^2. It stays regular at Bogdanov-Takens points, where kappa
/// = 0; beyond them (kappa < 0) a pair of real eigenvalues +-sqrt(-kappa) takes the place of the Hopf point.
/// Zero-Hopf and double Hopf points are found, too.
class HopfProblem : public PairProblem {
 public:
  /// `active` becomes an unknown. The base is kept by reference.
  HopfProblem(const Problem& base, Index active);

  /// There the pair of eigenvalues meets at 0.
  std::vector<PointType> last_of_curve() const override { return {PointType::bogdanov_takens}; }
  std::vector<Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  /// kappa, and the first Lyapunov coefficient of the cycles that leave.
  std::vector<PointType> test_types() const override {
    return {PointType::bogdanov_takens, PointType::generalized_hopf};
  }
  void test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  PointType pair_crossing() const override { return PointType::hopf_hopf; }
  PointType real_crossing() const override { return PointType::zero_hopf; }
  /// Of the base but for the pair.
  [[nodiscard]] bool eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                                 ComplexVector& values) const override;

 protected:
  ByKappa sum(double /*kappa*/) const override { return {0, 0}; }
  ByKappa product(double kappa) const override { return {kappa, 1}; }
  void fill(BorderedSolver& solver, const Pair& pair, const Vector& scales) const override;
  Vector turned(const Vector& x) const override { return -x; }

 private:
  void fill_sparse(BorderedSolver& solver, const Pair& pair, const Vector& scales) const;

  mutable Matrix doubled_;
};

}  // namespace arcslip::continuation
