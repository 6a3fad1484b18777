#pragma once

// Points where a matrix of a problem is singular, as an extended problem.

#include "arcslip/continuation/points/extended_problem.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {

/// With J the matrix, of the first unknowns,
///
///   [J    b] [v]   [0]
///   [c^T  0] [g] = [1],    g = 0.
///
/// J may differ from dF/du in what is constant: the derivatives of both are the same.
class SingularProblem : public ExtendedProblem {
 public:
  [[nodiscard]] bool adapt(const BasePoint& point) override;

  /// Of the base but for the one that vanishes.
  [[nodiscard]] bool eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                                 ComplexVector& values) const override;

  /// v, n, in the problem's units, 0 behind the unknowns of J, at the point last evaluated.
  Vector right_null() const;

 protected:
  /// `active` becomes an unknown; J is of the first `count` unknowns. The base is kept by reference.
  SingularProblem(const Problem& base, Index active, Index count);

  /// Sets J = the matrix at `at_` times diag(`scale_`); of a dense one, with `shift` on its diagonal.
  virtual void fill(BorderedSolver& solver, double shift) const = 0;

  [[nodiscard]] bool solve_borders() const;
  bool conditions(const BasePoint& point, Vector& values, Matrix* gradients) const override;
  void each_border(const std::function<void(double*, Index)>& use) override;
  double strain() const override;
  long own_evaluations() const override { return second_.evaluations(); }

  Index count_;
  mutable SecondDerivative second_;
  mutable Vector right_;  // (v, g), v in units of D
  mutable Vector left_;   // (w, g)

 private:
  std::unique_ptr<BorderedSolver> solver_;
  Vector column_;  // b
  Vector row_;     // c
};

}  // namespace arcslip::continuation
