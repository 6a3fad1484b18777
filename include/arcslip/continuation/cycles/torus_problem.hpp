#pragma once

// Neimark-Sacker points of cycles, from which tori leave, as an extended problem.

#include <optional>

#include "arcslip/continuation/cycles/periodic_orbit.hpp"
#include "arcslip/continuation/points/pair_problem.hpp"

namespace arcslip::continuation {

/// Cycles with a pair of multipliers z of modulus 1, z^2 = 2 kappa z - 1: v' = T f_u v + tau f with v(1) = z
/// v(0) has a solution without phase. Its matrix is the Jacobian of the cycle, with z u(0) in place of u(0)
/// in u(1) = u(0); e_0 = kappa = cos(theta), z = e^(j theta). Its determinant is that of the monodromy matrix
/// less z over 1 - z: without T and phase the multiplier 1 of all cycles would be a root as well, and the
/// curve would cross that of folds, on which kappa = 1. It stays regular where kappa = 1 or -1; beyond these
/// the pair is real, z and 1/z. Of a map f the matrix is df/du - z. Along a curve points are found
/// where z is a root of 1, to the fourth, Chenciner points, and those with a multiplier 1, -1 or another pair
/// of modulus 1 beside.
class TorusProblem : public PairProblem {
 public:
  /// Of periodic orbits or of a map that is not sparse; `active` becomes an unknown. The base is kept by
  /// reference.
  TorusProblem(const Problem& base, Index active);

  /// There the pair meets at 1 or at -1.
  std::vector<PointType> last_of_curve() const override {
    return {PointType::resonance_1_1, PointType::resonance_1_2};
  }
  std::vector<PointType> test_types() const override {
    return {PointType::resonance_1_1,      PointType::resonance_1_2, PointType::resonance_1_3,
            PointType::resonance_1_4,      PointType::chenciner,     PointType::fold_neimark_sacker,
            PointType::flip_neimark_sacker};
  }
  PointType pair_crossing() const override { return PointType::double_neimark_sacker; }
  /// Of the base but for the pair.
  [[nodiscard]] bool eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                                 ComplexVector& values) const override;
  void test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  /// `angle`: theta, as far as the torus turns with each round.
  std::vector<Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;

 protected:
  ByKappa sum(double kappa) const override { return {2 * kappa, 2}; }
  ByKappa product(double /*kappa*/) const override { return {1, 0}; }
  void fill(BorderedSolver& solver, const Pair& pair, const Vector& scales) const override;
  Vector turned(const Vector& x) const override;

 private:
  std::optional<ComplexVector> other_logs(const BasePoint& point) const;

  const PeriodicOrbit* orbits_;  // null of a map
};

/// Of period doublings and Neimark-Sacker points: the extended problem, and the extras that it begins with,
/// by the ln(mu) at the point; null where there is no such pair, and of other types.
std::unique_ptr<ExtendedProblem> special_of_multipliers(const Problem& problem, PointType type, Index active,
                                                        const ComplexVector& log_multipliers, Vector& extras);

}  // namespace arcslip::continuation
