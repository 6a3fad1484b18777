#pragma once

// Hopf points as an extended problem.

#include "arcslip/continuation/points/extended_problem.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {

/// Hopf points of a dense equilibrium: dF/du has a pair of eigenvalues +-i omega. With numbers x + j z, where
/// j^2 = -kappa,
///
///   [dF/du - j  b] [q]   [0]
///   [c^T        0] [g] = [1],    g = 0 (both its parts),    e_0 = kappa = omega^2,
///
/// which stays regular at Bogdanov-Takens points, where kappa = 0; beyond them (kappa < 0) a pair of real
/// eigenvalues +-sqrt(-kappa) takes the place of the Hopf point. Zero-Hopf and double Hopf points are found,
/// too.
class HopfProblem : public ExtendedProblem {
 public:
  /// `active` becomes an unknown. Throws std::invalid_argument for a sparse base.
  HopfProblem(const Problem& base, Index active);

  [[nodiscard]] bool adapt(const BasePoint& point) override;
  /// There the pair of eigenvalues meets at 0.
  std::optional<PointType> last_of_curve() const override { return PointType::bogdanov_takens; }
  std::vector<Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  /// kappa, and the first Lyapunov coefficient of the cycles that leave.
  std::vector<PointType> test_types() const override {
    return {PointType::bogdanov_takens, PointType::generalized_hopf};
  }
  void test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  [[nodiscard]] bool eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                                 ComplexVector& values) const override;
  PointType pair_crossing() const override { return PointType::hopf_hopf; }
  PointType real_crossing() const override { return PointType::zero_hopf; }

 protected:
  bool conditions(const BasePoint& point, Vector& values, Matrix* gradients) const override;
  void each_border(const std::function<void(double*, Index)>& use) override;
  double strain() const override;
  long own_evaluations() const override { return second_.evaluations(); }

 private:
  [[nodiscard]] bool solve_borders(double kappa) const;

  std::unique_ptr<BorderedSolver> solver_;  // real form, 2n and two borders
  Vector column_;                           // b, its two parts
  Vector row_;                              // c
  mutable Matrix doubled_;
  mutable SecondDerivative second_;
  mutable Vector right_;    // (q, g), two parts each
  mutable Vector left_[2];  // of the two parts of g
};

}  // namespace arcslip::continuation
