#pragma once

// Cycles: periodic orbits of u' = f(t, u, p),
//
//   u(T) = u(0) + w,   and where f does not depend on t    int (u - u_0) . u_0' ds = 0
//
// with the last orbit of a frame for u_0. T is an unknown, or the field's own period. Stability by Floquet
// multipliers, those of the orbit's own velocity left out. w are the whole turns of angles.

#include <atomic>

#include "arcslip/continuation/cycles/orbit_problem.hpp"

namespace arcslip::continuation {

/// Unknowns: see OrbitProblem. Observables: T; the largest and the smallest value of each unknown, `x_max`
/// and `x_min`; `norm`, the root of the mean of |u|^2.
class CycleProblem : public OrbitProblem {
 public:
  /// `periods` of the field's own period, where it has one, make one of the cycle. A branch of cycles ends
  /// where they shrink onto an equilibrium or, of those that are `doubled`, come to be two rounds of one of
  /// half the period.
  CycleProblem(std::shared_ptr<const Field> field, const OrbitMesh& mesh, const Matrix& orbit,
               const Vector& p, int periods = 1, bool doubled = false);

  int periods() const { return periods_; }
  const Vector& winding() const { return winding_; }  ///< w, n
  bool is_doubled() const { return doubled_; }
  std::shared_ptr<OrbitProblem> about(const OrbitMesh& mesh, const Matrix& orbit,
                                      const Vector& p) const override {
    return std::make_shared<CycleProblem>(shared_field(), mesh, orbit, p, periods_, doubled_);
  }
  std::string end_of_kind() const override;

  /// The same problem on intervals about a cycle that is held by a trigonometric polynomial, and the unknowns
  /// of this cycle there, which are as good: for what is no cycle itself but goes along one.
  std::shared_ptr<CycleProblem> on_intervals(const Vector& u, const Vector& p, const Regime& regime,
                                             Vector& unknowns) const;

  [[nodiscard]] bool series(const Matrix& u, const Vector& p, const Regime& regime,
                            Matrix& out) const override;

  /// ln(mu) of the multipliers, of sparse fields those of the largest; empty where there are none. What a
  /// thread was told last is known when it asks again.
  ComplexVector log_multipliers(const Vector& u, const Vector& p, const Regime& regime) const override;

  /// ln(mu)/T, with ln(-mu) in place of ln(mu) of those below 0.
  [[nodiscard]] bool eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                                 ComplexVector& values) const override;
  /// Of period doublings and of Neimark-Sacker points, on intervals alone.
  std::unique_ptr<ExtendedProblem> special(PointType type, Index active, const Guess& at,
                                           Vector& extras) const override;
  bool has_multipliers() const override { return true; }
  PointType pair_crossing() const override { return PointType::neimark_sacker; }
  std::vector<PointType> test_types() const override { return {PointType::period_doubling}; }
  void test(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;

  std::vector<Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const Regime& regime, Index which,
                 Gradient& gradient) const override;

 protected:
  [[nodiscard]] bool end_conditions(const Vector& left, const Vector& right, const Vector& p,
                                    const EndConditions& out) const override;
  Matrix part_apart(const OrbitMesh& mesh, const Matrix& orbit) const override;
  double given_duration(const Vector& p, Vector* by_parameters) const override;

 private:
  struct Last;
  /// At the ends of intervals, n x (N + 1).
  [[nodiscard]] bool find_velocities(const Vector& u, const Vector& p, Matrix& out) const;
  ComplexVector largest_multipliers(const Vector& u, const Vector& p, const Regime& regime) const;
  ComplexVector found_multipliers(const Vector& u, const Vector& p, const Regime& regime) const;

  int periods_;
  bool doubled_;
  Vector winding_;
  static std::atomic<long> made_;
  long number_ = ++made_;  // which of them this is
};

/// How many unknowns a cycle has beside T; of another problem all.
Index count_beside_duration(const Problem& problem);

}  // namespace arcslip::continuation
