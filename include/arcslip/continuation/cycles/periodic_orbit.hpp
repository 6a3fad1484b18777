#pragma once

// What periodic orbits have, be they of one field or put together of pieces: Floquet multipliers, and two of
// their rounds as one.

#include <atomic>

#include "arcslip/continuation/cycles/orbit_problem.hpp"
#include "arcslip/continuation/points/extended_problem.hpp"

namespace arcslip::continuation {

/// Abstract: see `CycleProblem` and `PiecewiseCycle`.
class PeriodicOrbit : public OrbitProblem {
 public:
  /// Whether one at which `apart` vanishes is two rounds of one of half the period.
  bool is_two_rounds(const Vector& u, const Regime& regime) const;
  std::string end_of_kind(const Vector& u, const Regime& regime) const override;

  /// Whether an entry of the Jacobian is that of what a round ends with by what the next one begins with.
  virtual bool joins_rounds(Index row, Index column) const = 0;

  /// Two rounds as one: their mesh, what is held at the nodes of one as that of both, the second times `sign`
  /// and further by the turns of angles where that is above 0, and their problem.
  virtual OrbitMesh mesh_of_two(const OrbitMesh& once) const = 0;
  virtual Matrix two_rounds(const Matrix& once, double sign) const = 0;
  virtual std::shared_ptr<OrbitProblem> doubled(const OrbitMesh& mesh, const Matrix& orbit,
                                                const Vector& p) const = 0;

  /// T of a whole round.
  virtual double period(const Vector& u, const Vector& p) const { return duration(u, p); }

  /// ln(mu) of the multipliers; empty where there are none. What a thread was told last is known when it asks
  /// again.
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
  void take_jacobian(const Vector& u, const Vector& p, const Regime& regime,
                     const FactoredJacobian& jacobian) const override;

 protected:
  PeriodicOrbit(std::shared_ptr<const Field> field, bool has_duration)
      : OrbitProblem(std::move(field), has_duration) {}

  virtual ComplexVector found_multipliers(const Vector& u, const Vector& p, const Regime& regime) const;
  /// The same on intervals, by the Jacobian there.
  virtual ComplexVector multipliers_by(const Vector& u, const Vector& p, const Regime& regime,
                                       const FactoredJacobian& jacobian) const = 0;
  /// How many there may be.
  virtual Index most_multipliers() const { return field().size() - (has_duration() ? 1 : 0); }

 private:
  struct Last;
  static Last& last();
  bool is_last(const Vector& u, const Vector& p, const Regime& regime) const;

  static std::atomic<long> made_;
  long number_ = ++made_;  // which of them this is
};

/// ln(mu) of a cycle or, by its derivatives `at` the point, of a map that is not sparse; else empty.
ComplexVector log_multipliers(const Problem& problem, const Linearization& at, const BasePoint& point);
/// The same where a map has not been evaluated at the point: `at` is.
ComplexVector log_multipliers_anew(const Problem& problem, Linearization& at, const BasePoint& point);
/// What Problem::eigenvalues has of these ln(mu): over T of a cycle.
ComplexVector rates_of(const Problem& problem, const ComplexVector& logs, const BasePoint& point);

/// How many unknowns an orbit has beside T; of another problem all.
Index count_beside_duration(const Problem& problem);

}  // namespace arcslip::continuation
