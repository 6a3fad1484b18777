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
// The proof is of the equation with the system's numbers as they are in double precision. See interval.hpp for
// what is assumed of the machine.

#include <optional>
#include <string>
#include <vector>

#include "arcslip/continuation/branch.hpp"
#include "arcslip/problems/enclosed_equation.hpp"

namespace arcslip::problems {

struct CertificateOptions {
  /// Of the branch's points: |g| may be twice this.
  double tolerance = 1e-10;
  /// Of the branch, in (ln q, rho): a segment of more than twice this lacks points.
  double max_step = 0.1;
};

/// A range of the parameter without which the branch is proven to go on in one direction.
struct Turn {
  double low;
  double high;
  bool certain;  ///< the branch comes back: there is a fold. Else there may be some, or none
};

struct Certificate {
  /// A segment that is not proven, from this point of the branch to the next.
  struct Gap {
    std::size_t point;
    std::string reason;
  };

  double from = 0;            ///< the parameter's value at the branch's first point
  double to = 0;              ///< and at its last
  long boxes = 0;             ///< which prove the branch, or what comes before the gap
  double widest = 0;          ///< half the width of the widest box, in rho or in ln q
  std::vector<Turn> turns;    ///< there is no fold elsewhere
  std::optional<Gap> gap;     ///< the first one
  bool single_valued = false; /**< Im c < 0 over the whole range of eta, so that each (eta, P) has one response:
      from r + k phi c r = -y_0 two of them would have Im(dF conj(dr)) = |dF|^2 Im c, where F = k phi r, and
      Im(dF conj(dr)) >= 0 for a Jenkins element */
  double seconds = 0;

  bool proven() const { return !gap; }
};

/// `parameter` is the one that the branch was continued in.
Certificate certify(const ForcedResponse& problem, const continuation::Branch& branch,
                    ContactProblem::Parameter parameter, const CertificateOptions& options = {});

}  // namespace arcslip::problems
