#pragma once

// All that a branch under way consists of, so that it can be taken up again and goes on bit by bit as if it
// had never been left.

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "arcslip/continuation/corrector.hpp"

namespace arcslip::continuation {

enum class Hold { tangent, parameter };

/// Value of a function along the branch and its derivative in the step's coordinate s = normal . (z -
/// z_here)/scale.
struct Monitor {
  double value = 0;
  double slope = 0;
};

/// Signs along the branch as last seen, 0 where a function has just vanished; an event changes a sign. They
/// are remembered, not computed again, since just behind a zero the sign is noise.
struct Signs {
  int parameter = 0;             ///< of its change along the branch
  std::vector<int> observables;  ///< of the derivatives of those tracked
  std::vector<int> functions;    ///< of the tests of the problem, then of the user's events
  int unstable = -1;             ///< eigenvalues with a positive real part; -1 without eigenvalues
};

struct Checkpoint {
  CurvePoint here;
  Vector bend;  ///< curvature of the last step
  std::vector<Monitor> monitors;
  Signs signs;
  Hold hold = Hold::tangent;
  double distance = 0;  ///< of the next step
  double arclength = 0;
  CurvePoint start;                   ///< which a closed loop comes back to
  std::map<std::string, long> found;  ///< special points so far, by type
};

/// As text, numbers in hexadecimal, so that nothing is lost.
void write(std::ostream& out, const Checkpoint& checkpoint);

/// Throws std::runtime_error where the text is not a checkpoint.
Checkpoint read_checkpoint(std::istream& in);

}  // namespace arcslip::continuation
