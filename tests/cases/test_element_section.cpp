// The tables [[element]] of a case file, and parameters of the system that are continued.

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "arcslip/assembly/coordinates.hpp"
#include "arcslip/cases/runs.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/problems/response/power_balance.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "branches.hpp"
#include "case_runs.hpp"
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
      ContainsSubstring("branch.stability: over eta, P, F, P_2 and influence, not over K_FD"));
  CHECK_THAT(case_texts::error_of(system_text +
                                  replaced(over_force, "[branch]\n", "[branch]\nresponse = \"one_way\"\n") +
                                  "stability = true\n"),
             ContainsSubstring("branch.stability: not of one-way responses, whose base no disturbance"));
  CHECK_THAT(case_texts::error_of(system_text + "[branch]\nresponse = \"nonlinear_mode\"\nparameter = \"R\"\n"
                                                "eta = 1.5\nfrom = 0.1\nto = 1\nstability = true\n"),
             ContainsSubstring("branch.stability: not of nonlinear modes, which a damping made up for them"));
  CHECK_THAT(case_texts::error_of(system_text + replaced(over_force, "from = 0.5", "from = -0.5")),
             ContainsSubstring("branch.from: expected a finite number > 0, got -0.5"));
  CHECK_THAT(case_texts::error_of(system_text + "[branch]\ncurve = \"fold\"\nparameters = [\"K_FD\", \"F\"]\n"
                                                "window = [10, 50]\nfrom = 0.5\nto = 2\n"),
             ContainsSubstring("branch.parameters: expected \"eta\" or \"P\" as one of them"));
}

TEST_CASE("Settings of an element are continued by its name, or by that of its kind") {
  const std::string named = replaced(stops_text, "kind", "name = \"stops\"\nkind");
  const auto over = [](const std::string& name, const std::string& from) {
    return replaced(replaced(over_force, "\"F\"", "\"" + name + "\""), "from = 0.5", "from = " + from);
  };
  const auto varied = [&](const std::string& elements, const std::string& name) {
    return case_texts::read_text(system_text + elements + over(name, "0.5"))
        .branches[0]
        .problem.system.varied;
  };
  CHECK(varied(named, "stops.gap") == "stops.gap");
  CHECK(varied(stops_text, "clearance.stiffness") == "clearance.stiffness");
  CHECK(varied(stops_text + stops_text, "clearance_2.gap") == "clearance_2.gap");
  const auto wrong = [&](const std::string& elements, const std::string& name, const std::string& from) {
    return case_texts::error_of(system_text + elements + over(name, from));
  };
  CHECK_THAT(
      wrong(named, "clearance.gap", "0.5"),
      ContainsSubstring("branch.parameter: the system has no parameter clearance.gap; it has F, zeta_B") &&
          ContainsSubstring("stops.stiffness, stops.gap"));
  CHECK_THAT(wrong(named, "stops.gap", "-0.5"), ContainsSubstring("branch.from: stops.gap may not be -0.5"));
  CHECK_THAT(wrong(named + named, "stops.gap", "0.5"),
             ContainsSubstring("element[1].name: element 1 has the name stops already"));
  CHECK_THAT(wrong(replaced(named, "\"stops\"", "\"st.ops\""), "stops.gap", "0.5"),
             ContainsSubstring("element[0].name: expected a name of letters, digits and _"));
  CHECK_THAT(wrong(replaced(named, "\"stops\"", "\"contact_2\""), "stops.gap", "0.5"),
             ContainsSubstring("that does not begin with contact_, and is not contacts, got \"contact_2\""));
  CHECK_THAT(wrong("", "K_FD_2", "0.5"),
             ContainsSubstring("branch.parameter: the system has no parameter K_FD_2"));
  CHECK(varied("", "P_2") == "P_2");
}

TEST_CASE("Modes are continued over parameters of the system at an amplitude, cycles beside zeta_B and P") {
  const std::string mode =
      "[branch]\nresponse = \"nonlinear_mode\"\nparameter = \"K_FD\"\neta = 1.5\nfrom = 1\nto = 2\n";
  CHECK_THAT(case_texts::error_of(system_text + mode), ContainsSubstring("branch.R: missing; expected"));
  const CaseBranch branch = case_texts::read_text(system_text + mode + "R = 0.3\n").branches[0];
  CHECK(branch.problem.R == 0.3);
  CHECK(branch.problem.system.varied == "K_FD");
  const std::string cycle =
      "[branch]\nresponse = \"limit_cycle\"\nparameter = \"zeta_D\"\nfrom = 0.1\nto = 0.2\n";
  CHECK(case_texts::read_text(system_text + cycle).branches[0].problem.system.varied == "zeta_D");
  CHECK_THAT(case_texts::error_of(system_text + replaced(cycle, "zeta_D", "F")),
             ContainsSubstring("branch.parameter: expected \"zeta_B\" or \"P\""));
}

TEST_CASE("A linear spring of an element is one of the structure", "[cases]") {
  const std::string mass =
      "[system]\nmodel = \"spring_mass\"\nbase = { mass = [2.0], stiffness = [3.0] }\n"
      "contact_stiffness = 1.5\nlimit_per_preload = 0.8\npreload = 0.5\nforce = 1.2\nharmonics = 5\n"
      "damping_kind = \"structural\"\ndamping = { base = 0.02 }\n";
  const double spring = GENERATE(-1.0, 4.0, 300.0);
  const std::string element =
      fmt::format("[[element]]\nkind = \"polynomial\"\nat = \"base\"\nlinear = {}\n", spring);
  std::string stiffer = replaced(mass, "[3.0]", fmt::format("[{}]", 3 + spring));
  stiffer = replaced(stiffer, "0.02", fmt::format("{:.17g}", 0.02 * 3 / (3 + spring)));  // the same loss
  const std::string branch =
      "[branch]\nparameter = \"eta\"\nfrom = 0.2\nto = 20\n[continuation]\nstop_at = [0.4, 1.2, 1.9, 12.3]\n";
  std::array<std::vector<double>, 2> heights;
  for (const std::size_t which : {std::size_t{0}, std::size_t{1}}) {
    const Case input = case_texts::read_text((which == 0 ? mass + element : stiffer) + branch);
    for (const TracedBranch& one : trace(input.branches[0])) {
      CHECK(one.branch.complete());
      for (const continuation::BranchPoint& point : one.branch.points) {
        if (point.type == continuation::PointType::regular) continue;
        heights[which].push_back(value(one, point, "eta"));
        heights[which].push_back(value(one, point, "Y"));
        heights[which].push_back(value(one, point, "dissipated"));
      }
    }
  }
  REQUIRE(heights[0].size() >= 21);
  REQUIRE(heights[0].size() == heights[1].size());
  for (std::size_t i = 0; i < heights[0].size(); ++i) {
    INFO(i);
    CHECK_THAT(heights[0][i],  // at a switch the loss is rounding
               WithinRel(heights[1][i], 1e-8) || WithinAbs(heights[1][i], 1e-13));
  }
}

TEST_CASE("A dashpot is damping of the structure, in responses, curves of peaks and resonances", "[cases]") {
  const double more = GENERATE(0.003, 0.2);  // of zeta: C = 2 zeta K
  const int highest = GENERATE(1, 5);
  const auto text = [&](double zeta, const std::string& rest) {
    return fmt::format(
               "[system]\nmodel = \"spring_mass\"\nbase = {{ mass = [2.0], stiffness = [3.0] }}\n"
               "contact_stiffness = 1.5\nlimit_per_preload = 0.8\npreload = 0.5\nforce = 1.2\nharmonics = "
               "{}\n"
               "damping_kind = \"viscous\"\ndamping = {{ base = {:.17g} }}\n",
               highest, zeta) +
           rest;
  };
  const std::string dashpot =
      fmt::format("[[element]]\nkind = \"dashpot\"\nat = \"base\"\ndamping = {:.17g}\n", 2 * more * 3);
  const std::string task = GENERATE(
      "[branch]\nparameter = \"eta\"\nfrom = 0.2\nto = 5\nstability = true\n[continuation]\nstop_at = [0.4, "
      "1.2, 1.9]\n",
      "[branch]\ncurve = \"peak\"\nparameters = [\"eta\", \"P\"]\nwindow = [0.8, 2.0]\nfrom = 0.3\nto = 1.5\n"
      "[continuation]\nstop_at = [0.5, 1.0]\n");
  const bool is_curve = task.find("curve") != std::string::npos;
  std::array<std::vector<double>, 2> heights;
  for (const std::size_t which : {std::size_t{0}, std::size_t{1}}) {
    const Case input =
        case_texts::read_text(which == 0 ? text(0.01, dashpot + task) : text(0.01 + more, task));
    for (const TracedBranch& one : trace(input.branches[0])) {
      INFO(one.branch.explanation);
      CHECK(one.branch.complete());
      for (const continuation::BranchPoint& point : one.branch.points) {
        if (point.type == continuation::PointType::regular) continue;
        for (const char* name : {"eta", "P", "Y", "dissipated"})
          heights[which].push_back(value(one, point, name));
        if (!is_curve) heights[which].push_back(value(one, point, "growth"));
      }
      if (is_curve) continue;
      for (const problems::Verification& point : problems::verify(
               input.branches[0].problem.system, one.base.harmonics, one.branch, {.samples = 0})) {
        if (one.branch.points[point.point].type == continuation::PointType::regular) continue;
        heights[which].push_back(point.Y_time);
        CHECK_THAT(point.Y_time, WithinRel(point.Y_harmonics, 1e-5));
      }
    }
  }
  REQUIRE(heights[0].size() >= 12);
  REQUIRE(heights[0].size() == heights[1].size());
  for (std::size_t i = 0; i < heights[0].size(); ++i) {
    INFO(i);
    CHECK_THAT(heights[0][i], WithinRel(heights[1][i], 1e-8));
  }
}

TEST_CASE("Microslip takes part in branches, studies and derivatives, and is refused where it has no law") {
  const std::string masses =
      "[system]\nmodel = \"spring_mass\"\nbase = { mass = [1.0], stiffness = [1.0] }\ncontact_stiffness = "
      "0.2\n"
      "preload = 0.5\ndamping = { base = 0.01 }\nharmonics = 5\n\n";
  const std::string iwan = "[[element]]\nkind = \"iwan\"\nat = \"base\"\nstiffness = 0.5\nspread = 1.0\n\n";
  const std::string text = masses + iwan + branch_text;
  const std::vector<TracedBranch> traced = trace(case_texts::read_text(text).branches[0]);
  const continuation::Branch& branch = traced.front().branch;
  REQUIRE(branch.complete());
  const auto& problem = dynamic_cast<const problems::HarmonicResponse&>(*traced.front().base.problem);
  for (const continuation::BranchPoint& point : branch.points) {
    CHECK(problems::power_balance(problem, point.unknowns, point.parameters, point.regime).error() < 1e-10);
  }
  const continuation::BranchPoint& some = branch.points[branch.points.size() / 3];
  CHECK(continuation::check_derivatives(problem, some.unknowns, some.parameters, some.regime).worst < 1e-7);
  // a spread of nothing is one more contact of its stiffness and limit
  const auto peak = [](const std::string& case_text) {
    const std::vector<TracedBranch> all = trace(case_texts::read_text(case_text).branches[0]);
    return of_type(all.front().branch, continuation::PointType::peak).at(0).parameters(0);
  };
  const std::string narrow = replaced(iwan, "spread = 1.0", "first_limit = 1.0\nspread = 1e-7");
  const std::string nothing = replaced(iwan, "0.5", "1e-12");
  CHECK_THAT(
      peak(masses + replaced(narrow, "0.5", "0.2") + branch_text),
      WithinRel(peak(replaced(masses, "0.2", "0.4\nlimit_per_preload = 2") + nothing + branch_text), 1e-7));
  CHECK_NOTHROW(case_texts::read_text(text + "stability = true\n"));
}
