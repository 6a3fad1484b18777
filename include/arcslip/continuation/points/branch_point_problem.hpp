#pragma once

// Branch points as an extended problem, and those that are no simple ones.

#include <algorithm>
#include <array>

#include "arcslip/continuation/points/extended_problem.hpp"
#include "arcslip/continuation/problem/guess.hpp"
#include "arcslip/continuation/problem/second_derivative.hpp"

namespace arcslip::continuation {

/// Simple branch points: [dF/du dF/dp_a] loses rank,
///
///   [psi^T g^T] [dF/du dF/dp_a b]
///               [C^T           0] = [0 0 1],    g = 0 (two conditions),
///
/// and F + e b = 0. With a further free parameter e stays zero only where branch points persist, as on
/// branches that symmetry or an invariant subspace keeps; elsewhere the curve is that of a perturbed problem.
class BranchPointProblem : public ExtendedProblem {
 public:
  /// `active` becomes an unknown. The base is kept by reference.
  BranchPointProblem(const Problem& base, Index active);

  [[nodiscard]] bool adapt(const BasePoint& point) override;

  /// Basis of the null space of [dF/du dF/dp_a] at the point last evaluated: (n + 1) x 2, in the problem's
  /// units, orthonormal in its scale where the borders were chosen.
  Matrix null_space() const;
  /// psi, n.
  Vector left_null() const { return left_.head(base().size()); }
  /// n + 1, the scale in which these are measured.
  Vector null_scale() const;

 protected:
  bool conditions(const BasePoint& point, Vector& values, Matrix* gradients) const override;
  void each_border(const std::function<void(double*, Index)>& use) override;
  double strain() const override;
  long own_evaluations() const override { return second_.evaluations(); }

 private:
  bool solve_borders() const;

  std::unique_ptr<BorderedSolver> solver_;
  double active_scale_ = 1;
  Matrix rows_;  // C, (n + 1) x 2
  mutable SecondDerivative second_;
  mutable Vector left_;      // (psi, g)
  mutable Vector right_[2];  // (w_j, .)
};

/// The null space of [dF/du dF/dp_a] where it has three dimensions, in the problem's scale:
///
///   [dF/du dF/dp_a B] [W]   [0]
///   [C^T           0] [G] = [1],   G = 0,   psi^T [dF/du dF/dp_a] = 0,   psi^T B = 1.
class DoublePoint {
 public:
  DoublePoint(const Problem& problem, Index active, Guess at)
      : problem_(problem),
        active_(active),
        at_(std::move(at)),
        n_(problem.size()),
        linear_(problem),
        second_(problem),
        solver_(make_bordered_solver(n_, 3, problem.sparse())),
        scale_(n_ + 1) {}

  const Guess& at() const { return at_; }
  const Matrix& null_space() const { return right_; }
  /// How far from here, in the scale, the conditions may hold: by the largest of them over how fast they
  /// change, after `set_forms`; and the same of the matrix with its borders being singular.
  double away() const { return conditions_.cwiseAbs().maxCoeff() / largest_slope(); }
  double away_from_more() const;
  double residual() const { return linear_.residual().lpNorm<Eigen::Infinity>(); }

  /// Chooses borders here. False where the matrix is singular with them to the last digit.
  [[nodiscard]] bool settle();

  /// Moves by one Newton correction of F = 0 and, by least squares, of G = 0, after `set_forms`.
  void correct();

  void move_to(const Guess& at) {
    at_ = at;
    static_cast<void>(settle());
  }
  /// The largest entry of the difference, in the scale.
  double away_from(const Guess& other) const {
    Vector way(n_ + 1);
    way << at_.unknowns - other.unknowns, at_.parameters(active_) - other.parameters(active_);
    return way.cwiseQuotient(scale_).lpNorm<Eigen::Infinity>();
  }

  /// psi_i^T F_zz w_j w_k, by i.
  [[nodiscard]] bool set_forms();
  Eigen::Vector2d quadratic(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    return {a.dot(forms_[0] * b), a.dot(forms_[1] * b)};
  }

  /// psi^T (F_zzz d d d + 3 F_zz d h)/6 with F_z h = -F_zz d d, d = W y; nan where F has no value.
  Eigen::Vector2d cubic(const Eigen::Vector3d& y);

  /// d in the problem's units, and back from there.
  Vector direction(const Eigen::Vector3d& y) const { return scale_.cwiseProduct(right_ * y); }
  Eigen::Vector3d coordinates(const Vector& d) const {
    return right_.colPivHouseholderQr().solve(d.cwiseQuotient(scale_));
  }

 private:
  double largest_slope() const {
    return std::max(forms_[0].cwiseAbs().maxCoeff(), forms_[1].cwiseAbs().maxCoeff());
  }
  Vector parameters(double value) const { return value * Vector::Unit(at_.parameters.size(), active_); }
  [[nodiscard]] bool solve_borders();
  /// psi^T F_zz d at d h from here, n + 1 by 2 in the scale.
  [[nodiscard]] bool rows(const Vector& d, double h, Matrix& out);

  const Problem& problem_;
  Index active_;
  Guess at_;
  Index n_;
  Linearization linear_;
  SecondDerivative second_;
  std::unique_ptr<BorderedSolver> solver_;
  Vector scale_;
  double size_ = 1;    // of dF/du
  Matrix columns_;     // B
  Matrix border_;      // C, n + 1 by 3
  Matrix left_;        // psi, n by 2
  Matrix right_;       // W, n + 1 by 3
  Matrix conditions_;  // G, 2 by 3
  std::array<Eigen::Matrix3d, 2> forms_;
};

}  // namespace arcslip::continuation
