#include "arcslip/case_file.hpp"
#include "catch.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using arcslip::testing::TemporaryFolder;

namespace {

const std::string good = R"(title = "A case"
[system]
model = "beams"
wave_number = 2
elements = 30
mass_ratio = 5.0
frequency_ratio = 4.0
slenderness = 33.3
force = 1.0
preload = 1.0

[branch]
parameter = "eta"
from = 0.5
to = 120.0
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

Case read_text(const std::string& text, const std::vector<std::string>& settings = {}) {
  const TemporaryFolder folder;
  return read_case(folder.write("case.toml", text), settings);
}

std::string error_of(const std::string& text, const std::vector<std::string>& settings = {}) {
  try {
    read_text(text, settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("A case file is read with its defaults") {
  const Case input = read_text(good);
  CHECK(input.title == "A case");
  REQUIRE(input.branches.size() == 1);
  const SystemParameters& system = input.branches[0].problem.system;
  CHECK(system.model == StructureModel::beams);
  CHECK(system.wave_number == 2);
  CHECK(system.interface_stiffness == shear_interface_stiffness(33.3, 0.3));
  CHECK(system.base_damping == 1e-4);
  CHECK(system.damper_damping == 1e-4);
  CHECK(input.branches[0].options.tolerance == 1e-10);
  CHECK(input.branches[0].options.max_step == 0.1);
  CHECK(input.branches[0].options.min_step == 1e-10);
  CHECK(input.branches[0].options.max_points == 100000);
  CHECK(input.resolved["system"]["damping"]["base"] == 1e-4);
  CHECK(input.resolved["system"]["poisson_ratio"] == 0.3);
  CHECK(input.resolved["continuation"]["max_points"] == 100000);
}

TEST_CASE("for_each gives one branch for each value, and lists of several keys are walked together") {
  const Case one = read_text(good + "for_each = { preload = [0.1, 1, 10.0] }\n");
  REQUIRE(one.branches.size() == 3);
  CHECK(one.branches[1].problem.system.preload == 1);
  CHECK(describe(one.branches[0].values) == "preload = 0.1");

  const Case two = read_text(good + "for_each = { frequency_ratio = [1, 2], slenderness = [8.3, 16.7] }\n");
  REQUIRE(two.branches.size() == 2);
  CHECK(two.branches[1].problem.system.frequency_ratio == 2);
  CHECK(two.branches[1].problem.system.interface_stiffness == shear_interface_stiffness(16.7, 0.3));

  const Case damped = read_text(good + "for_each = { damping = [{ base = 1e-3 }, { damper = 0.01 }] }\n");
  CHECK(damped.branches[0].problem.system.base_damping == 1e-3);
  CHECK(damped.branches[1].problem.system.base_damping == 1e-4);
  CHECK(damped.branches[1].problem.system.damper_damping == 0.01);

  const std::string over_preload =
      replaced(replaced(good, "parameter = \"eta\"", "parameter = \"P\""), "preload = 1.0\n", "");
  const Case sweep = read_text(over_preload + "for_each = { eta = [3.5, 4.0] }\n");
  CHECK(sweep.branches[1].problem.eta == 4.0);
}

TEST_CASE("Settings on the command line replace and add values; bare words need no quotes") {
  const Case input = read_text(good, {"system.preload=7", "continuation.stop_at=[3.9, 4.1]", "title=other",
                                      "system.damping.base=0.01"});
  CHECK(input.branches[0].problem.system.preload == 7);
  CHECK(input.branches[0].options.stop_at == std::vector<double>{3.9, 4.1});
  CHECK(input.title == "other");
  CHECK(input.branches[0].problem.system.base_damping == 0.01);
  CHECK(error_of(good, {"system.preload"}) == "--set system.preload: expected section.key=value");
  CHECK_THAT(error_of(good, {"system.preload=-2"}),
             ContainsSubstring("--set: system.preload: expected") && ContainsSubstring("got -2"));
  CHECK_THAT(error_of(good, {"title.deep=1"}), ContainsSubstring("'title' is not a table"));
  CHECK_THAT(error_of(good, {"system.preload=1 2"}), ContainsSubstring("not a TOML value"));
}

TEST_CASE("Wrong input is refused in one line with place, key, what was expected and what was given") {
  struct Mistake {
    std::string from, to, place, key, expected, given;
  };
  const Mistake mistakes[] = {
      {"preload = 1.0", "preloud = 1.0", ":10:", "system.preloud", "unknown key; did you mean 'preload'?",
       ""},
      {"mass_ratio = 5.0\n", "", ":2:", "system.mass_ratio", "missing; expected a finite number > 0", ""},
      {"mass_ratio = 5.0", "mass_ratio = -5.0", ":6:14", "system.mass_ratio", "a finite number > 0",
       "got -5"},
      {"mass_ratio = 5.0", "mass_ratio = \"5\"", ":6:14", "system.mass_ratio", "a finite number > 0",
       "got \"5\""},
      {"mass_ratio = 5.0", "mass_ratio = nan", ":6:14", "system.mass_ratio", "a finite number > 0",
       "got nan"},
      {"mass_ratio = 5.0", "mass_ratio = inf", ":6:14", "system.mass_ratio", "a finite number > 0",
       "got inf"},
      {"elements = 30", "elements = 4", ":5:12", "system.elements", "> 2 wave_number = 4", "got 4"},
      {"elements = 30", "elements = 30.5", ":5:12", "system.elements", "an integer", "got 30.5"},
      {"wave_number = 2", "wave_number = 0", ":4:15", "system.wave_number", "an integer >= 1", "got 0"},
      {"model = \"beams\"", "model = \"plates\"", ":3:9", "system.model", R"("rods" or "beams" or "ab")",
       "got \"plates\""},
      {"model = \"beams\"", "model = \"rods\"", ":8:15", "system.slenderness", "only for beams", ""},
      {"force = 1.0", "force = 1.0\ninterface_stiffness = 10", ":10:23", "system.interface_stiffness",
       "not both", ""},
      {"force = 1.0", "force = 1.0\npoisson_ratio = 0.7", ":10:17", "system.poisson_ratio", "<= 0.5",
       "got 0.7"},
      {"force = 1.0", "force = 1.0\ndamping = 0.1", ":10:11", "system.damping", "a table", "got 0.1"},
      {"force = 1.0", "force = 1.0\ndamping = { base = -1 }", ":10:20", "system.damping.base",
       "> -1 and < 1 that is not 0", "-1"},
      {"force = 1.0", "force = 1.0\ndamping = { damper = -0.1 }", ":10:22", "system.damping.damper",
       "> 0 and < 1", "-0.1"},
      {"force = 1.0", "force = 1.0\ndamping = { bass = 0.1 }", ":10:20", "system.damping.bass", "unknown key",
       ""},
      {"preload = 1.0\n", "", ":2:", "system.preload", "missing", ""},
      {"to = 120.0", "to = 0.5", ":15:6", "branch.to", "differs from branch.from", "got 0.5"},
      {"from = 0.5", "from = 0", ":14:8", "branch.from", "> 0", "got 0"},
      {"parameter = \"eta\"", "parameter = \"omega\"", ":13:13", "branch.parameter", R"("eta" or "P")",
       "\"omega\""},
      {"parameter = \"eta\"", "parameter = \"P\"", ":12:", "branch.eta", "missing", ""},
      {"to = 120.0", "to = 120.0\neta = 3", ":16:7", "branch.eta", "only where parameter = \"P\"", ""},
      {"to = 120.0", "to = 120.0\nfor_each = {}", ":16:", "branch.for_each", "at least one key",
       "got a table"},
      {"to = 120.0", "to = 120.0\nfor_each = { preload = [] }", ":16:", "branch.for_each.preload",
       "at least one value", "got an empty array"},
      {"to = 120.0", "to = 120.0\nfor_each = { preload = [1, -1] }", ":16:", "branch.for_each.preload[1]",
       "> 0", "got -1"},
      {"to = 120.0", "to = 120.0\nfor_each = { preload = [1], force = [1, 2] }",
       ":16:", "branch.for_each.preload", "as many as", "got 1"},
      {"to = 120.0", "to = 120.0\n[continuation]\nmax_step = 0", ":17:12", "continuation.max_step", "> 0",
       "got 0"},
      {"to = 120.0", "to = 120.0\n[continuation]\nstop_at = [3, 200]", ":17:", "continuation.stop_at[1]",
       ">= 0.5 and <= 120", "got 200"},
      {"to = 120.0", "to = 120.0\n[continuation]\nmax_points = 1", ":17:14", "continuation.max_points",
       ">= 2", "got 1"},
      {"to = 120.0", "to = 120.0\n[contination]\n", ":16:", "contination", "did you mean 'continuation'?",
       ""},
      {"[branch]", "[brunch]", "", "brunch", "did you mean 'branch'?", ""},
      {"title = \"A case\"", "title = 3", ":1:9", "title", "a string", "got 3"},
      {"title = \"A case\"", "title = ", ":1:", "not valid TOML", "", ""},
  };
  for (const Mistake& mistake : mistakes) {
    const std::string message = error_of(replaced(good, mistake.from, mistake.to));
    INFO(message);
    CHECK_THAT(message, ContainsSubstring("case.toml" + mistake.place));
    CHECK_THAT(message, ContainsSubstring(mistake.key) && ContainsSubstring(mistake.expected) &&
                            ContainsSubstring(mistake.given));
    CHECK(message.find('\n') == std::string::npos);
  }
}

TEST_CASE("A case without a section, and a file that cannot be read, are refused") {
  CHECK_THAT(error_of("title = \"nothing\"\n"), ContainsSubstring("expected a section [branch]"));
  CHECK_THAT(error_of(good.substr(good.find("[branch]"))), ContainsSubstring("expected a section [system]"));
  CHECK_THROWS_WITH(read_case("/nowhere/case.toml"),
                    ContainsSubstring("/nowhere/case.toml: cannot be read: No such file"));
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(read_case(folder.path("")), ContainsSubstring("cannot be read: Is a directory"));
}

TEST_CASE("Every case file that comes with the program is valid") {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(ARCSLIP_SOURCE_DIR) + "/problems")) {
    if (entry.path().extension() != ".toml") continue;
    CHECK_NOTHROW(read_case(entry.path().string()));
    CHECK(arcslip::testing::read(entry.path().string()).front() == '#');  // opens with what it shows
    ++count;
  }
  CHECK(count >= 3);
}
