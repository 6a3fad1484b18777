#pragma once

// Period doublings of cycles and maps as an extended problem.

#include "arcslip/continuation/cycles/periodic_orbit.hpp"
#include "arcslip/continuation/points/singular_problem.hpp"

namespace arcslip::continuation {

/// A multiplier -1. Of cycles the variation v' = T f_u v with v(1) = -v(0) has a solution: the singular
/// matrix is the Jacobian of the cycle without T and phase, with the sign of u(0) changed in u(1) = u(0). Of
/// a map f it is df/du + 1. Along a curve generalised period doublings, fold-flip points, those at
/// which a second multiplier is -1 and those with a pair of modulus 1 are found.
class DoublingProblem : public SingularProblem {
 public:
  /// Of periodic orbits or of a map that is not sparse; `active` becomes an unknown. The base is kept by
  /// reference.
  DoublingProblem(const Problem& base, Index active);

  std::vector<PointType> test_types() const override {
    return {PointType::generalized_period_doubling, PointType::fold_flip, PointType::resonance_1_2};
  }
  PointType pair_crossing() const override { return PointType::flip_neimark_sacker; }
  void test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  [[nodiscard]] bool eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                                 ComplexVector& values) const override;

 protected:
  void fill(BorderedSolver& solver, double shift) const override;

 private:
  const PeriodicOrbit* orbits_;  // null of a map
};

}  // namespace arcslip::continuation
