#pragma once

// The height of a response within a window, found without a study.

#include <algorithm>

#include "arcslip/problems/response/harmonic_response.hpp"
#include "arcslip/problems/ridges/preload_study.hpp"
#include "catch.hpp"

namespace arcslip::testing {

/// A response over the window that is traced for itself.
inline continuation::Branch traced_response(const problems::HarmonicResponse& problem,
                                            const problems::PreloadRange& range, double preload) {
  continuation::TraceOptions options;
  options.parameter = "eta";
  options.from = range.eta_low;
  options.to = range.eta_high;
  options.extrema_of = {"Y"};
  return trace(problem, problem.guess(range.eta_low, preload), options);
}

/// Its highest amplitude.
inline double traced_height(const problems::HarmonicResponse& problem, const problems::PreloadRange& range,
                            double preload) {
  const continuation::Branch branch = traced_response(problem, range, preload);
  REQUIRE(branch.complete());
  double highest = 0;
  Vector values;
  for (const continuation::BranchPoint& point : branch.points) {
    problem.observe(point.unknowns, point.parameters, point.regime, values);
    highest = std::max(highest, values(problems::HarmonicResponse::Y));
  }
  return highest;
}

}  // namespace arcslip::testing
