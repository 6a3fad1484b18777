#pragma once

// Points where a matrix of a problem is singular for a pair of numbers z, as an extended problem.

#include "arcslip/continuation/points/extended_problem.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {

/// J_0 + z J_1 is singular for both z of a pair, z^2 = a z - b with a and b by e_0 = kappa. With the space V
/// of both,
///
///   J_0 V + J_1 V L = 0,   C^T V = 1,   tr L = a,   det L = b,
///
/// V n x 2 and L 2 x 2, which are found by Newton's method within. It stays regular where both z meet, with
/// one null vector or with two; beyond they are real, or conjugate again. J_0 + J_1 may differ from dF/du in
/// what is constant.
class PairProblem : public ExtendedProblem {
 public:
  [[nodiscard]] bool adapt(const BasePoint& point) override;

 protected:
  using Pair = Eigen::Matrix2d;

  /// Of a number a or b: its value and its derivative by kappa.
  struct ByKappa {
    double value;
    double slope;
  };

  /// `active` becomes an unknown. The base is kept by reference.
  PairProblem(const Problem& base, Index active);

  virtual ByKappa sum(double kappa) const = 0;      ///< a, of both z
  virtual ByKappa product(double kappa) const = 0;  ///< b

  /// Sets the matrix of V -> J_0 V + J_1 V L at `at_`, V column after column, with these `scales` of its
  /// columns: its block (i, j) is J_1 L(j, i), and J_0 on the diagonal.
  virtual void fill(BorderedSolver& solver, const Pair& pair, const Vector& scales) const = 0;

  /// J_1 x
  virtual Vector turned(const Vector& x) const = 0;

  /// By how far the pair is from meeting, `apart` = 0 where it does with one null vector and 0/0 with two,
  /// where the curve goes on: divided by its own size and by |L - a/2|^2, without which it were 0 there, too.
  /// No number where that is not known.
  double meeting_test(const BasePoint& point, double apart) const;

  bool conditions(const BasePoint& point, Vector& values, Matrix* gradients) const override;
  void each_border(const std::function<void(double*, Index)>& use) override;
  double strain() const override;
  long own_evaluations() const override { return second_.evaluations(); }

  Index count_;  // unknowns of the base

 private:
  Vector scales() const;
  [[nodiscard]] bool begin(double kappa);
  [[nodiscard]] bool solve_space() const;
  bool has_pair_of(double kappa) const;
  [[nodiscard]] bool find_space(const BasePoint& point) const;

  std::unique_ptr<BorderedSolver> solver_;  // of V and of what L is to change by
  Matrix frame_;                            // C, which V is where it was chosen
  Pair start_;                              // L there
  double size_ = 1;                         // of the matrices, as of z
  double slope_ = 1;                        // of the conditions
  mutable SecondDerivative second_;
  mutable Matrix space_;         // V in units of the scale
  mutable Pair pair_;            // L
  mutable Vector found_at_;      // the unknowns and parameters where these are
  mutable int corrections_ = 0;  // that finding them took
};

}  // namespace arcslip::continuation
