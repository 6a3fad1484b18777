#pragma once

// Cycles: periodic orbits of u' = f(t, u, p),
//
//   u(T) = u(0) + w,   and where f does not depend on t    int (u - u_0) . u_0' ds = 0
//
// with the last orbit of a frame for u_0. T is an unknown, or the field's own period. Stability by Floquet
// multipliers, those of the orbit's own velocity left out. w are the whole turns of angles.

#include "arcslip/continuation/cycles/periodic_orbit.hpp"

namespace arcslip::continuation {

/// Unknowns: see OrbitProblem. Observables: T; the largest and the smallest value of each unknown, `x_max`
/// and `x_min`; `norm`, the root of the mean of |u|^2.
class CycleProblem : public PeriodicOrbit {
 public:
  /// `periods` of the field's own period, where it has one, make one of the cycle. A branch of cycles ends
  /// where they shrink onto an equilibrium or come to be two rounds of one of half the period.
  CycleProblem(std::shared_ptr<const Field> field, const OrbitMesh& mesh, const Matrix& orbit,
               const Vector& p, int periods = 1);

  int periods() const { return periods_; }
  const Vector& winding() const { return winding_; }  ///< w, n
  std::shared_ptr<OrbitProblem> about(const OrbitMesh& mesh, const Matrix& orbit,
                                      const Vector& p) const override {
    return std::make_shared<CycleProblem>(shared_field(), mesh, orbit, p, periods_);
  }

  bool joins_rounds(Index row, Index column) const override {
    return row < field().size() && column < field().size();
  }
  OrbitMesh mesh_of_two(const OrbitMesh& once) const override;
  Matrix two_rounds(const Matrix& once, double sign) const override;
  std::shared_ptr<OrbitProblem> doubled(const OrbitMesh& mesh, const Matrix& orbit,
                                        const Vector& p) const override {
    return std::make_shared<CycleProblem>(shared_field(), mesh, orbit, p, 2 * periods_);
  }

  /// The same problem on intervals about a cycle that is held by a trigonometric polynomial, and the unknowns
  /// of this cycle there, which are as good: for what is no cycle itself but goes along one.
  std::shared_ptr<CycleProblem> on_intervals(const Vector& u, const Vector& p, const Regime& regime,
                                             Vector& unknowns) const;

  [[nodiscard]] bool series(const Matrix& u, const Vector& p, const Regime& regime,
                            Matrix& out) const override;

  std::vector<Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const Regime& regime, Index which,
                 Gradient& gradient) const override;

 protected:
  [[nodiscard]] bool end_conditions(const Vector& left, const Vector& right, const Vector& p,
                                    const EndConditions& out) const override;
  Matrix part_apart(const OrbitFrame& frame, const Eigen::Ref<const Matrix>& orbit) const override;
  double given_duration(const Vector& p, Vector* by_parameters) const override;

  /// Of sparse fields those of the largest.
  ComplexVector found_multipliers(const Vector& u, const Vector& p, const Regime& regime) const override;
  ComplexVector multipliers_by(const Vector& u, const Vector& p, const Regime& regime,
                               const FactoredJacobian& jacobian) const override;

 private:
  /// At the ends of intervals, n x (N + 1).
  [[nodiscard]] bool find_velocities(const Vector& u, const Vector& p, Matrix& out) const;

  int periods_;
  Vector winding_;
};

}  // namespace arcslip::continuation
