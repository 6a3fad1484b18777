// Systems given in SI units by a case file.

#include <nlohmann/json.hpp>
#include <numbers>

#include "arcslip/results/results.hpp"
#include "case_runs.hpp"
#include "case_texts.hpp"
#include "round_rings.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

const std::string in_metres = R"([system]
model = "beams"
wave_number = 2
elements = 30

[geometry]
circumference = 2
friction_coefficient = 0.25
preload_per_length = 3000
force_per_length = 50
base = { elastic_modulus = 1e11, density = 8000, width = 0.1, height = 0.04 }
damper = { elastic_modulus = 2e11, density = 4000, poisson_ratio = 0.25, width = 0.05, height = 0.01 }

[branch]
parameter = "eta"
from = 0.5
to = 120.0
)";

}  // namespace

TEST_CASE("A geometry is read from a case file and may be varied by for_each and --set", "[geometry]") {
  const SystemParameters expected = groups_of(round_numbers(), StructureModel::beams);
  const SystemParameters system = case_texts::read_text(in_metres).branches[0].problem.system;
  CHECK(system.mass_ratio == expected.mass_ratio);
  CHECK(system.frequency_ratio == expected.frequency_ratio);
  CHECK(system.interface_stiffness == expected.interface_stiffness);
  CHECK(system.force == expected.force);
  CHECK(system.preload == expected.preload);
  CHECK(system.wave_number == 2);

  const std::string by_radius =
      replaced(in_metres, "circumference = 2", fmt::format("radius = {:.17g}", 1 / pi));
  CHECK_THAT(case_texts::read_text(by_radius).branches[0].problem.system.preload,
             WithinRel(expected.preload, rounding));
  CHECK_THAT(case_texts::read_text(in_metres, {"geometry.preload_per_length=6000"})
                 .branches[0]
                 .problem.system.preload,
             WithinRel(2 * expected.preload, rounding));
  CHECK_THAT(
      case_texts::read_text(in_metres, {"geometry.damper.width=0.1"}).branches[0].problem.system.mass_ratio,
      WithinRel(expected.mass_ratio / 2, rounding));
  CHECK(case_texts::read_text(in_metres, {"system.interface_stiffness=1000"})
            .branches[0]
            .problem.system.interface_stiffness == 1000);

  const std::string key = GENERATE(as<std::string>{}, "damper.width", "\"damper.width\"");
  const Case varied = case_texts::read_text(in_metres + "for_each = { preload_per_length = [3e3, 6e3], " +
                                            key + " = [0.05, 0.1], elements = [30, 40] }\n");
  REQUIRE(varied.branches.size() == 2);
  CHECK(varied.branches[0].problem.system.mass_ratio == expected.mass_ratio);
  CHECK_THAT(varied.branches[1].problem.system.mass_ratio, WithinRel(expected.mass_ratio / 2, rounding));
  CHECK_THAT(varied.branches[1].problem.system.preload, WithinRel(2 * expected.preload, rounding));
  CHECK(varied.branches[1].problem.system.elements == 40);
  CHECK(varied.branches[1].values["damper.width"] == 0.1);
}

TEST_CASE("Where the preload is continued a geometry need not give it", "[geometry]") {
  const std::string over_preload =
      replaced(replaced(in_metres, "parameter = \"eta\"", "parameter = \"P\"\neta = 3"),
               "preload_per_length = 3000\n", "");
  const Case input = case_texts::read_text(over_preload);
  CHECK_FALSE(summarize(input, trace(input.branches[0]), 0)["branches"][0]["groups"].contains("preload"));
  CHECK_THROWS_WITH(case_texts::read_text(over_preload + "for_each = { preload_per_length = [1] }\n"),
                    ContainsSubstring("preload_per_length cannot be listed where P is the continuation"));
}

TEST_CASE("Wrong geometry is refused in one line with place, key, what was expected and given",
          "[geometry]") {
  struct Refusal {
    std::string from, to, message;
  };
  const Refusal mistakes[] = {
      {"elements = 30", "elements = 30\nmass_ratio = 5", ":5:14: system.mass_ratio: not beside [geometry]"},
      {"elements = 30", "elements = 30\nfrequency_ratio = 5", ":5:19: system.frequency_ratio: not beside"},
      {"elements = 30", "elements = 30\nslenderness = 5", ":5:15: system.slenderness: not beside"},
      {"elements = 30", "elements = 30\npoisson_ratio = 0.3", ":5:17: system.poisson_ratio: not beside"},
      {"elements = 30", "elements = 30\nforce = 5", ":5:9: system.force: not beside [geometry]"},
      {"elements = 30", "elements = 30\npreload = 5", ":5:11: system.preload: not beside [geometry]"},
      {"to = 120.0", "to = 120.0\nfor_each = { force = [5] }",
       ":18:23: branch.for_each.force[0]: not beside [geometry]"},
      {"friction_coefficient = 0.25\n", "",
       ":6:1: geometry.friction_coefficient: missing; expected a finite number > 0"},
      {"friction_coefficient = 0.25", "friction_coefficient = 0",
       ":8:24: geometry.friction_coefficient: expected a finite number > 0, got 0"},
      {"preload_per_length = 3000\n", "", ":6:1: geometry.preload_per_length: missing"},
      {"force_per_length = 50", "force_per_length = \"big\"",
       ":10:20: geometry.force_per_length: expected a finite number > 0, got \"big\""},
      {"circumference = 2", "circumference = 2\nradius = 1",
       ":8:10: geometry.radius: expected either circumference or radius"},
      {"circumference = 2", "", ":6:1: geometry.circumference: expected either circumference or radius"},
      {"circumference = 2", "circumfrence = 2", ":7:16: geometry.circumfrence: unknown key; did you mean"},
      {"width = 0.1,", "width = -0.1,",
       ":11:58: geometry.base.width: expected a finite number > 0, got -0.1"},
      {"width = 0.1,", "", ":11:8: geometry.base.width: missing"},
      {"width = 0.1,", "wdith = 0.1,", "geometry.base.wdith: unknown key; did you mean 'width'?"},
      {"poisson_ratio = 0.25", "poisson_ratio = 0.6",
       ":12:68: geometry.damper.poisson_ratio: expected a finite number > -1 and <= 0.5, got 0.6"},
      {"poisson_ratio = 0.25, ", "", ":12:10: geometry.damper.poisson_ratio: missing"},
      {"density = 8000", "density = 8000, poisson_ratio = -1",
       "geometry.base.poisson_ratio: expected a finite number > -1 and <= 0.5, got -1"},
      {"base = {", "bass = {", ":11:8: geometry.bass: unknown key; did you mean 'base'?"},
      {"base = {", "# base = {", ":6:1: geometry.base: missing; expected a table"},
      {"elastic_modulus = 1e11", "elastic_modulus = 1e-310",
       ":6:1: geometry: expected sizes and materials of rings"},
      {"to = 120.0", "to = 120.0\nfor_each = { damper.width = [0.05, 0] }",
       "branch.for_each.damper.width[1]: expected a finite number > 0, got 0"},
      {"to = 120.0", "to = 120.0\nfor_each = { damper.widht = [0.05] }",
       "branch.for_each.damper.widht: unknown key; did you mean 'damper.width'?"},
      {"to = 120.0", "to = 120.0\nfor_each = { damper = [0.05] }", "branch.for_each.damper: unknown key"},
  };
  for (const Refusal& mistake : mistakes) {
    INFO(mistake.to);
    CHECK_THROWS_WITH(case_texts::read_text(replaced(in_metres, mistake.from, mistake.to)),
                      ContainsSubstring(mistake.message));
  }
  const std::string cusp =
      "[geometry]\n[system]\nmodel = \"cusp\"\n[branch]\nparameter = \"mu\"\nfrom = 0\nto = 1\n";
  CHECK_THROWS_WITH(case_texts::read_text(cusp),
                    ContainsSubstring(":1:1: geometry: only for systems with friction"));
  const std::string plain = in_metres.substr(0, in_metres.find("[geometry]")) +
                            in_metres.substr(in_metres.find("[branch]")) +
                            "for_each = { preload_per_length = [1] }\n";
  CHECK_THROWS_WITH(case_texts::read_text(plain),
                    ContainsSubstring("for_each.preload_per_length: unknown key"));
}
