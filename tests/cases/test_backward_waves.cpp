// Waves that travel against the order of the sectors.

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>

#include "arcslip/cases/runs.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "case_texts.hpp"
#include "catch.hpp"
#include "places.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

/// What is found of all points looked at, by their values of eta.
std::map<double, problems::Verification> verified_sectors(const std::string& wave) {
  const Case input = case_texts::read_text(fmt::format(
      R"([system]
model = "sector"
{0}
sectors = 6
contact_stiffness = 0.3
preload = 0.5
harmonics = 3
[system.base]
mass = "{1}/mass.mtx"
stiffness = "{1}/stiffness.mtx"
mass_factor = 0.05
left = [1]
right = [2]
contact = [1]
load = {{ dof = [1], value = [1.0] }}
[branch]
parameter = "eta"
from = 0.1
to = 0.3
)",
      wave, source_folder() + "/problems/localised_ring"));
  const TracedBranch traced = trace(input.branches.front()).front();
  REQUIRE(traced.branch.complete());
  std::map<double, problems::Verification> all;
  for (const auto& one : problems::verify(traced.request->problem.system, traced.base.harmonics,
                                          traced.branch, problems::VerifyOptions()))
    all.emplace(traced.branch.points[one.point].parameters(0), one);
  return all;
}

}  // namespace

TEST_CASE("Sectors move in time under waves either way round", "[cases]") {
  const auto [forward, backward] =
      GENERATE(table<std::string, std::string>({{"wave_number = 1", "wave_number = -1"},
                                                {"wave_number = 2", "wave_number = -2"},
                                                {"wave_number = 1", "engine_order = 5"},
                                                {"wave_number = 2", "engine_order = 4"},
                                                {"wave_number = 3", "wave_number = -3"}}));
  CAPTURE(forward, backward);
  const auto one = verified_sectors(forward);
  const auto other = verified_sectors(backward);
  REQUIRE(one.size() == other.size());
  int in_time = 0;
  for (auto a = one.begin(), b = other.begin(); a != one.end(); ++a, ++b) {
    CAPTURE(a->first);
    CHECK_THAT(b->first, WithinRel(a->first, 1e-9));
    if (std::isnan(a->second.Y_time)) continue;
    ++in_time;
    CHECK_THAT(b->second.Y_time, WithinRel(a->second.Y_time, 1e-9));
    CHECK_THAT(b->second.Y_time, WithinRel(b->second.Y, 1e-3));
    CHECK(std::isnan(b->second.growth) == std::isnan(a->second.growth));
    if (!std::isnan(a->second.growth)) CHECK_THAT(b->second.growth, WithinAbs(a->second.growth, 1e-9));
  }
  CHECK(in_time > 2);
}
