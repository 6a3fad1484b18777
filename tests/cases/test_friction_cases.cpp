// The case files of systems with friction against second methods.

#include <numbers>
#include <string>
#include <vector>

#include "case_runs.hpp"

using namespace arcslip;
using namespace arcslip::testing;

TEST_CASE("Preload takes the folds of the rods on hardening springs away", "[cases]") {
  // The same folds as those of a scan over R in tests/test_friction_folds.cpp.
  const Run run("cubic_response");
  REQUIRE(run.traced.size() == 5);
  check(run.traced[0], PointType::fold, {{{"eta", 5.04621820}}, {{"eta", 4.18805203}}});
  check(run.traced[1], PointType::fold, {{{"eta", 4.65636307}}, {{"eta", 4.18165880}}});
  check(run.traced[2], PointType::fold, {{{"eta", 4.17135586}}, {{"eta", 4.14370809}}});
  for (const int i : {3, 4}) check(run.traced[i], PointType::fold, {});
}

TEST_CASE("The curve of folds of the rods on springs passes the response's folds and ends them in a cusp",
          "[cases]") {
  const Run curve("cubic_fold_curve", {"continuation.stop_at=[0.1, 0.6]"});
  REQUIRE(curve.traced.size() == 1);
  std::vector<double> etas;
  for (const BranchPoint& point : points(curve.traced[0], PointType::user))
    etas.push_back(value(curve.traced[0], point, "eta"));
  std::sort(etas.begin(), etas.end());
  const double expected[] = {4.14370809, 4.17135586, 4.18805203, 5.04621820};
  REQUIRE(etas.size() == std::size(expected));
  for (std::size_t i = 0; i < etas.size(); ++i) CHECK_THAT(etas[i], WithinRel(expected[i], published));

  const auto cusps = points(curve.traced[0], PointType::cusp);
  REQUIRE(cusps.size() == 1);
  const double preload = value(curve.traced[0], cusps[0], "P");
  // Near the cusp the folds are as far apart as the distance to it to the power of 3/2: 1e-5 here.
  for (const double side : {0.999, 1.001}) {
    const Run response("cubic_response", {preload_of(side * preload)});
    CHECK(count(response.traced[0], PointType::fold) == (side < 1 ? 2 : 0));
  }
}

TEST_CASE("Beams with negative damping fold four times, as many as the case says", "[cases]") {
  // As measured, to the digits printed; tests/test_friction_folds.cpp has the scan for such systems.
  const Run run("negative_damping");
  check(run.traced[0], PointType::fold,
        {{{"eta", 3.46962738}}, {{"eta", 3.46833138}}, {{"eta", 4.03550548}}, {{"eta", 3.92175578}}});
}

TEST_CASE("The limit cycle's case folds at R = 2S, with zeta_B = -k a/(2 pi eta_1^2)", "[cases]") {
  const Run run("limit_cycle");
  const FrictionSystem system = build_system(run.input.branches[0].problem.system);
  const Mode mode = system.base.modes().at(0);
  const double zeta =
      -system.contact_stiffness * mode.residue / (2 * std::numbers::pi * mode.frequency * mode.frequency);
  check(run.traced[0], PointType::fold, {{{"zeta_B", zeta}}}, 1e-12);  // stationary, so that all digits hold
  check(run.traced[0], PointType::fold, {{{"zeta_B", -0.00505776343777}, {"R_over_S", 2}}});
}

TEST_CASE("A preload that grows with the speed changes stick and slip where R = S, without folds",
          "[cases]") {
  const Run run("speed_preload");
  check(run.traced[0], PointType::fold, {});
  check(run.traced[0], PointType::regime_switch,
        {{{"eta", 3.49013911}}, {{"eta", 3.85596802}}, {{"eta", 93.48341472}}, {{"eta", 93.50124173}}});
  for (const BranchPoint& point : points(run.traced[0], PointType::regime_switch)) {
    const double eta = value(run.traced[0], point, "eta");
    // S = (P + P_2 eta^2) K*/K_FD
    const double threshold = (0.2 + 0.1 * eta * eta) * 80 / shear_interface_stiffness(33.3, 0.3);
    CHECK_THAT(value(run.traced[0], point, "R"), WithinRel(threshold, 1e-10));
  }
}

TEST_CASE("The ridge's trough is the optimum preload: the peak of the response is higher on either side",
          "[cases]") {
  const Run ridge("ridge");
  REQUIRE(ridge.traced.size() == 3);
  const auto troughs = points(ridge.traced[1], PointType::trough);
  REQUIRE(troughs.size() == 1);
  const double preload = value(ridge.traced[1], troughs[0], "P");
  const double least = value(ridge.traced[1], troughs[0], "Y");
  const auto highest = [](double at) {
    const Run response("figure_8", {preload_of(at)});
    double best = 0;
    for (const BranchPoint& peak : points(response.traced[0], PointType::peak))
      best = std::max(best, value(response.traced[0], peak, "Y"));
    return best;
  };
  CHECK_THAT(highest(preload), WithinRel(least, published));
  CHECK(highest(0.999 * preload) > least);
  CHECK(highest(1.001 * preload) > least);
}

TEST_CASE("Where a ridge turns over the preload the response has one peak more or fewer", "[cases]") {
  const Run ridge("ridge");
  const auto folds = points(ridge.traced[1], PointType::fold);
  REQUIRE(folds.size() == 1);
  const double preload = value(ridge.traced[1], folds[0], "P");
  const auto peaks = [&](double side) {
    const Run response("figure_8", {preload_of(side * preload)});
    return count(response.traced[0], PointType::peak);
  };
  CHECK(peaks(0.999) == peaks(1.001) + 1);
}

TEST_CASE("Where the border of stick turns over the preload the response has two switches more or fewer",
          "[cases]") {
  const Run border("border");
  REQUIRE(border.traced.size() == 3);
  const auto folds = points(border.traced[1], PointType::fold);
  REQUIRE(folds.size() == 1);
  const double preload = value(border.traced[1], folds[0], "P");
  const auto switches = [&](double side) {
    const Run response("figure_8", {preload_of(side * preload)});
    return count(response.traced[0], PointType::regime_switch);
  };
  CHECK(switches(0.999) == 1);
  CHECK(switches(1.001) == 3);
  for (const TracedBranch& one : border.traced) {
    for (const BranchPoint& point : one.branch.points)
      CHECK_THAT(value(one, point, "R_over_S"), WithinRel(1, 1e-9));
  }
}

TEST_CASE("Stops open the folds that their case tells, and the least force that folds is a cusp", "[cases]") {
  const Run stops("stops");
  check(stops.traced[0], PointType::fold, {{{"eta", 1.78175367}}, {{"eta", 1.63950823}}});
  const Run curve("force_fold_curve");
  const auto cusps = points(curve.traced[0], PointType::cusp);
  REQUIRE(cusps.size() == 1);
  CHECK_THAT(value(curve.traced[0], cusps[0], "F"), WithinRel(0.12264984297815, 1e-8));
}

TEST_CASE("The backbone has its highest frequency where the contact lets go, then its lowest", "[cases]") {
  const Run backbone("backbone");
  REQUIRE(backbone.traced.size() == 1);
  const TracedBranch& curve = backbone.traced[0];
  check(curve, PointType::regime_switch, {{{"eta", 1.74507173}, {"F", 0.00468185962}}});
  check(curve, PointType::trough, {{{"eta", 1.52096643}, {"F", 0.740667911}}});
  for (const BranchPoint& point : curve.branch.points)
    CHECK_THAT(value(curve, point, "lag"), WithinRel(0.5 * pi, 1e-9));
}

TEST_CASE("Folds over the clearance of stops lie between two cusps, beyond which the response has none",
          "[cases]") {
  const Run curve("stops_gap");
  const auto cusps = points(curve.traced[0], PointType::cusp);
  REQUIRE(cusps.size() == 2);
  std::vector<double> gaps;
  for (const BranchPoint& cusp : cusps) gaps.push_back(value(curve.traced[0], cusp, "stops.gap"));
  std::sort(gaps.begin(), gaps.end());
  CHECK_THAT(gaps[0], WithinRel(0.0858074408, 1e-8));
  CHECK_THAT(gaps[1], WithinRel(1.01630913, 1e-8));
  const std::string response = "branch={ parameter = \"eta\", from = 0.5, to = 5.0 }";
  for (const double gap : {0.99 * gaps[0], 1.01 * gaps[0], 0.99 * gaps[1], 1.01 * gaps[1]}) {
    const Run run("stops_gap",
                  {response, fmt::format("element=[{{ name = \"stops\", kind = \"clearance\", at = "
                                         "\"base\", stiffness = 60.0, gap = {} }}]",
                                         gap)});
    CHECK(count(run.traced[0], PointType::fold) == (gap > gaps[0] && gap < gaps[1] ? 2 : 0));
  }
}

TEST_CASE("A cusp behind a place where the conditions of a fold are renewed is told once", "[cases]") {
  // What tells it has other units from there on.
  std::vector<double> preloads;
  for (const std::string longest : {"0.1", "0.05", "0.031"}) {
    CAPTURE(longest);
    const Run curve("cubic_fold_curve",
                    {"system.mass_ratio=5.923537414035333", "system.frequency_ratio=3.228659370308073",
                     "system.cubic_stiffness=11.316814796557594", "system.force=1.0657765144000926",
                     "continuation.max_step=" + longest});
    const auto cusps = points(curve.traced[0], PointType::cusp);
    REQUIRE(cusps.size() == 1);
    preloads.push_back(value(curve.traced[0], cusps[0], "P"));
  }
  for (const double preload : preloads) CHECK_THAT(preload, WithinRel(preloads.front(), 1e-10));
}
