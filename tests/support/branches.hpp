#pragma once

// How tests ask for branches and read them.

#include <string>
#include <vector>

#include "arcslip/continuation/path/trace.hpp"

namespace arcslip::testing {

inline continuation::TraceOptions over(const std::string& parameter, double from, double to) {
  continuation::TraceOptions options;
  options.parameter = parameter;
  options.from = from;
  options.to = to;
  return options;
}

inline std::vector<continuation::BranchPoint> of_type(const continuation::Branch& branch,
                                                      continuation::PointType type) {
  std::vector<continuation::BranchPoint> points;
  for (const continuation::BranchPoint& point : branch.points) {
    if (point.type == type) points.push_back(point);
  }
  return points;
}

}  // namespace arcslip::testing
