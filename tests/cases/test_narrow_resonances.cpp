// Resonances of stuck contacts that are hardly wider than numbers near one tell apart.

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "case_runs.hpp"
#include "case_texts.hpp"
#include "catch.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

TracedBranch narrow_response(double stiffness, double damping, double longest, const std::string& harmonics) {
  const Case input = case_texts::read_text(fmt::format(
      R"([system]
model = "spring_mass"
base = {{ mass = [2.7], stiffness = [1.0] }}
damper = {{ mass = [1.0], stiffness = [1.7] }}
contact_stiffness = {}
preload = {}
damping = {{ base = 0.01, damper = {} }}
harmonics = {}
[branch]
parameter = "eta"
from = 0.3
to = 4.0
[continuation]
max_step = {}
)",
      stiffness, 1000 * stiffness, damping, harmonics, longest));
  TracedBranch traced = trace(input.branches.front()).front();
  REQUIRE(traced.branch.complete());
  return traced;
}

/// The second of two peaks.
BranchPoint peak_of_damper(const TracedBranch& traced) {
  const auto peaks = points(traced, PointType::peak);
  REQUIRE(peaks.size() == 2);
  return peaks.back();
}

}  // namespace

TEST_CASE("Contacts stick where they are held and slip beyond, however narrow that is", "[cases]") {
  const double stiffness = GENERATE(1e-5, 3e-6);
  const double damping = GENERATE(0.0, 1e-10);
  const double longest = GENERATE(0.03, 0.01);
  CAPTURE(stiffness, damping, longest);
  const TracedBranch traced = narrow_response(stiffness, damping, longest, "1");
  CHECK(count(traced, PointType::regime_switch) == 2);
  for (const BranchPoint& point : traced.branch.points) {
    const double ratio = value(traced, point, "R_over_S");
    CAPTURE(point.parameters(0), ratio);
    if (point.type == PointType::regime_switch) {
      CHECK_THAT(ratio, WithinAbs(1, 1e-9));
    } else {
      const bool slips = traced.problem().describe(point.regime) == "slip";
      CHECK((slips ? ratio >= 1 - 1e-6 : ratio <= 1 + 1e-6));
    }
  }
  const BranchPoint peak = peak_of_damper(traced);
  const TracedBranch balanced = narrow_response(stiffness, damping, longest, "3");
  const BranchPoint other = peak_of_damper(balanced);
  CHECK_THAT(value(traced, peak, "Y"), WithinRel(value(balanced, other, "Y"), 1e-9));
  CHECK_THAT(peak.parameters(0), WithinRel(other.parameters(0), 1e-14));
}
