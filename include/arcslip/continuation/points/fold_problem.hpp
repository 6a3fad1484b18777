#pragma once

// Folds as an extended problem.

#include "arcslip/continuation/points/singular_problem.hpp"

namespace arcslip::continuation {

/// Folds: dF/du singular.
///
/// Along a curve of folds cusps are found, of equilibria Bogdanov-Takens and zero-Hopf points, of cycles and
/// maps fold-flip points.
class FoldProblem : public SingularProblem {
 public:
  /// `active` becomes an unknown. The base is kept by reference.
  FoldProblem(const Problem& base, Index active);

  std::vector<PointType> test_types() const override;
  void test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  [[nodiscard]] bool eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                                 ComplexVector& values) const override;
  PointType pair_crossing() const override { return PointType::zero_hopf; }

  /// w at the point last evaluated, where `right_null` is v: dF/du v = 0, v of unit length in the problem's
  /// scale, and w^T dF/du = 0.
  Vector left_null() const { return left_.head(base().size()); }

  /// c in p_a = p_a* + c x^2 + ..., x the length along v, at the point last evaluated.
  double quadratic(const BasePoint& point) const;

 protected:
  void fill(BorderedSolver& solver) const override;
};

}  // namespace arcslip::continuation
