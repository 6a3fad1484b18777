// Branches of cycles on which the parameter all but stands still: relaxation oscillations as they grow, and
// orbits that come near an equilibrium.

#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

}  // namespace

TEST_CASE("Relaxation oscillations that grow at one parameter value are no homoclinic orbits", "[cycles]") {
  // FitzHugh's and Nagumo's nerve: with (v, w, I) so is (-v, 7/4 - w, 7/4 - I) a cycle
  const auto all = traced_of(R"case(
[model.parameters]
I = 0
[model.equations]
v = "v - v^3/3 - w + I"
w = "0.08*(v + 0.7 - 0.8*w)"
[model.start]
v = -1.2
w = -0.62
[branch]
parameter = "I"
from = 0
to = 2
switching = true
)case");
  const auto hopf = all_values_at(all, PointType::hopf, "I");
  REQUIRE(hopf.size() == 2);
  CHECK_THAT(hopf[0] + hopf[1], WithinAbs(1.75, 1e-12));
  const auto found = cycles_of(all);
  REQUIRE(found.size() == 1);
  CHECK(found[0].branch.stop == Stop::left_regime);
  CHECK_THAT(found[0].branch.points.back().parameters(0), WithinAbs(hopf[1], 1e-6));
  const auto folds = all_values_at(found, PointType::fold, "I");
  REQUIRE(folds.size() == 2);
  CHECK_THAT(folds[0] + folds[1], WithinAbs(1.75, 1e-8));
  CHECK_THAT(folds[0], WithinAbs(0.3241785, 1e-7));
}
