#pragma once

// Points where a matrix of a problem is singular for a pair of conjugate numbers z, as an extended problem.

#include "arcslip/continuation/points/extended_problem.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {

/// With numbers x + z y, where z^2 = a z - b is real in kappa,
///
///   [J_0 + z J_1  b] [v]   [0]
///   [c^T          0] [g] = [1],    g = 0 (both its parts),    e_0 = kappa.
///
/// It stays regular where both z meet; beyond they are real. J_0 + J_1 may differ from dF/du in what is
/// constant.
class PairProblem : public ExtendedProblem {
 public:
  [[nodiscard]] bool adapt(const BasePoint& point) override;

  /// Of the base but for the pair.
  [[nodiscard]] bool eigenvalues(const Vector& u, const Vector& p, const Regime& regime,
                                 ComplexVector& values) const override;

 protected:
  /// Of a number a or b: its value and its derivative by kappa.
  struct ByKappa {
    double value;
    double slope;
  };

  /// `active` becomes an unknown. The base is kept by reference.
  PairProblem(const Problem& base, Index active);

  /// The one of the pair among the base's eigenvalues; the other is its negative.
  virtual Complex eigenvalue(const BasePoint& point) const = 0;

  virtual ByKappa sum(double kappa) const = 0;      ///< a, of both z
  virtual ByKappa product(double kappa) const = 0;  ///< b

  /// Sets the real form [J_0, -b J_1; J_1, J_0 + a J_1] of the matrix at `at_`, with these `scales` of its
  /// columns.
  virtual void fill(BorderedSolver& solver, double a, double b, const Vector& scales) const = 0;

  /// J_1 x
  virtual Vector turned(const Vector& x) const = 0;

  bool conditions(const BasePoint& point, Vector& values, Matrix* gradients) const override;
  void each_border(const std::function<void(double*, Index)>& use) override;
  double strain() const override;
  long own_evaluations() const override { return second_.evaluations(); }

  Index count_;  // unknowns of the base

 private:
  [[nodiscard]] bool solve_borders(double kappa) const;

  std::unique_ptr<BorderedSolver> solver_;  // real form, two parts and two borders
  Vector column_;                           // b, its two parts
  Vector row_;                              // c
  mutable SecondDerivative second_;
  mutable Vector right_;    // (v, g), two parts each, v in units of the scale
  mutable Vector left_[2];  // of the two parts of g
};

}  // namespace arcslip::continuation
