// Ranges in SI units, and what is said of those that hold nothing.

#include <filesystem>

#include "arcslip/assembly/resonances.hpp"
#include "arcslip/cases/runs.hpp"
#include "case_texts.hpp"
#include "cases/case_warnings.hpp"
#include "cases/design_study.hpp"
#include "catch.hpp"
#include "places.hpp"

using namespace arcslip;
using arcslip::testing::Mistake;
using arcslip::testing::replaced;
using arcslip::testing::TemporaryFolder;
using arcslip::testing::case_texts::read_study_text;
using arcslip::testing::case_texts::read_text;

namespace {

const std::string rotor = R"([system]
model = "beams"
wave_number = 3
elements = 90
damping = { base = 1e-3, damper = 5e-5, kind = "structural" }

[geometry]
radius = 0.13
friction_coefficient = 0.3
force_per_length = 100
preload_per_length = 300
base = { elastic_modulus = 110e9, density = 7200, width = 0.045, height = 0.024 }
damper = { elastic_modulus = 210e9, density = 7850, poisson_ratio = 0.29, width = 0.006, height = 0.004 }

)";

const std::string in_hertz = rotor + R"([branch]
parameter = "frequency_Hz"
from = 1500
to = 5000

[continuation]
stop_at = [2000]
)";

const std::string study = rotor + R"([study]
parameter = "preload_N_per_m"
from = 10
to = 5000
frequency_Hz = [1500, 5000]
)";

const std::string mass = R"([system]
model = "spring_mass"
units = "SI"
base = { mass = [2.0], stiffness = [8e6] }
contact_stiffness = 4e6
limit_per_preload = 0.3
force = 10.0
preload = 30.0

[branch]
parameter = "frequency_Hz"
from = 100
to = 600
)";

std::vector<std::string> warnings_in(const std::string& text) {
  const TemporaryFolder folder;
  const CaseFile file(folder.write("case.toml", text));
  return file.has("study") ? warnings_of(read_study(file)) : warnings_of(plan_case(file));
}

}  // namespace

TEST_CASE("A range in Hz is that in eta, branch by branch", "[units]") {
  const Case found =
      read_text(replaced(in_hertz, "to = 5000\n", "to = 5000\nfor_each = { radius = [0.13, 0.26] }\n"));
  REQUIRE(found.branches.size() == 2);
  for (const CaseBranch& branch : found.branches) {
    const double hertz = branch.problem.physical.value().frequency(1);
    CHECK(branch.options.parameter == "eta");
    CHECK_THAT(branch.options.from * hertz, WithinRel(1500, 1e-14));
    CHECK_THAT(branch.options.to * hertz, WithinRel(5000, 1e-14));
    CHECK_THAT(branch.options.stop_at.at(0) * hertz, WithinRel(2000, 1e-14));
  }
  // Bending frequencies go with 1/L^2.
  CHECK_THAT(found.branches[1].options.from, WithinRel(4 * found.branches[0].options.from, 1e-13));
  CHECK(found.resolved["branch"]["from"] == 1500);
  CHECK(found.resolved["continuation"]["stop_at"][0] == 2000);
}

TEST_CASE("The same branch in Hz and in eta has the same peak", "[units]") {
  const Case hertz = read_text(in_hertz);
  const double unit = hertz.branches[0].problem.physical.value().frequency(1);
  const std::string text = replaced(replaced(in_hertz, "frequency_Hz", "eta"), "stop_at = [2000]", "");
  const Case eta = read_text(
      text, {fmt::format("branch.from={:.17g}", 1500 / unit), fmt::format("branch.to={:.17g}", 5000 / unit)});
  const auto peak = [](const Case& input) {
    const std::vector<TracedBranch> traced = trace(input.branches[0]);
    const auto& points = traced[0].branch.points;
    double highest = 0;
    for (const auto& point : points) {
      if (point.type == continuation::PointType::peak) highest = std::max(highest, point.parameters(0));
    }
    return highest;
  };
  CHECK_THAT(peak(hertz), WithinRel(peak(eta), 1e-10));
}

TEST_CASE("A preload range in N/m, at a fixed frequency in Hz, and a curve in both", "[units]") {
  const Case over_preload = read_text(rotor + R"([branch]
parameter = "preload_N_per_m"
from = 10
to = 5000
for_each = { frequency_Hz = [2200, 2300] }
)");
  REQUIRE(over_preload.branches.size() == 2);
  const PhysicalScale scale = over_preload.branches[1].problem.physical.value();
  CHECK_THAT(scale.frequency(over_preload.branches[1].problem.eta), WithinRel(2300, 1e-14));
  CHECK_THAT(scale.preload(over_preload.branches[1].options.to), WithinRel(5000, 1e-14));

  const Case ridge = read_text(rotor + R"([branch]
curve = "peak"
parameters = ["frequency_Hz", "preload_N_per_m"]
window = [1500, 5000]
from = 10
to = 5000
)");
  const CaseBranch& curve = ridge.branches[0];
  CHECK_THAT(scale.frequency(curve.curve->window.high), WithinRel(5000, 1e-14));
  CHECK_THAT(scale.preload(curve.options.from), WithinRel(10, 1e-14));
  CHECK_THAT(scale.preload(curve.curve->seed), WithinRel(300, 1e-14));
}

TEST_CASE("A study's window and preloads are those of each design", "[units]") {
  const StudyCase found = read_study_text(study + "for_each = { radius = [0.13, 0.26] }\n");
  for (std::size_t i = 0; i < 2; ++i) {
    const StudyDesign design = found.design(i);
    CHECK_THAT(design.physical.value().frequency(design.range.eta_high), WithinRel(5000, 1e-14));
    CHECK_THAT(design.physical.value().preload(design.range.from), WithinRel(10, 1e-14));
  }
  CHECK(found.preload_unit == "N_per_m");
  const StudyCase plain = read_study_text(study);
  const problems::PreloadStudy result = study_preload(plain, plain.design(0));
  REQUIRE(result.optimum);
  CHECK_THAT(plain.design(0).physical->preload(result.optimum->peak.preload), WithinRel(312.551, 1e-5));
}

TEST_CASE("Masses in kg have preloads in N and frequencies in Hz", "[units]") {
  const Case found = read_text(mass);
  const PhysicalScale scale = found.branches[0].problem.physical.value();
  CHECK_THAT(found.branches[0].options.to, WithinRel(600 * 2 * pi, 1e-14));
  CHECK(scale.preload_unit() == std::string("N"));
  CHECK(scale.preload(30) == 30);
  // sqrt(8e6/2) = 2000 rad/s alone, sqrt(12e6/2) stuck.
  const std::vector<Resonance> all = resonances(build_wave(found.branches[0].problem.system));
  REQUIRE(all.size() == 2);
  CHECK_THAT(all[0].eta, WithinRel(2000, 1e-14));
  CHECK_THAT(all[0].damping, WithinRel(1e-4, 1e-12));
  CHECK(all[1].part == "stuck");
  CHECK_THAT(all[1].eta, WithinRel(std::sqrt(6e6), 1e-14));
}

TEST_CASE("Units that a system does not have are refused by name", "[units]") {
  const auto check = [](const std::string& text, const Mistake& mistake) {
    testing::case_texts::check_refused(text, mistake);
  };
  const std::string& good = testing::case_texts::good;
  check(good, {"parameter = \"eta\"", "parameter = \"frequency_Hz\"", "", "branch.parameter", "[geometry]",
               "expected eta"});
  check(in_hertz, {"\"frequency_Hz\"", "\"preload_N\"\nfrequency_Hz = 2300", "", "branch.parameter",
                   "expected preload_N_per_m", "preload_N"});
  check(in_hertz, {"\"frequency_Hz\"", "\"preload_N_per_m\"\neta = 40\nfrequency_Hz = 2300", "",
                   "frequency_Hz", "this or eta", "not both"});
  check(in_hertz,
        {"to = 5000\n", "to = 5000\nfrequency_Hz = 2000\n", "", "frequency_Hz", "fixed only where", "\"P\""});
  check(mass, {"units = \"SI\"", "units = \"US\"", "", "system.units", "\"SI\"", "US"});
  check(mass, {"units = \"SI\"\n", "", "", "branch.parameter", "units = \"SI\"", "expected eta"});
}

TEST_CASE("The preload that locks a contact is where it begins to slip", "[units]") {
  const Case found = read_text(replaced(mass, "parameter = \"frequency_Hz\"\nfrom = 100\nto = 600",
                                        "parameter = \"P\"\nfrequency_Hz = 350\nfrom = 1\nto = 1000"));
  const CaseBranch& branch = found.branches[0];
  const double limit = locking_preload(build_wave(branch.problem.system), {branch.problem.eta});
  const std::vector<TracedBranch> traced = trace(branch);
  int switches = 0;
  for (const auto& point : traced[0].branch.points) {
    if (point.type != continuation::PointType::regime_switch) continue;
    ++switches;
    CHECK_THAT(point.parameters(1), WithinRel(limit, 1e-9));
  }
  CHECK(switches == 1);
}

TEST_CASE("Ranges beside what they are meant for are said, and no others", "[units]") {
  CHECK(warnings_in(in_hertz).empty());
  CHECK(warnings_in(study).empty());
  const auto eta = warnings_in(replaced(in_hertz, "frequency_Hz", "eta"));  // Hz given as eta
  REQUIRE(eta.size() == 1);
  CHECK_THAT(eta[0], ContainsSubstring("no resonance of the base") && ContainsSubstring("2295.2 Hz"));
  const auto preload = warnings_in(replaced(study, "\"preload_N_per_m\"", "\"P\""));  // N/m given as P
  REQUIRE(preload.size() == 1);
  CHECK_THAT(preload[0], ContainsSubstring("no contact slips"));
  const auto beside = warnings_in(replaced(study, "[1500, 5000]", "[2400, 5000]"));
  REQUIRE(beside.size() == 1);
  CHECK_THAT(beside[0], ContainsSubstring("no resonance of the base"));
  const auto some =
      warnings_in(replaced(study, "[1500, 5000]", "[2280, 5000]") + "for_each = { radius = [0.13, 0.26] }\n");
  REQUIRE(some.size() == 1);
  CHECK_THAT(some[0], ContainsSubstring("1 of 2 designs"));
}

TEST_CASE("No case file of the project is warned of", "[units]") {
  int cases = 0;
  for (const auto& entry : std::filesystem::directory_iterator(testing::source_folder() + "/problems")) {
    if (entry.path().extension() != ".toml") continue;
    INFO(entry.path());
    const CaseFile file(entry.path().string());
    if (file.has("study")) CHECK(warnings_of(read_study(file)).empty());
    if (file.has("branch")) CHECK(warnings_of(plan_case(file)).empty());
    ++cases;
  }
  CHECK(cases > 30);
}
