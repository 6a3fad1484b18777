#pragma once

// The case files that come with the program, run as the program runs them.

#include <fmt/format.h>

#include <map>
#include <string>
#include <vector>

#include "arcslip/cases/runs.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "places.hpp"

namespace arcslip::testing {

using continuation::BranchPoint;
using continuation::PointType;
using continuation::Stop;

using Settings = std::vector<std::string>;

/// A case with all that was traced for it.
struct Run {
  explicit Run(const std::string& name, const Settings& settings = {})
      : input(read_case(source_folder() + "/problems/" + name + ".toml", settings)) {
    for (const CaseBranch& request : input.branches) {
      for (TracedBranch& one : trace(request)) traced.push_back(std::move(one));
    }
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  Case input;
  std::vector<TracedBranch> traced;
};

inline std::vector<BranchPoint> points(const TracedBranch& traced, PointType type) {
  return of_type(traced.branch, type);
}

inline std::size_t count(const TracedBranch& traced, PointType type) { return points(traced, type).size(); }

/// Derivatives at regular points of a branch, every so many from one of them on, are those of differences.
inline void check_derivatives_along(const TracedBranch& traced, std::size_t from, std::size_t every) {
  for (std::size_t k = from; k < traced.branch.points.size(); k += every) {
    const BranchPoint& point = traced.branch.points[k];
    if (point.type != PointType::regular) continue;
    const auto report =
        continuation::check_derivatives(traced.problem(), point.unknowns, point.parameters, point.regime);
    INFO(report.where);
    CHECK(report.worst < 1e-7);
  }
}

/// A parameter or an observable by the name that its column has.
inline double value(const TracedBranch& traced, const BranchPoint& point, const std::string& name) {
  const continuation::Problem& problem = traced.problem();
  const std::vector<std::string> parameters = problem.parameter_names();
  const auto found = std::find(parameters.begin(), parameters.end(), name);
  if (found != parameters.end()) return point.parameters(found - parameters.begin());
  Vector values;
  problem.observe(point.unknowns, point.parameters, point.regime, values);
  const auto observables = problem.observables();
  for (std::size_t i = 0; i < observables.size(); ++i) {
    if (observables[i].name == name) return values(static_cast<Index>(i));
  }
  FAIL("no column " << name);
  return 0;
}

/// Largest entry of F at a point of a curve, whose own residual has the curve's conditions, in other units.
inline double residual_of_base(const TracedBranch& traced, const BranchPoint& point) {
  const auto at = traced.curve->split(point.unknowns, point.parameters, point.regime);
  Vector residual(traced.base.problem->size());
  if (!traced.base.problem->evaluate(at.unknowns, at.parameters, at.regime, {&residual})) return INFINITY;
  return residual.lpNorm<Eigen::Infinity>();
}

constexpr double published = 1e-8;  // relative, for problems that are algebraic

/// The special points of a type, in order, by some of their columns.
inline void check(const TracedBranch& traced, PointType type,
                  const std::vector<std::map<std::string, double>>& expected, double tolerance = published) {
  INFO(to_string(type) << " of " << traced.branch.explanation);
  const auto found = points(traced, type);
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const auto& [name, number] : expected[i]) {
      CHECK_THAT(value(traced, found[i], name), WithinRel(number, tolerance) || WithinAbs(number, 1e-12));
    }
  }
}

/// The setting that leaves a case with `for_each` this preload alone.
inline std::string preload_of(double preload) {
  return fmt::format("branch.for_each.preload=[{:.17g}]", preload);
}

}  // namespace arcslip::testing
