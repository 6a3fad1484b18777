#pragma once

// Hopf points as an extended problem.

#include "arcslip/continuation/extended_problem.hpp"
#include "arcslip/continuation/second_derivative.hpp"

namespace arcslip::continuation {

/// Hopf points of a dense equilibrium: dF/du has a pair of eigenvalues +-i omega, with e_0 = omega,
///
///   [dF/du - i omega  b] [q]   [0]
///   [c^H              0] [g] = [1],    g = 0 (its real and its imaginary part).
///
/// Along a curve of Hopf points Bogdanov-Takens (omega = 0), zero-Hopf and double Hopf points are found.
class HopfProblem : public ExtendedProblem {
 public:
  HopfProblem(const Problem& base, Index active);

  bool adapt(const BasePoint& point) override;
  std::vector<Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, int regime, Vector& values) const override;
  std::vector<PointType> test_types() const override {
    return {PointType::bogdanov_takens, PointType::zero_hopf};
  }
  void test(const Vector& u, const Vector& p, int regime, Vector& values) const override;
  bool eigenvalues(const Vector& u, const Vector& p, int regime, ComplexVector& values) const override;
  PointType pair_crossing() const override { return PointType::hopf_hopf; }

 protected:
  bool conditions(const BasePoint& point, Vector& values, Matrix* gradients) const override;

 private:
  bool solve_borders(double omega) const;

  std::unique_ptr<BorderedSolver> solver_;  // real form, 2n and two borders
  Vector column_;                           // b as (real, imaginary)
  Vector row_;                              // c
  mutable Matrix doubled_;
  mutable SecondDerivative second_;
  mutable Vector right_;    // (Re q, Im q, Re g, Im g)
  mutable Vector left_[2];  // of Re g and of Im g
};

}  // namespace arcslip::continuation
