// A response surface with its ridge, its folds and their cusp in closed form.

#include "arcslip/continuation/atlas/atlas.hpp"
#include "case_runs.hpp"

using namespace arcslip;
using namespace arcslip::testing;

TEST_CASE("The response surface of a hardening spring has its ridge and its folds where they are known",
          "[cases][atlas]") {
  constexpr double zeta = 0.1;
  const Run run("duffing_surface");
  REQUIRE(run.traced.size() == 1);
  const continuation::Atlas& atlas = *run.traced[0].surface;
  CHECK(atlas.reason == "");
  int cusps = 0;
  REQUIRE(atlas.folds.size() > 10);
  for (const continuation::AtlasFold& fold : atlas.folds) {
    const double square = std::pow(fold.unknowns(0), 2);
    const double away = 1 - std::pow(fold.parameters(0), 2);
    const double backbone = away + 0.75 * square;
    const double damping = 2 * zeta * fold.parameters(0);
    CHECK_THAT(backbone * backbone + 1.5 * square * backbone, WithinRel(-damping * damping, 1e-8));
    if (fold.type != PointType::cusp) continue;
    ++cusps;
    CHECK_THAT(square, WithinRel(-8 * away / 9, 1e-7));
  }
  CHECK(cusps == 1);
  REQUIRE(atlas.ridges.size() > 10);
  for (const continuation::AtlasRidge& ridge : atlas.ridges) {
    CHECK(ridge.type == PointType::peak);
    CHECK_THAT(std::pow(ridge.parameters(0), 2),
               WithinRel(1 + 0.75 * std::pow(ridge.unknowns(0), 2) - 2 * zeta * zeta, 1e-9));
  }
}
