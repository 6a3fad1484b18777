#pragma once

// A traced branch: plain data.

#include <string>
#include <string_view>
#include <vector>

#include "arcslip/continuation/corrector.hpp"

namespace arcslip::continuation {

enum class PointType { regular, start, end, regime_switch, fold, peak, trough, user };

/// As written to files: `regular`, `start`, `end`, `switch`, `fold`, `peak`, `trough`, `user`.
std::string_view to_string(PointType type);

struct BranchPoint {
  PointType type = PointType::regular;
  int regime = 0;        ///< at a switch, the regime that the branch enters
  Vector unknowns;       ///< n
  Vector parameters;     ///< all of the problem's
  double arclength = 0;  ///< from the start, in the problem's scale
  int iterations = 0;    ///< Newton corrections spent on the point
  double residual = 0;   ///< largest entry of F
};

enum class Stop { reached_end, left_range, max_points, min_step, interrupted, no_start, grazing_border };

/// As written to files: `reached_end`, `left_range`, and so on.
std::string_view to_string(Stop stop);

struct Branch {
  std::vector<BranchPoint> points;  ///< in the order traced
  Stop stop = Stop::no_start;
  std::string explanation;  ///< the reason of the stop, a sentence
  Work work;

  bool complete() const { return stop == Stop::reached_end; }
};

}  // namespace arcslip::continuation
