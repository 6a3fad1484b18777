// Curves of peaks and troughs beside friction that lifts off and further contacts that slip: their points are
// extremes of responses. Responses with even harmonics where odd ones suffice.

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "branches.hpp"
#include "case_runs.hpp"
#include "catch.hpp"
#include "draws.hpp"
#include "small_structures.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

/// On the first mass as the second one presses it, or on the third.
std::string rubbing(RandomSystems& draw, const char* name, int contact) {
  return fmt::format(
      "\n[[element]]\nkind = \"friction\"\nname = \"{}\"\nat = \"base\"\ncontact = {}\nnormal = 2\n"
      "tangential_stiffness = {}\nnormal_stiffness = {}\nmu = {}\nnormal_per_preload = 1.0\n",
      name, contact, draw.uniform(0.3, 1), draw.uniform(0.2, 1), draw.uniform(0.2, 0.6));
}

}  // namespace

TEST_CASE("Curves of peaks beside friction that lifts off and further contacts pass extremes of responses",
          "[even][numbers]") {
  RandomSystems draw(11);
  const TemporaryFolder folder;
  const std::vector<double> preloads{0.8, 1.6};
  int traced = 0, complete = 0, passed = 0;
  for (int i = 0; i < 8; ++i) {
    CAPTURE(i);
    SmallStructure s = random_structure(draw);
    if (i % 2 == 0) s.contact_stiffness[2] = draw.uniform(0.3, 1);
    write_matrices(s, folder);
    const std::string elements =
        rubbing(draw, "first", 1) + (i % 2 == 0 ? std::string() : rubbing(draw, "second", 3));
    const auto path = [&](double preload, const std::string& branch) {
      s.preload = preload;
      return folder.write("case.toml", small_system_text(s, "3") + elements + "\n[branch]\n" + branch);
    };
    const Case curves =
        read_case(path(1,
                       "curve = \"peak\"\nparameters = [\"eta\", \"P\"]\nwindow = [0.1, 0.4]\n"
                       "from = 0.5\nto = 3.0\n[continuation]\nstop_at = [0.8, 1.6]\n"));
    std::vector<Case> responses;
    std::vector<TracedBranch> at_preloads;
    for (const double preload : preloads) {
      responses.push_back(read_case(path(preload, "parameter = \"eta\"\nfrom = 0.1\nto = 0.4\n")));
      at_preloads.push_back(std::move(trace(responses.back().branches.front()).front()));
    }
    for (const TracedBranch& curve : trace(curves.branches.front())) {
      ++traced;
      complete += curve.branch.complete();
      CHECK((curve.branch.complete() || !curve.branch.explanation.empty()));
      for (const BranchPoint& point : of_type(curve.branch, PointType::user)) {
        const continuation::BasePoint at = curve.curve->split(point.unknowns, point.parameters, point.regime);
        const std::size_t which = at.parameters(1) < 1 ? 0 : 1;
        REQUIRE_THAT(at.parameters(1), WithinRel(preloads[which], 1e-12));
        double nearest = 1;
        for (const BranchPoint& extreme : at_preloads[which].branch.points) {
          if (extreme.type == PointType::peak || extreme.type == PointType::trough)
            nearest = std::min(nearest, std::abs(extreme.parameters(0) / at.parameters(0) - 1));
        }
        CHECK(nearest < 1e-7);
        ++passed;
      }
    }
  }
  CHECK(traced > 16);
  CHECK(complete > 0.9 * traced);
  CHECK(passed > 24);
}

TEST_CASE("Even harmonics leave an odd response what it is, also where another one leaves it on a corner",
          "[even]") {
  const Settings range{"branch.from=0.235", "branch.to=0.26"};
  const Run odd("nlvib_jenkins", range);
  Settings with_even = range;
  with_even.emplace_back("system.even_harmonics=true");
  const Run even("nlvib_jenkins", with_even);
  REQUIRE(odd.traced.size() == 1);
  REQUIRE(even.traced.size() == 1);
  CAPTURE(even.traced[0].branch.explanation);
  REQUIRE(odd.traced[0].branch.complete());
  REQUIRE(even.traced[0].branch.complete());
  const auto eta = [](const BranchPoint& point) { return point.parameters(0); };
  // a further slip begins there, forwards and backwards
  const auto slips = points(odd.traced[0], PointType::event);
  const auto leaving = points(even.traced[0], PointType::branch_point);
  REQUIRE(slips.size() == 1);
  REQUIRE(leaving.size() == 2);
  CHECK_THAT(eta(leaving[0]), WithinRel(eta(slips[0]), 1e-10));
  CHECK(points(odd.traced[0], PointType::branch_point).empty());
  for (const PointType type : {PointType::fold, PointType::trough, PointType::end}) {
    const auto expected = points(odd.traced[0], type), found = points(even.traced[0], type);
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      CHECK_THAT(eta(found[i]), WithinRel(eta(expected[i]), 1e-10));
      CHECK_THAT(value(even.traced[0], found[i], "Y"),
                 WithinRel(value(odd.traced[0], expected[i], "Y"), 1e-7));
    }
  }
}
