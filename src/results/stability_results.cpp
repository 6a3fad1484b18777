#include "results/stability_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/problems/response/floquet_response.hpp"

namespace arcslip {
namespace {

using continuation::BranchPoint;
using continuation::PointType;

const problems::Floquet* response(const TracedBranch& traced) {
  return traced.curve ? nullptr : traced.base.disturbed.get();
}

bool is_change(const BranchPoint& point) {
  return point.type == PointType::neimark_sacker || point.type == PointType::symmetry_breaking ||
         point.type == PointType::period_doubling;
}

}  // namespace

std::optional<double> moved_by(const TracedBranch& traced, const BranchPoint& point) {
  const problems::Floquet* problem = response(traced);
  if (problem == nullptr || !is_change(point)) return std::nullopt;
  return problem->moved_by(
      {point.unknowns, point.parameters, point.regime, {}},
      continuation::index_of(traced.base.problem->parameter_names(), traced.request->options.parameter));
}

std::string describe_stability(const TracedBranch& traced) {
  const problems::Floquet* problem = response(traced);
  if (problem == nullptr) return "";
  int changes = 0;
  int lost = 0;
  double most = 0;
  for (const BranchPoint& point : traced.branch.points) {
    if (!is_change(point)) continue;
    ++changes;
    const std::optional<double> moved = moved_by(traced, point);
    lost += moved ? 0 : 1;
    most = std::max(most, std::abs(moved.value_or(0)));
  }
  if (changes == 0) return "";
  std::string text = fmt::format(
      "{} points where stability changes: with harmonics up to {} they move by at most {:.2g} in {}", changes,
      problem->finer_highest() / traced.base.harmonics.front(), most, traced.request->options.parameter);
  if (lost > 0) text += fmt::format("; {} of them are not found again", lost);
  const bool may_follow =
      !traced.request->switching && !traced.request->problem.response->has_own_frequency();
  if (may_follow)
    text +=
        "\nswitching = true follows what leaves where half periods differ, periods double or a pair crosses";
  return text + "\n";
}

}  // namespace arcslip
