#pragma once

// Cycles that case files ask for, and their special points.

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/cycles/cycle_problem.hpp"
#include "case_runs.hpp"
#include "case_texts.hpp"

namespace arcslip::testing {

using continuation::CycleProblem;

inline const CycleProblem* cycles(const TracedBranch& traced) {
  return dynamic_cast<const CycleProblem*>(traced.base.problem.get());
}

inline std::vector<TracedBranch> traced_of(const std::string& text, const Settings& settings = {}) {
  std::vector<TracedBranch> all;
  for (const CaseBranch& request : case_texts::read_text(text, settings).branches) {
    for (TracedBranch& one : trace(request)) all.push_back(std::move(one));
  }
  return all;
}

/// Branches of cycles alone.
inline std::vector<TracedBranch> cycles_of(std::vector<TracedBranch> all) {
  std::erase_if(all, [](const TracedBranch& one) { return cycles(one) == nullptr; });
  return all;
}

inline std::vector<double> values_at(const TracedBranch& traced, PointType type, const std::string& name) {
  std::vector<double> values;
  for (const BranchPoint& point : points(traced, type)) values.push_back(value(traced, point, name));
  return values;
}

/// Those of all branches, ascending.
inline std::vector<double> all_values_at(const std::vector<TracedBranch>& all, PointType type,
                                         const std::string& name) {
  std::vector<double> values;
  for (const TracedBranch& one : all) {
    for (const double found : values_at(one, type, name)) values.push_back(found);
  }
  std::sort(values.begin(), values.end());
  return values;
}

inline void check_values(const std::vector<double>& found, const std::vector<double>& wanted, double margin) {
  REQUIRE(found.size() == wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    CHECK_THAT(found[i], WithinAbs(wanted[i], margin * std::max(1.0, std::abs(wanted[i]))));
}

/// Of the fixed point 0 of a map: -1 is a multiplier where q = -1 - b, a double one where b = 1.
inline const std::string doublings_of_map = R"case(
[model]
kind = "map"
[model.parameters]
b = 0.5
q = -1.7
[model.equations]
x = "y"
y = "-b*x + q*y - 0.4*x^2*y + 0.3*x*y"
[branch]
curve = "period_doubling"
parameters = ["b", "q"]
window = [-0.5, 1.5]
from = -3
to = -1
)case";

/// x = y, x^2 = mu: a fold at mu = 0, of multipliers 1 and b.
inline const std::string folds_of_map = R"case(
[model]
kind = "map"
[model.parameters]
mu = 0.1
b = 0.5
[model.equations]
x = "y"
y = "-b*x + (1 + b)*y + mu - x^2"
[model.start]
x = 0.3
y = 0.3
[branch]
curve = "fold"
parameters = ["mu", "b"]
window = [0.1, -0.1]
from = 0.5
to = 1.5
)case";

/// x' = g x - turn y, y' = turn x + g y: cycles are the circles on which g(x^2 + y^2, mu) vanishes.
inline std::string circles(const std::string& g, const std::string& turn, const std::string& rest) {
  return "[model.parameters]\nmu = 0\n[model.definitions]\ns = \"x^2 + y^2\"\ng = \"" + g + "\"\nturn = \"" +
         turn + "\"\n[model.equations]\nx = \"g*x - turn*y\"\ny = \"turn*x + g*y\"\n" + rest;
}

/// A round cycle, of which r is at rest where `radial` vanishes, with a pair (u, v) beside it that grows by
/// `grow` along (cos t/2, sin t/2), of which Z is the part, and decays across it.
inline std::string flipping_pair(const std::string& radial, const std::string& grow,
                                 const std::string& rest) {
  return "[model.definitions]\nr = \"sqrt(x^2 + y^2)\"\ncc = \"(1 + x/r)/2\"\nss = \"(1 - x/r)/2\"\ncs = "
         "\"y/r/2\"\nZZ = \"u^2*cc + 2*u*v*cs + v^2*ss\"\nradial = \"" +
         radial + "\"\ngrow = \"" + grow +
         "\"\nzc = \"u*cc + v*cs\"\nzs = \"u*cs + v*ss\"\n[model.equations]\nx = \"x*radial - y\"\ny = "
         "\"y*radial + x\"\nu = \"grow*zc - (u - zc) - v/2\"\nv = \"grow*zs - (v - zs) + u/2\"\n" +
         rest;
}

}  // namespace arcslip::testing
