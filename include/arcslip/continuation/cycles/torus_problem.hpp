#pragma once

// Neimark-Sacker points of cycles, from which tori leave, as an extended problem.

#include "arcslip/continuation/cycles/cycle_problem.hpp"
#include "arcslip/continuation/points/extended_problem.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {

/// Cycles with a pair of multipliers z of modulus 1: v' = T f_u v with v(1) = z v(0) has a solution. With
/// numbers x + z y, where z^2 = 2 kappa z - 1,
///
///   [J_z  b] [v]   [0]
///   [c^T  0] [g] = [1],    g = 0 (both its parts),    e_0 = kappa = cos(theta),   z = e^(j theta),
///
/// J_z the Jacobian of the cycle without T and phase, with z u(0) in place of u(0) in u(1) = u(0). It stays
/// regular where kappa = 1 or -1; beyond these the pair is real, z and 1/z.
class TorusProblem : public ExtendedProblem {
 public:
  /// `active` becomes an unknown. The base is kept by reference.
  TorusProblem(const CycleProblem& base, Index active);

  [[nodiscard]] bool adapt(const BasePoint& point) override;
  /// There the pair meets at 1 or at -1.
  std::optional<PointType> last_of_curve() const override { return PointType::double_multiplier; }
  std::vector<PointType> test_types() const override {
    return {PointType::double_multiplier, PointType::double_multiplier};
  }
  void test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  /// `angle`: theta, as far as the torus turns with each round.
  std::vector<Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;

 protected:
  bool conditions(const BasePoint& point, Vector& values, Matrix* gradients) const override;
  void each_border(const std::function<void(double*, Index)>& use) override;
  double strain() const override;
  long own_evaluations() const override { return second_.evaluations(); }

 private:
  [[nodiscard]] bool solve_borders(double kappa) const;
  void assemble(double kappa) const;

  Index unknowns_;                          // of the field
  Index count_;                             // of J_z
  std::unique_ptr<BorderedSolver> solver_;  // real form, two parts and two borders
  Vector column_;                           // b, its two parts
  Vector row_;                              // c
  mutable SparseMatrix doubled_;
  mutable SecondDerivative second_;
  mutable Vector right_;    // (v, g), two parts each
  mutable Vector left_[2];  // of the two parts of g
};

}  // namespace arcslip::continuation
