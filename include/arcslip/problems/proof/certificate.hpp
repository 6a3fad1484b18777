#pragma once

// Proof by interval arithmetic that a traced branch of ForcedResponse is right.
//
// The straight piece between two stored points becomes a tilted box (see enclosed_equation.hpp) in which for
// every value of the parameter there is exactly one rho = ln R: the branch exists there, is unique in the box
// and does not fold. Where that cannot be shown, the piece is divided at a point of the branch between, and
// where rho and parameter exchange their roles, near a fold, exactly one value of the parameter is shown for
// every rho. Boxes that meet in a point are about it, one within the other, so that both hold the same
// solution; where the roles change, a rectangle about the point is shown to hold one monotone curve alone.
//
// Where Im c < 0, shown by intervals as well, each (eta, P) has one response and nothing folds. With F = k
// phi r, two responses of r + c F = -y_0 would differ by dr = -c dF, so that Im(dF conj(dr)) = |dF|^2 Im c.
// But a Jenkins element has Im(dF conj(dr)) >= 0: it is the energy per cycle, over pi, that the difference of
// its forces does work on the difference of its motions, and as f' = k (x' - p') with sliding p, where (f_1 -
// f_2)(p_1' - p_2') >= 0, that is never less than the change of (f_1 - f_2)^2/(2k), which is nothing over a
// cycle.
//
// The proof is of the equation with the system's numbers as they are in double precision. See interval.hpp
// for what is assumed of the machine.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "arcslip/continuation/path/branch.hpp"
#include "arcslip/problems/proof/enclosed_equation.hpp"

namespace arcslip::problems {

/// How the branch was traced, which says where its points may be missing.
struct CertificateOptions {
  /// Of the branch's points: |g| may be twice this.
  double tolerance = 1e-10;
  /// Of the branch, in (ln q, rho): a segment of more than twice this lacks points.
  double max_step = 0.1;
  std::function<bool()> go_on = {};  ///< asked before each segment; false leaves it unproven
};

/// A range of the parameter in which the branch may fold.
struct Turn {
  double low;    ///< of the parameter, as is `high`
  double high;   ///< > low
  bool certain;  ///< the branch leaves it the other way than it came: there is a fold, or an odd number of
                 ///< them
};

/// What has been proven of a branch.
struct Certificate {
  /// A segment that is not proven, from this point of the branch to the next.
  struct Gap {
    std::size_t point;   ///< its position in the branch
    std::string reason;  ///< a sentence
  };

  double from = 0;             ///< the parameter's value at the branch's first point
  double to = 0;               ///< and at its last
  long boxes = 0;              ///< which prove the branch, or what comes before the gap
  double widest = 0;           ///< half the width of the widest box, in rho or in ln q
  std::vector<Turn> turns;     ///< in the branch's order; there is no fold elsewhere
  std::optional<Gap> gap;      ///< the first one
  bool single_valued = false;  ///< Im c < 0 over the whole range of eta: one response at every (eta, P)
  double seconds = 0;          ///< wall clock

  /// Whether every segment is.
  bool proven() const { return !gap; }
};

/// `parameter` is the one that the branch was continued in.
Certificate certify(const ForcedResponse& problem, const continuation::Branch& branch,
                    ContactProblem::Parameter parameter, const CertificateOptions& options = {});

}  // namespace arcslip::problems
