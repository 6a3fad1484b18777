#pragma once

// A branch as a polyline that is drawn as the curve is: between its points some more, where the curve bends.

#include <functional>
#include <vector>

#include "arcslip/continuation/path/branch.hpp"

namespace arcslip::continuation {

/// What is drawn of a point; valid until the next call.
using Drawn = std::function<const std::vector<double>&(const BranchPoint&)>;

/// Points, and what is drawn of each: a row for it, a column for each value.
struct DrawnPoints {
  std::vector<BranchPoint> points;
  Matrix values;
};

/// The points of a branch and, between these, regular points of the interpolated branch, so many that
/// straight lines are nowhere further from it than two thousandths of the width and height between
/// neighbouring points, or of 8e-4 of the branch's width and height where these are nearer to each other.
/// That holds for every quantity that is drawn over the parameter, on linear and on logarithmic axes.
/// `parameter` is the position of the continuation parameter among the problem's. With the problem what is
/// filled in is looked at in the middle between two points: where the solution next to it is drawn elsewhere
/// it is the branch through that solution, too, that is drawn, and where there is none, a straight line.
DrawnPoints polyline(const Branch& branch, Index parameter, const Drawn& drawn,
                     const Problem* problem = nullptr);

}  // namespace arcslip::continuation
