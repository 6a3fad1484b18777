#pragma once

// Newton's method on a branch: F(u, p) = 0 together with one linear condition,
//
//   normal . (z - origin)/scale = distance,      z = (u, p_a), p_a the active parameter.
//
// With `normal` the tangent at the origin this is pseudo-arclength continuation [Keller 1977]; with the unit
// vector of the parameter it keeps the parameter, which lands on a value exactly [Rheinboldt & Burkardt
// 1983]. Either way the Jacobian is the exact one, bordered, and the last factorisation gives the tangent.

#include <functional>
#include <limits>
#include <optional>

#include "arcslip/continuation/linear/bordered_solver.hpp"
#include "arcslip/continuation/problem/linearization.hpp"

namespace arcslip::continuation {

/// A point of a branch with what is needed to go on from it.
struct CurvePoint {
  Vector unknowns;    ///< n
  Vector parameters;  ///< all of the problem's
  Regime regime;      ///< whose piece of F is solved
  Vector scale;    ///< n + 1, of z at this point; that of u times sqrt(n), so that norms do not grow with n
  Vector tangent;  ///< n + 1, unit length, dz/ds in units of `scale`
  double orientation = 0;  ///< sign of det [J F_p; tangent^T], which changes at branch points alone
  /// The logarithm of its size, as `Problem::determinants` has it: -infinity at a branch point, nan where it
  /// is not known.
  double log_determinant = std::numeric_limits<double>::quiet_NaN();
  double residual = 0;  ///< largest entry of F
  int iterations = 0;   ///< Newton corrections spent on it
};

/// How a correction ended; but for the first the point is not on the branch.
enum class [[nodiscard]] Correction{converged, cannot_evaluate, singular, diverging, too_many_iterations};

/// What ends a correction.
struct CorrectorOptions {
  double tolerance = 1e-10;          ///< on the largest entry of F
  int max_iterations = 10;           ///< before it is `too_many_iterations`
  std::function<void()> watch = {};  ///< called before each evaluation of F; what it throws ends the work
  bool over_parameter = false;       ///< where F is linear in u, lengths are those of the parameter alone
};

/// Work counted over a branch.
struct Work {
  long evaluations = 0;     ///< of F with its derivatives; of a curve's base, for a curve
  long factorizations = 0;  ///< of the bordered Jacobian
  long iterations = 0;      ///< Newton corrections
  long rejected_steps = 0;  ///< attempts from which the branch did not go on
  long spectra = 0;         ///< times that eigenvalues were asked for
};

/// The sums of all.
Work operator+(const Work& a, const Work& b);

constexpr double not_counted = 1e8;  ///< scale of unknowns whose changes do not count, in the problem's

/// Owns its work space: nothing is allocated after construction, but for what a sparse factorisation needs.
class Corrector {
 public:
  /// `parameter` is the position of the active one. The problem is kept by reference.
  Corrector(const Problem& problem, Index parameter, const CorrectorOptions& options);

  /// n, the active parameter's position, the tolerance on F in force, and the options as they were given.
  Index size() const { return size_; }
  Index parameter() const { return parameter_; }
  double tolerance() const { return tolerance_; }
  const CorrectorOptions& options() const { return options_; }

  /// Sets the tolerance for a branch that starts at `point`, with its scale: as given, but of a problem whose
  /// F is in such units that its terms are above 1e3 relative to these. False where it has no value.
  [[nodiscard]] bool calibrate(CurvePoint& point);

  /// What the tolerance on F is relative to, as found by `calibrate`.
  double residual_size() const { return residual_size_; }
  void set_residual_size(double size);

  /// An unset point of the right sizes.
  CurvePoint make_point() const;

  /// Whether in this regime lengths are those of the parameter alone.
  bool is_over_parameter(const Regime& regime) const {
    return options_.over_parameter && problem_.is_linear(regime);
  }

  /// Fills `point.scale` from the problem.
  void set_scale(CurvePoint& point);

  /// z of `point` in units of `scale`, relative to `origin`: out = (z - z_origin)/scale.
  void difference(const CurvePoint& point, const CurvePoint& origin, Vector& out) const;

  /// point = origin + scale * displacement.
  void displace(const CurvePoint& origin, const Vector& displacement, CurvePoint& point) const;

  /// Corrects `point` from where it stands; of sparse problems, where steps are short, by the factors at the
  /// origin first, so that those at the point are the only new ones, elsewhere by those of each of Newton's
  /// corrections for as long as they serve. `to_rounding` goes on until the residual is at its rounding
  /// level.
  Correction correct(CurvePoint& point, const CurvePoint& origin, const Vector& normal, double distance,
                     bool to_rounding = false);

  /// One Newton correction of F = 0 and of a condition with the gradient `normal` that is to change by
  /// `change`.
  Correction correct_once(CurvePoint& point, const CurvePoint& origin, const Vector& normal, double change);

  /// Right after `correct` with the same arguments: corrects the unknowns at the parameter as it is. Where
  /// the branch is steep what is left after `correct`, below the tolerance along the branch, is much longer
  /// so, and to solve at the parameter that is told is what a point is for. Nothing is changed where the
  /// branch is vertical, what is left does not shrink, or is no shorter than `near`.
  void close(CurvePoint& point, const CurvePoint& origin, const Vector& normal, double near);

  /// Contraction rate of the last corrections, |dz_2|/|dz_1|; 0 where fewer than two were needed.
  double contraction() const { return contraction_; }

  /// dz/ds along the branch at the point last corrected or linearised, in units of the origin's scale, with
  /// normal . (dz/ds) = 1.
  const Vector& direction() const { return direction_; }

  /// Sets tangent, scale and determinant of `point` from `direction()`, which is measured in `origin.scale`.
  void set_tangent(CurvePoint& point, const CurvePoint& origin);

  /// Factors the problem at a point that is already on the branch, with the scale that it has, for
  /// `direction()`.
  Correction linearise(CurvePoint& point, const Vector& normal);

  /// dF/du of a sparse problem at a point that was corrected last, to the tolerance; else none.
  std::optional<FactoredJacobian> jacobian_at(const CurvePoint& point);

  /// Whether the bordered Jacobian last factored is singular but for rounding.
  bool nearly_singular();

  /// Sign of det [J F_p; normal^T] as last factored, and the logarithm of its size, as
  /// `Problem::determinants` has it, in the scale of the origin where it is told in one.
  double orientation() const { return border_sign_; }
  double log_determinant() const;

  /// What was spent so far.
  Work& work() { return work_; }

 private:
  [[nodiscard]] bool evaluate(CurvePoint& point);
  [[nodiscard]] bool factor(const CurvePoint& point, const Vector& scale, const Vector& normal);
  [[nodiscard]] bool solve_direction();
  Correction with_direction();
  double gap(const CurvePoint& point, const CurvePoint& origin, const Vector& normal, double distance);
  [[nodiscard]] bool find_residual(const CurvePoint& point);
  [[nodiscard]] bool ends(CurvePoint& point, const CurvePoint& origin);
  double solve_correction(double change);
  void add_correction(CurvePoint& point, const CurvePoint& origin) const;
  [[nodiscard]] bool has_factors_at(const CurvePoint& origin, double near);
  template <class Solve>
  int shorten(CurvePoint& point, const CurvePoint& origin, double last, double rate, const Solve& solve);
  double approach(CurvePoint& point, const CurvePoint& origin, const Vector& normal, double distance);
  double unseen() const;
  void remember(double length, double approached);
  [[nodiscard]] bool go_on(CurvePoint& point, const CurvePoint& origin, const Vector& normal, double distance,
                           double last);
  void apply(CurvePoint& point, const CurvePoint& origin);
  double turn_to_parameter();
  LogProduct determinant(const Vector& scale) const;
  double rounding_level(const CurvePoint& point);  // also sets parameter_rounds_

  const Problem& problem_;
  Index size_;
  Index parameter_;
  CorrectorOptions options_;
  double residual_size_ = 1;
  double tolerance_;  // on the largest entry of F
  Linearization linearization_;
  Determinants told_;
  std::unique_ptr<BorderedSolver> solver_;
  Work work_;
  double contraction_ = 0;
  bool parameter_rounds_ = false;  // whether the parameter's last bit is most of the rounding level
  double border_sign_ = 0;         // sign of det [J F_p; normal^T]
  Vector correction_;
  Vector direction_;
  Vector unknown_scale_;
  Vector magnitudes_;  // of the terms of F
  Vector factored_scale_;
  Vector factored_unknowns_;  // where the last factors of a sparse problem are from
  Regime factored_regime_;
  long factored_when_ = 0;                                         // at which evaluation
  bool has_direction_ = false;                                     // whether `direction_` is by these
  double first_length_ = std::numeric_limits<double>::infinity();  // of the last point's first correction
  double nearing_ = 1;  // of a correction by factors from the point before it, to the one after it
  mutable Eigen::VectorX<Index> counts_;  // of the rows' entries
  mutable Vector squares_;                // of the rows' lengths
  Vector parameter_scale_;
  Vector before_;            // the unknowns before the last correction of `close`, or F on the way to a point
  Vector parameter_normal_;  // the condition that keeps the parameter
};

}  // namespace arcslip::continuation
