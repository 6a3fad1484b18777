// The tables [[element]] of a case file, and parameters of the system that are continued.

#include <nlohmann/json.hpp>

#include "arcslip/assembly/coordinates.hpp"
#include "case_texts.hpp"
#include "catch.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

const std::string& system_text = case_texts::rods_under_force;
const std::string stops_text =
    "[[element]]\nkind = \"clearance\"\nat = \"base\"\nstiffness = 24\ngap = 0.5\n\n";
const std::string branch_text = "[branch]\nparameter = \"eta\"\nfrom = 0.5\nto = 5.0\n";
const std::string over_force = replaced(branch_text, "\"eta\"", "\"F\"") + "eta = 1.5\n";

}  // namespace

TEST_CASE("Elements are read from their tables, with forces of one node") {
  const Case input = case_texts::read_text(system_text + stops_text + stops_text + branch_text);
  const SystemParameters& system = input.branches[0].problem.system;
  REQUIRE(system.others.size() == 2);
  CHECK(system.others[1].kind->name == "clearance");
  CHECK(system.others[1].settings == std::vector<double>{24, 0.5});
  CHECK(input.resolved["element"][0]["contact"] == 1);
  const std::vector<Coordinate> all = other_coordinates(system, [](const Coordinate&) { return 1.0; });
  REQUIRE(all.size() == 2);
  CHECK(all[0].base == 1);
  CHECK(all[0].damper == 0);
  CHECK(all[0].element->reference_stiffness() == 2);  // 24/N
  CHECK(all[0].element->threshold(1) == 0.5);
}

TEST_CASE("Wrong elements and parameters are refused by name, with what is allowed") {
  const auto wrong = [](const std::string& from, const std::string& to) {
    return case_texts::error_of(replaced(system_text + stops_text + branch_text, from, to));
  };
  CHECK_THAT(wrong("clearance", "clearence"),
             ContainsSubstring(":12:8: element[0].kind: expected \"clearance\" or \"cubic\""));
  CHECK_THAT(wrong("gap = 0.5\n", ""),
             ContainsSubstring("element[0].gap: missing; expected a finite number > 0"));
  CHECK_THAT(wrong("gap = 0.5", "gap = -1"),
             ContainsSubstring("element[0].gap: expected a finite number > 0, got -1"));
  CHECK_THAT(wrong("gap", "gab"), ContainsSubstring("did you mean 'gap'?"));
  CHECK_THAT(wrong("\"base\"", "\"hub\""), ContainsSubstring("element[0].at: expected"));
  CHECK_THAT(wrong("gap = 0.5", "gap = 0.5\ncontact = 2"),
             ContainsSubstring("element[0].contact: expected a contact from 1 to 1, got 2"));
  CHECK_THAT(wrong("[[element]]", "[element]"),
             ContainsSubstring("element: expected tables [[element]], got a table"));
  CHECK_THAT(replaced(stops_text, "base", "damper"), ContainsSubstring("damper"));
  CHECK_THAT(case_texts::error_of(replaced(system_text, "preload", "fixed_damper = true\npreload") +
                                  replaced(stops_text, "base", "damper") + branch_text),
             ContainsSubstring("element[0].at: there is no damper that moves"));
  CHECK_THAT(case_texts::error_of("[system]\nmodel = \"ab\"\n" + stops_text +
                                  "[branch]\nparameter = \"p1\"\nfrom = 0\n"
                                  "to = 1\n"),
             ContainsSubstring("element: only for systems with friction"));
}

TEST_CASE("A parameter of the system may be continued in place of eta and P") {
  const CaseBranch branch = case_texts::read_text(system_text + over_force).branches[0];
  CHECK(branch.problem.system.varied == "F");
  CHECK(branch.problem.eta == 1.5);
  CHECK_THAT(
      case_texts::error_of(system_text + over_force + "stability = true\nfor_each = { force = [1, 2] }\n"),
      ContainsSubstring("force cannot be listed where F is the continuation parameter"));
  CHECK_THAT(
      case_texts::error_of(system_text + replaced(over_force, "\"F\"", "\"K_FD\"") + "stability = true\n"),
      ContainsSubstring("branch.stability: over eta, P and F, not over K_FD"));
  CHECK_THAT(case_texts::error_of(system_text + replaced(over_force, "from = 0.5", "from = -0.5")),
             ContainsSubstring("branch.from: expected a finite number > 0, got -0.5"));
  CHECK_THAT(case_texts::error_of(system_text + "[branch]\ncurve = \"fold\"\nparameters = [\"K_FD\", \"F\"]\n"
                                                "window = [10, 50]\nfrom = 0.5\nto = 2\n"),
             ContainsSubstring("branch.parameters: expected \"eta\" or \"P\" as one of them"));
}
