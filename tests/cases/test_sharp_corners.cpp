// Responses that turn sharply within a regime, where a contact that lifts off comes to rub in another order.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "arcslip/cases/runs.hpp"
#include "catch.hpp"
#include "ring_of_rows.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::BranchPoint;
using continuation::PointType;

namespace {

/// Special points of a response traced one way, from low eta to high ones.
std::vector<std::pair<PointType, double>> special_points(const CaseBranch& request) {
  const auto traced = trace(request);
  REQUIRE(traced.size() == 1);
  REQUIRE(traced.front().branch.complete());
  std::vector<std::pair<PointType, double>> points;
  for (const BranchPoint& point : traced.front().branch.points) {
    if (point.type != PointType::regular && point.type != PointType::start && point.type != PointType::end)
      points.emplace_back(point.type, point.parameters(0));
  }
  if (traced.front().branch.points.front().parameters(0) > 0.5) std::reverse(points.begin(), points.end());
  return points;
}

}  // namespace

TEST_CASE("A response with sharp corners within a regime is whole, both ways, at whatever steps",
          "[cases][even]") {
  const TemporaryFolder folder;
  write_row(folder, "base", {1.48, 2.52, 1.45}, {3.68, 6.1, 5.71}, {6.77, 4.66, 7.83});
  write_row(folder, "damper", {1.75, 0.672, 0.737}, {1.53, 1.31, 1.6}, {0.13, 0.251, 0.0674});
  const std::string text = ring_of_rows(
      "[1, 2]",
      "wave_number = 2\ncontact_stiffness = 0.907\npreload = 1.19\ndamping = { base = 0.00385, damper = "
      "0.0152 }\n"
      "[[element]]\nkind = \"friction\"\nat = \"contact\"\nnormal = 2\n"
      "tangential_stiffness = 1.36\nnormal_stiffness = 1.31\nmu = 0.168\nnormal_per_preload = 0.757\n");
  std::vector<std::pair<PointType, double>> first;
  for (const auto& [from, to] : {std::pair{0.1, 0.6}, std::pair{0.6, 0.1}}) {
    for (const double longest : {0.1, 0.031, 0.01}) {
      CAPTURE(from, longest);
      const std::string asked =
          fmt::format("[branch]\nparameter = \"eta\"\nfrom = {}\nto = {}\n[continuation]\nmax_step = {}\n",
                      from, to, longest);
      const auto points = special_points(read_case(folder.write("case.toml", text + asked)).branches.front());
      if (first.empty()) first = points;
      REQUIRE(points.size() == first.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        CHECK(std::abs(points[i].second - first[i].second) < 1e-7);
      }
    }
  }
  const auto corners = std::count_if(first.begin(), first.end(),
                                     [](const auto& point) { return point.first == PointType::corner_fold; });
  CHECK(corners == 3);
  CHECK(first.size() > 20);
}
