#pragma once

// Folds as an extended problem.

#include "arcslip/continuation/points/extended_problem.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {

/// Folds: dF/du singular,
///
///   [dF/du  b] [v]   [0]
///   [c^T    0] [g] = [1],    g = 0.
///
/// Along a curve of folds cusps are found, and of equilibria Bogdanov-Takens and zero-Hopf points.
class FoldProblem : public ExtendedProblem {
 public:
  /// `active` becomes an unknown. The base is kept by reference.
  FoldProblem(const Problem& base, Index active);

  [[nodiscard]] bool adapt(const BasePoint& point) override;
  std::vector<PointType> test_types() const override;
  void test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  [[nodiscard]] bool eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                                 ComplexVector& values) const override;
  PointType pair_crossing() const override { return PointType::zero_hopf; }

  /// Null vectors at the point last evaluated: dF/du v = 0, v of unit length in the problem's scale, and
  /// w^T dF/du = 0.
  Vector right_null() const;
  Vector left_null() const { return left_.head(base().size()); }

  /// c in p_a = p_a* + c x^2 + ..., x the length along v, at the point last evaluated.
  double quadratic(const BasePoint& point) const;

 protected:
  bool conditions(const BasePoint& point, Vector& values, Matrix* gradients) const override;
  void each_border(const std::function<void(double*, Index)>& use) override;
  double strain() const override;
  long own_evaluations() const override { return second_.evaluations(); }

 private:
  bool solve_borders() const;

  std::unique_ptr<BorderedSolver> solver_;
  Vector column_;  // b
  Vector row_;     // c
  mutable SecondDerivative second_;
  mutable Vector right_;  // (v, g), v in units of D
  mutable Vector left_;   // (w, g)
};

}  // namespace arcslip::continuation
