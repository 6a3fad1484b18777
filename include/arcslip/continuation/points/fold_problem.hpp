#pragma once

// Folds as an extended problem.

#include "arcslip/continuation/points/singular_problem.hpp"

namespace arcslip::continuation {

/// Folds: dF/du singular.
///
/// Along a curve of folds cusps are found, of equilibria Bogdanov-Takens and zero-Hopf points, of cycles and
/// maps fold-flip points and those at which a second multiplier is 1. Where it turns in its parameter
/// p_b, psi^T dF/dp_a = 0, the branches over p_a at that p_b have a singular point [M. Golubitsky & D.
/// Schaeffer, Singularities and Groups in Bifurcation Theory I, Springer 1985, ch. IV]: an isola centre where
/// the quadratic form of their equation is definite, a simple bifurcation where it is not.
class FoldProblem : public SingularProblem {
 public:
  /// `active` becomes an unknown. The base is kept by reference.
  FoldProblem(const Problem& base, Index active);

  std::vector<PointType> test_types() const override;
  void test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  PointType pair_crossing() const override {
    return base().has_multipliers() ? PointType::fold_neimark_sacker : PointType::zero_hopf;
  }
  PointType turn(const Vector& u, const Vector& p, const Regime& regime) const override;

  /// w at the point last evaluated, where `right_null` is v: dF/du v = 0, v of unit length in the problem's
  /// scale, and w^T dF/du = 0.
  Vector left_null() const { return left_.head(base().size()); }

  /// c in p_a = p_a* + c x^2 + ..., x the length along v, at the point last evaluated.
  double quadratic(const BasePoint& point) const;

 protected:
  void fill(BorderedSolver& solver, double shift) const override;
};

}  // namespace arcslip::continuation
