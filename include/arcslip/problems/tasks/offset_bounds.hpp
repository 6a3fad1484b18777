#pragma once

// How far what a response tells depends on where sliders rest. A contact that never slips in the settled
// response holds any A with max (k r - mu N) <= A <= min (k r + mu N); the response that is traced has A as
// near to zero as these bounds let it be. Beside it stand those in which each such contact holds its least or
// its greatest mean force k r_0 - A, which are followed from it with all forces in proportion to their way:
// to all corners of the admissible set of up to four contacts, of more of them to those where all are on one
// side and where one alone is on either. Offsets are the same at all nodes, as those of a travelling wave.
//
// Of odd harmonics, where all other elements are linear or forget the mean of their motion, nothing that is
// told depends on A.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "arcslip/assembly/system.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"

namespace arcslip::problems {

/// What is told of one quantity.
struct QuantityBounds {
  std::string name;  ///< the column's: amplitudes, means and greatest values of R, Y, U and outputs
  double value;      ///< of the response that is traced
  double least;      ///< over all that were found; NaN where they were not
  double greatest;   ///< the same
};

/// Of one point.
struct OffsetBounds {
  std::vector<QuantityBounds> quantities;
  std::string reason = {};  ///< why the bounds are not known; "" where they are
};

/// A response in which contacts stick under given mean forces.
struct HeldResponse {
  HarmonicResponse problem;  ///< with the forces in its system's `held`
  continuation::Guess at;
};

/// Those at the corners and on the ways to them, of which `take` sees each; the reason why one was not
/// reached, or "". `problem` has the mean among its orders, and no parameter beside eta and P.
std::string follow_offsets(const HarmonicResponse& problem, const continuation::Guess& at,
                           const std::function<void(const HeldResponse&, bool is_corner)>& take);

/// Of a solution of `problem`, whose system is that of `parameters`; none where no contact sticks for ever.
std::optional<OffsetBounds> offset_bounds(const SystemParameters& parameters, const HarmonicResponse& problem,
                                          const continuation::Guess& at);

}  // namespace arcslip::problems
