#pragma once

// Folds, branch points and Hopf points solved for by Newton's method on their extended problems, and the
// coefficients of their normal forms.

#include <array>
#include <optional>

#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/points/branch_point_problem.hpp"
#include "arcslip/continuation/points/fold_problem.hpp"

namespace arcslip::continuation {

/// Solves an extended problem at fixed other parameters from a guess of the point: null where it does not
/// converge. `residual` of the result is the largest entry of F and of the conditions.
struct LocatedPoint {
  BasePoint point;      ///< of the base
  double residual = 0;  ///< of F and of the conditions
  int iterations = 0;   ///< taken
};
[[nodiscard]] std::optional<LocatedPoint> locate(ExtendedProblem& problem, const BasePoint& guess,
                                                 double tolerance = 1e-10);

/// A fold, p_a = p_a* + quadratic x^2 + ..., with x along v; degenerate (a cusp) where quadratic vanishes.
struct FoldForm {
  Vector right;          ///< v, n: null vector of dF/du, |v/scale| = 1
  Vector left;           ///< w, n: w^T dF/du = 0
  double quadratic = 0;  ///< c, in units of p_a
};
/// Locates the fold next to a guess of it first; none where that or the form fails.
[[nodiscard]] std::optional<FoldForm> fold_form(const Problem& problem, Index parameter, const Guess& fold);

/// How the two branches through a point lie.
enum class BranchPointKind {
  transcritical,  ///< both branches have a slope in the parameter
  pitchfork,      ///< one of them turns there
  hilltop,        ///< both do: a fold as well
  isolated,       ///< no branch leaves the point: the centre of a vanishing closed branch
  degenerate      ///< the second-order terms do not tell
};

/// Its name, in small letters.
std::string_view to_string(BranchPointKind kind);

/// A simple branch point. The branches' directions d solve psi^T F_zz d d = 0 on the null space of F_z, z =
/// (u, p_a).
struct BranchPointForm {
  BranchPointKind kind = BranchPointKind::degenerate;  ///< degenerate: the rest does not count
  std::array<Vector, 2> directions;  ///< n + 1 each, |d/scale| = 1; the pitchfork's turning branch second
  std::array<double, 2> slopes{};    ///< of p_a over distance along u, dp_a/|du/scale|; 0 where it turns
  double cubic = 0;      ///< pitchfork: c in p_a = p_a* + c x^2 of the turning branch, x along u; else nan
  long evaluations = 0;  ///< that it took
};
/// Locates the branch point next to a guess of it first; none where that fails.
[[nodiscard]] std::optional<BranchPointForm> branch_point_form(const Problem& problem, Index parameter,
                                                               const Guess& branch_point,
                                                               const Tolerances& tolerances = {});

/// What the fold at which a curve of folds over `parameter` and another parameter turns in the other one is:
/// isola_centre or simple_bifurcation where the branches over `parameter` are those of a branch point; fold
/// where that cannot be told or one of them turns besides, as at a pitchfork.
[[nodiscard]] PointType turn_of_folds(const Problem& problem, Index parameter, const Guess& fold);

}  // namespace arcslip::continuation
