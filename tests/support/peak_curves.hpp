#pragma once

// Curves of peaks over the preload against the peaks of responses.

#include <map>
#include <vector>

#include "arcslip/cases/runs.hpp"
#include "branches.hpp"
#include "catch.hpp"

namespace arcslip::testing {

inline std::vector<continuation::BranchPoint> extrema_along(const continuation::Branch& branch) {
  std::vector<continuation::BranchPoint> points;
  for (const continuation::BranchPoint& point : branch.points) {
    if (point.type == continuation::PointType::peak || point.type == continuation::PointType::trough)
      points.push_back(point);
  }
  return points;
}

/// eta of all curves, which are whole, at each preload that was asked for.
inline std::map<double, std::vector<double>> etas_met(const std::vector<TracedBranch>& curves) {
  std::map<double, std::vector<double>> met;
  for (const TracedBranch& curve : curves) {
    CHECK(curve.branch.complete());
    for (const continuation::BranchPoint& point : of_type(curve.branch, continuation::PointType::user)) {
      const auto at = curve.curve->split(point.unknowns, point.parameters, point.regime);
      met[at.parameters(1)].push_back(at.parameters(0));
    }
  }
  return met;
}

/// There the curves have the peaks of the response, in the order of eta. Returns at how many preloads.
inline std::size_t check_peaks_met(const CaseBranch& request, const std::vector<TracedBranch>& curves) {
  const std::map<double, std::vector<double>> met = etas_met(curves);
  for (const auto& [preload, etas] : met) {
    CAPTURE(preload);
    CaseBranch response = seed_branch(request);
    response.problem.system.preload = preload;
    const continuation::Branch branch = trace(response).front().branch;
    std::vector<double> peaks;
    for (const continuation::BranchPoint& point : of_type(branch, continuation::PointType::peak))
      peaks.push_back(point.parameters(0));
    REQUIRE(peaks.size() == etas.size());
    for (std::size_t i = 0; i < peaks.size(); ++i) CHECK_THAT(etas[i], WithinRel(peaks[i], 1e-9));
  }
  return met.size();
}

}  // namespace arcslip::testing
