// Case files of studies.

#include "arcslip/cases/study_case.hpp"

#include <chrono>
#include <set>
#include <thread>

#include "case_texts.hpp"
#include "catch.hpp"

using namespace arcslip;
using arcslip::testing::Mistake;
using arcslip::testing::replaced;
using arcslip::testing::TemporaryFolder;
using arcslip::testing::case_texts::read_study_text;

namespace {

const std::string good_study = "title = \"A study\"\n" + testing::case_texts::beams + R"(
[study]
parameter = "P"
from = 0.1
to = 100.0
eta = [0.5, 6.0]
)";

std::string error_of_study(const std::string& text) {
  return testing::error_of([&] { read_study_text(text); });
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

TEST_CASE("A study is read with its defaults, of one design where nothing is listed", "[study]") {
  const StudyCase study = read_study_text(good_study + "[continuation]\nstop_at = [1, 10]\n");
  CHECK(study.title == "A study");
  CHECK(study.range.from == 0.1);
  CHECK(study.range.to == 100);
  CHECK(study.range.eta_low == 0.5);
  CHECK(study.range.eta_high == 6);
  CHECK(study.range.stop_at == std::vector<double>{1, 10});
  CHECK(study.options.tolerance == 1e-10);
  CHECK(study.sweep);
  CHECK(study.keys.empty());
  REQUIRE(study.count == 1);
  CHECK(study.design(0).values.empty());
  CHECK(study.design(0).system.wave_number == 2);
  CHECK(study.design(0).system.interface_stiffness == shear_interface_stiffness(33.3, 0.3));
  CHECK(study.resolved["study"]["sweep"] == true);
  CHECK(study.resolved["system"]["damping"]["base"] == 1e-4);
}

TEST_CASE("No branch of a study ends before its window does", "[study]") {
  const StudyCase study =
      read_study_text(good_study + "[continuation]\nstop_after = \"peak\"\nmax_seconds = 60\n");
  CHECK(study.options.stop_after.empty());
  CHECK(study.options.max_seconds == 60);
}

TEST_CASE("Lists of a study are combined, the last key of the file fastest", "[study]") {
  const StudyCase study = read_study_text(
      good_study +
      "for_each = { slenderness = [8, 12.5], mass_ratio = [5, 10, 20], fixed_damper = [false, true] }\n");
  CHECK(study.keys == std::vector<std::string>{"slenderness", "mass_ratio", "fixed_damper"});
  REQUIRE(study.count == 12);
  std::size_t index = 0;
  for (const double slenderness : {8.0, 12.5}) {
    for (const double mass_ratio : {5.0, 10.0, 20.0}) {
      for (const bool fixed : {false, true}) {
        const StudyDesign design = study.design(index++);
        CHECK(design.system.interface_stiffness == shear_interface_stiffness(slenderness, 0.3));
        CHECK(design.system.mass_ratio == mass_ratio);
        CHECK(design.system.fixed_damper == fixed);
        CHECK(design.values["mass_ratio"] == mass_ratio);
      }
    }
  }
  CHECK(describe(study.design(3).values) == "slenderness = 8, mass_ratio = 10, fixed_damper = true");
}

TEST_CASE("Ranges give their ends exactly and are even, or even in the logarithm", "[study]") {
  const StudyCase linear =
      read_study_text(good_study + "for_each.mass_ratio = { from = 3.0, to = 1.0, count = 5 }\n");
  REQUIRE(linear.count == 5);
  for (std::size_t i = 0; i < 5; ++i)
    CHECK(linear.design(i).system.mass_ratio == 3 - 0.5 * static_cast<double>(i));

  const StudyCase log = read_study_text(
      good_study + "for_each.mass_ratio = { from = 0.1, to = 1000, count = 5, scale = \"log\" }\n");
  CHECK(log.design(0).system.mass_ratio == 0.1);
  CHECK(log.design(4).system.mass_ratio == 1000);
  for (std::size_t i = 1; i < 5; ++i) {
    // Two roundings in the ratio, one in the power.
    CHECK_THAT(log.design(i).system.mass_ratio / log.design(i - 1).system.mass_ratio, WithinRel(10, 1e-14));
  }

  const StudyCase waves =
      read_study_text(good_study + "for_each.wave_number = { from = 1, to = 14, count = 14 }\n");
  REQUIRE(waves.count == 14);
  CHECK(waves.design(6).system.wave_number == 7);
  CHECK(waves.design(6).values["wave_number"] == 7);
}

TEST_CASE("Designs may be listed one by one", "[study]") {
  const StudyCase study = read_study_text(good_study +
                                          "for_each = [{ frequency_ratio = 1.0, slenderness = 8.3 },\n"
                                          "            { slenderness = 33.3, frequency_ratio = 4.0 }]\n");
  CHECK(study.keys == std::vector<std::string>{"frequency_ratio", "slenderness"});
  REQUIRE(study.count == 2);
  CHECK(study.design(0).system.interface_stiffness == shear_interface_stiffness(8.3, 0.3));
  CHECK(study.design(1).system.frequency_ratio == 4);
  CHECK(describe(study.design(1).values) == "frequency_ratio = 4.0, slenderness = 33.3");
  const StudyCase sections = read_study_text(
      good_study + "[[study.for_each]]\nmass_ratio = 1\n[[study.for_each]]\nmass_ratio = 2\n");
  CHECK(sections.design(1).system.mass_ratio == 2);
}

TEST_CASE("A case may hold a study beside its branches, and each command reads its own", "[study]") {
  const std::string both = replaced(good_study, "force = 1.0", "force = 1.0\npreload = 1.0") +
                           "[branch]\nparameter = \"eta\"\nfrom = 0.5\nto = 6.0\n";
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", both);
  CHECK(read_case(path).branches.size() == 1);
  const StudyCase study = read_study(path);
  CHECK(study.count == 1);
  CHECK_FALSE(study.resolved.contains("branch"));  // another branch does not make it another study
  CHECK(has_section(path, "study"));
  CHECK_FALSE(has_section(path, "studies"));
  CHECK_THAT(testing::error_of([&] { read_case(folder.write("other.toml", good_study)); }),
             ContainsSubstring("other.toml:1:1: branch: missing; expected a section [branch]"));
}

TEST_CASE("Wrong studies are refused in one line with place, key, what was expected and given", "[study]") {
  const Mistake mistakes[] = {
      {"[study]", "[studi]", "", "studi", "did you mean 'study'?", ""},
      {good_study.substr(good_study.find("[study]")), "", ":1:1", "study",
       "missing; expected a section [study]", ""},
      {"parameter = \"P\"", "parameter = \"eta\"", ":12:13", "study.parameter", "\"P\"", "got \"eta\""},
      {"parameter = \"P\"\n", "", ":11:1", "study.parameter", "missing; expected \"P\"", ""},
      {"from = 0.1", "from = 0", ":13:8", "study.from", "a finite number > 0", "got 0"},
      {"to = 100.0", "to = 0.1", ":14:6", "study.to", "a finite number > study.from = 0.1", "got 0.1"},
      {"eta = [0.5, 6.0]", "eta = [6.0, 0.5]", ":15:7", "study.eta", "two numbers, 0 < low < high",
       "an array"},
      {"eta = [0.5, 6.0]", "eta = [0.5]", ":15:7", "study.eta", "two numbers, 0 < low < high", "an array"},
      {"eta = [0.5, 6.0]", "eta = [0, 6.0]", ":15:8", "study.eta[0]", "a finite number > 0", "got 0"},
      {"eta = [0.5, 6.0]", "eta = 4", ":15:7", "study.eta", "an array of numbers", "got 4"},
      {"eta = [0.5, 6.0]\n", "", ":11:1", "study.eta", "missing; expected two numbers", ""},
      {"eta = [0.5, 6.0]", "eta = [0.5, 6.0]\nsweep = 1", ":16:9", "study.sweep", "true or false", "got 1"},
      {"eta = [", "etta = [", ":15:8", "study.etta", "did you mean 'eta'?", ""},
      {"\"beams\"", "\"bratu\"", ":3:9", "system.model", "\"rods\" or \"beams\"", "got \"bratu\""},
      {"force = 1.0", "force = 1.0\npreload = -1", ":10:11", "system.preload", "> 0", "got -1"},
      {"eta = [0.5, 6.0]", "eta = [0.5, 6.0]\nobjective = \"beta\"", ":16:13", "study.objective", "\"Y\"",
       "got \"beta\""},
      {"eta = [0.5, 6.0]", "eta = [0.5, 6.0]\nobjective = 1", ":16:13", "study.objective", "a string",
       "got 1"},
      {"force = 1.0", "force = 1.0\ndamping = { base = -1e-4 }", ":10:20", "system.damping.base",
       ">= 0 and < 1, as a base that its own motion excites grows without bound", "got -0.0001"},
      {"eta = [0.5, 6.0]", "eta = [0.5, 6.0]\n[continuation]\nstop_at = [1, 200]",
       ":17:", "continuation.stop_at[1]", ">= 0.1 and <= 100", "got 200"},
  };
  for (const Mistake& mistake : mistakes)
    testing::check_message(error_of_study(replaced(good_study, mistake.from, mistake.to)), mistake);
}

TEST_CASE("What for_each may not hold is refused before anything runs", "[study]") {
  const auto for_each = [](const std::string& value, const std::string& key, const std::string& expected,
                           const std::string& given) {
    return Mistake{"eta = [0.5, 6.0]", "eta = [0.5, 6.0]\nfor_each = " + value, ":16:", key, expected, given};
  };
  const Mistake mistakes[] = {
      for_each("3", "study.for_each", "a table", "got 3"),
      for_each("{}", "study.for_each", "a table with at least one key", ""),
      for_each("[]", "study.for_each", "a table of lists, or an array of tables", "got an empty array"),
      for_each("[3]", "study.for_each[0]", "a table with at least one key", "got 3"),
      for_each("[{ mass_ratio = 1 }, { force = 1 }]", "study.for_each[1]",
               "the keys of the first table, mass_ratio; got force", ""),
      for_each("[{ mass_ratio = 1 }, { mass_ratio = 1, force = 1 }]", "study.for_each[1]",
               "the keys of the first table", "got mass_ratio, force"),
      for_each("[{ mass_ratio = 1 }, { mass_ratio = -1 }]", "study.for_each[1].mass_ratio", "> 0", "got -1"),
      for_each("[{ mas_ratio = 1 }]", "study.for_each[0].mas_ratio", "did you mean 'mass_ratio'?", ""),
      for_each("{ eta = [1] }", "study.for_each.eta", "unknown key", ""),
      for_each("{ preload = [1] }", "study.for_each", "preload cannot be listed: P is swept", ""),
      for_each("[{ preload = 1 }]", "study.for_each", "preload cannot be listed: P is swept", ""),
      for_each("{ mass_ratio = 1 }", "study.for_each.mass_ratio",
               "an array with at least one value, or a range { from, to, count }", "got 1"),
      for_each("{ mass_ratio = [1, 2], force = [3, 0] }", "study.for_each.force[1]", "> 0", "got 0"),
      for_each("{ elements = [41, 30], wave_number = [1, 20, 3] }", "study.for_each.elements[1]",
               "> 2 wave_number = 40", "got 30"),
      for_each("{ damping = [{ base = 0.1 }, { base = -0.1 }] }", "study.for_each.damping[1].base",
               ">= 0 and < 1", "got -0.1"),
      for_each("{ cubic_stiffness = [0, true] }", "study.for_each.cubic_stiffness[1]", "a finite number",
               "got true"),
      for_each("{ slenderness = [8], interface_stiffness = [1] }", "study.for_each.interface_stiffness[0]",
               "not both", ""),
      for_each("{ mass_ratio = { from = 1, to = 2 } }", "study.for_each.mass_ratio.count",
               "missing; expected an integer >= 2", ""),
      for_each("{ mass_ratio = { from = 1, to = 2, count = 1 } }", "study.for_each.mass_ratio.count",
               "an integer >= 2 and <= 1e9", "got 1"),
      for_each("{ mass_ratio = { from = 1, to = 1, count = 3 } }", "study.for_each.mass_ratio.to",
               "differs from study.for_each.mass_ratio.from", "got 1"),
      for_each("{ mass_ratio = { from = 0, to = 1, count = 3, scale = \"log\" } }",
               "study.for_each.mass_ratio.from", "> 0", "got 0"),
      for_each("{ mass_ratio = { from = 1, to = 2, count = 3, scale = \"cubic\" } }",
               "study.for_each.mass_ratio.scale", "\"linear\" or \"log\"", "got \"cubic\""),
      for_each("{ mass_ratio = { from = 1, to = 2, steps = 3 } }", "study.for_each.mass_ratio.steps",
               "unknown key", ""),
      for_each("{ mass_ratio = { from = 2, to = -1, count = 3 } }", "study.for_each.mass_ratio[2]", "> 0",
               "got -1"),
      for_each("{ wave_number = { from = 1, to = 4, count = 3 } }", "study.for_each.wave_number[1]",
               "an integer", "got 2.5"),
      for_each("{ mass_ratio = { from = 1, to = 2, count = 100000 }, force = { from = 1, to = 2, count = "
               "100000 } }",
               "study.for_each.force", "with its 100000 values there are more than 1e+09 designs", ""),
  };
  for (const Mistake& mistake : mistakes)
    testing::check_message(error_of_study(replaced(good_study, mistake.from, mistake.to)), mistake);
}

TEST_CASE("Values that for_each of a study takes the place of are checked as well", "[study]") {
  const std::string listed = good_study + "for_each = { mass_ratio = [1, 2], force = [1, 2] }\n";
  read_study_text(listed);
  const Mistake mistakes[] = {
      {"mass_ratio = 5.0", "mass_ratio = -5.0", ":6:14", "system.mass_ratio", "> 0", "got -5"},
      {"force = 1.0", "force = nan", ":9:9", "system.force", "a finite number", "got nan"},
  };
  for (const Mistake& mistake : mistakes)
    testing::check_message(error_of_study(replaced(listed, mistake.from, mistake.to)), mistake);
}

TEST_CASE("A million designs are read at once, and made when they are asked for, by any thread", "[study]") {
  const auto start = std::chrono::steady_clock::now();
  const StudyCase study = read_study_text(
      good_study +
      "for_each = { mass_ratio = { from = 1, to = 100, count = 1000 }, frequency_ratio = { from = 1, to "
      "= 8, count = 1000, scale = \"log\" } }\n");
  CHECK(seconds_since(start) < 2);  // 1e6 designs made and kept would take ten times that
  REQUIRE(study.count == 1'000'000);
  std::set<double> products[2];
  const auto make = [&](std::size_t part) {
    for (std::size_t i = part; i < study.count; i += 9998) {
      const SystemParameters system = study.design(i).system;
      products[part].insert(system.mass_ratio + 1000 * system.frequency_ratio);
    }
  };
  std::jthread other(make, 0);
  make(1);
  other.join();
  CHECK(products[0].size() == 101);
  CHECK(products[1].size() == 101);
  CHECK_THAT(study.design(999'999).system.mass_ratio, WithinRel(100, 1e-15));
  CHECK(study.design(1000).system.frequency_ratio == 1);
}
