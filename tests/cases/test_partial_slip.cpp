// Contacts of which only some slip, and elements of which only a part does.

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "arcslip/cases/runs.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "branches.hpp"
#include "case_texts.hpp"
#include "catch.hpp"
#include "results/sector_table.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

double observed(const TracedBranch& traced, const BranchPoint& point, const std::string& name) {
  const std::vector<Observable> all = traced.base.problem->observables();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Observable& one) { return one.name == name; });
  REQUIRE(found != all.end());
  Vector values;
  traced.base.problem->observe(point.unknowns, point.parameters, point.regime, values);
  return values(found - all.begin());
}

}  // namespace

TEST_CASE("What microslip leaves alone is no disturbance that stays", "[cases]") {
  const Case input = case_texts::read_text(R"([system]
model = "spring_mass"
base = { mass = [1.0], stiffness = [1.0] }
damping_kind = "viscous"
contact_stiffness = 0.5
damping = { base = 0.01 }
preload = 0.7
harmonics = 9
[[element]]
kind = "iwan"
at = "contact"
first_limit = 0.1
stiffness = 0.25
spread = 1.0
[branch]
parameter = "eta"
from = 1.0
to = 1.4
stability = true
[continuation]
stop_at = [1.1, 1.2, 1.25, 1.3]
)");
  const TracedBranch traced = trace(input.branches.front()).front();
  problems::VerifyOptions options;
  options.samples = 0;
  int compared = 0;
  for (const auto& one :
       problems::verify(traced.request->problem.system, traced.base.harmonics, traced.branch, options)) {
    const BranchPoint& point = traced.branch.points[one.point];
    if (point.type != PointType::user) continue;
    CAPTURE(point.parameters(0));
    CHECK_THAT(one.growth, WithinAbs(observed(traced, point, "growth"), 1e-4));
    CHECK(one.growth < 0.8);
    ++compared;
  }
  CHECK(compared == 4);
}

TEST_CASE("Sectors without a contact neither stick nor slip", "[cases]") {
  const Case input = case_texts::read_text(R"([system]
model = "beams"
wave_number = 1
elements = 8
mass_ratio = 5.0
frequency_ratio = 4.0
slenderness = 33.3
damping = { base = 1e-4, damper = 1e-4 }
force = 1.0
preload = 0.1
[ring]
missing = [2, 4, 6, 8]
[branch]
parameter = "eta"
from = 3.5
to = 4.2
extrema_of = ["Y_max"]
)");
  const TracedBranch traced = trace(input.branches.front()).front();
  double most = 0;
  for (const BranchPoint& point : traced.branch.points)
    most = std::max(most, observed(traced, point, "slipping"));
  CHECK(most == 1);
  const std::string rows = sector_rows(0, traced);
  for (const int sector : {2, 4, 6, 8})
    CHECK(rows.find(fmt::format(",{},1,none,", sector)) != std::string::npos);
  CHECK(rows.find(",1,1,none,") == std::string::npos);
  CHECK(rows.find(",1,1,slip,") != std::string::npos);
}
