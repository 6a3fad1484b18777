// A pendulum whose support is shaken up and down: it swings in two of its periods, or goes round.

#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

std::vector<TracedBranch> shaken(const std::string& start, const std::string& rest) {
  return traced_of(
      "[model]\nkind = \"forced\"\nperiod = \"2*pi/w\"\nangles = [\"x\"]\nparameters = { p = 1, w = 2 }\n"
      "equations = { x = \"v\", v = \"-0.1*v - (1 + p*cos(w*t))*sin(x)\" }\nstart = " +
      start + "\n" + rest);
}

std::string from_to(const std::string& from, const std::string& to) {
  return "[branch]\nparameter = \"p\"\nfrom = " + from + "\nto = " + to + "\n";
}

}  // namespace

TEST_CASE("A shaken pendulum swings in two periods down to where it hangs stable", "[cycles]") {
  const auto swings = shaken("{ x = 0, v = 2 }", from_to("1", "0.1"));
  REQUIRE(swings.size() == 1);
  const BranchPoint& last = swings[0].branch.points.back();
  CHECK_THAT(value(swings[0], swings[0].branch.points.front(), "T"), WithinAbs(two_pi, 1e-12));
  CHECK(swings[0].branch.stop == Stop::left_regime);
  CHECK_THAT(swings[0].branch.explanation, ContainsSubstring("two rounds of one of half the period"));
  CHECK(value(swings[0], last, "x_max") < 0.01);
  const auto hangs = shaken("{ x = 0, v = 0 }", from_to("0.1", "1"));
  REQUIRE(hangs.size() == 1);
  const auto doublings = values_at(hangs[0], PointType::period_doubling, "p");
  REQUIRE(doublings.size() == 1);
  CHECK_THAT(value(swings[0], last, "p"), WithinAbs(doublings[0], 1e-5));
}

TEST_CASE("A shaken pendulum that goes round doubles its periods, held either way", "[cycles][balance]") {
  const auto all = [](const std::string& cycles) {
    return shaken("{ x = 3, v = 2 }", "[cycles]\nsettle = 800\ntolerance = 1e-9\ndoublings = 2\n" + cycles +
                                          from_to("1", "2") + "switching = true\n");
  };
  const auto on_intervals = all("degree = 7\n");
  REQUIRE(on_intervals.size() == 3);
  CHECK_THAT(value(on_intervals[2], on_intervals[2].branch.points.back(), "p"), WithinAbs(2, 1e-12));
  CHECK_THAT(value(on_intervals[2], on_intervals[2].branch.points.back(), "T"), WithinAbs(4 * pi, 1e-12));
  const auto balanced = all("discretisation = \"balance\"\nharmonics = 16\n");
  const auto doublings = all_values_at(on_intervals, PointType::period_doubling, "p");
  REQUIRE(doublings.size() == 3);
  check_values(all_values_at(balanced, PointType::period_doubling, "p"), doublings, 1e-8);
}
