// Branches of cycles on which the parameter all but stands still: relaxation oscillations as they grow, and
// orbits that come near an equilibrium.

#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

}  // namespace

TEST_CASE("Relaxation oscillations that grow at one parameter value are no homoclinic orbits", "[cycles]") {
  // FitzHugh's and Nagumo's nerve: with (v, w, I) so is (-v, 7/4 - w, 7/4 - I) a cycle
  const Run run("nerve_cycles");
  const auto& all = run.traced;
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

TEST_CASE("Coupled pendula go round as AUTO-07p has it, to where they come to rest on their way",
          "[cycles][numbers]") {
  const Run run("coupled_pendula");
  const auto all = cycles_of(run.traced);
  REQUIRE(all.size() == 4);
  // AUTO-07p: 0.179163 and 0.331445, 0.175511; all digits by degree 7 on 80 intervals
  check_values(values_at(all[0], PointType::period_doubling, "I"), {0.179163776}, 2e-9);
  check_values(values_at(all[1], PointType::branch_point, "I"), {0.331445241, 0.175511713}, 2e-9);
  check_values(values_at(all[1], PointType::fold, "I"), {0.399074389, 0.158594857}, 2e-9);
  check_values(values_at(all[3], PointType::fold, "I"), {0.173029639, 0.173029639}, 2e-9);
  for (const TracedBranch& one : all) CHECK(one.branch.stop == Stop::infinite_period);
  const BranchPoint& start = all[0].branch.points.front();  // rotations settle turns away from their guess
  CHECK(std::abs(value(all[0], start, "phi_1_max")) < 2 * pi);
}

TEST_CASE("A nerve's cycles fold and double their period next to one another", "[cycles]") {
  const Run run("hodgkin_huxley");
  check_values(all_values_at(run.traced, PointType::hopf, "I"), {9.779338, 154.526334}, 1e-7);
  const auto all = cycles_of(run.traced);
  REQUIRE(all.size() == 1);
  CHECK(all[0].branch.stop == Stop::left_regime);
  // by degree 7 on 80 intervals with a tolerance of 1e-9
  check_values(values_at(all[0], PointType::fold, "I"), {7.84624712, 7.92168549, 6.26422127}, 1e-8);
  check_values(values_at(all[0], PointType::period_doubling, "I"), {7.8492374, 7.92167768}, 1e-8);
}
