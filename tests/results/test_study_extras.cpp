// Studies of designs in SI units and of designs that scatter: case files, tables, the program.

#include <map>
#include <nlohmann/json.hpp>

#include "case_texts.hpp"
#include "catch.hpp"
#include "mistakes.hpp"
#include "places.hpp"
#include "program.hpp"
#include "results/study_run.hpp"
#include "results/study_store.hpp"
#include "study_text.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

const std::string scattered_text = study_text +
                                   "[study.uncertain]\nmu = { lognormal = 0.2 }\n"
                                   "preload = { uniform = [0.8, 1.25] }\nsamples = 200\n";

const std::string rings_text = R"([system]
model = "beams"
wave_number = 1
elements = 30

[geometry]
circumference = 2
friction_coefficient = 0.25
force_per_length = 50
base = { elastic_modulus = 1e11, density = 8000, width = 0.1, height = 0.04 }
damper = { elastic_modulus = 2e11, density = 4000, poisson_ratio = 0.25, width = 0.05, height = 0.01 }

[study]
parameter = "P"
from = 0.005
to = 0.02
eta = [1.5, 2.5]
)";

std::vector<std::map<std::string, double>> numbers_in(const std::string& path) {
  const auto cells = read_csv(path);
  std::vector<std::map<std::string, double>> rows;
  for (std::size_t i = 1; i < cells.size(); ++i) {
    REQUIRE(cells[i].size() == cells[0].size());
    rows.emplace_back();
    for (std::size_t k = 0; k < cells[i].size(); ++k) {
      char* end = nullptr;
      const double number = std::strtod(cells[i][k].c_str(), &end);
      if (end != cells[i][k].c_str()) rows.back()[cells[0][k]] = number;
    }
  }
  return rows;
}

constexpr double rounding = 1e-13;

}  // namespace

TEST_CASE("Scatter is read with its defaults", "[study]") {
  using Kind = problems::Scatter::Kind;
  const StudyCase study = case_texts::read_study_text(study_text +
                                                      "[study.uncertain]\nmu = { lognormal = 0.2 }\n"
                                                      "preload = { uniform = [0.8, 1.25] }\n");
  REQUIRE(study.uncertain);
  CHECK(study.uncertain->friction.kind == Kind::lognormal);
  CHECK(study.uncertain->friction.deviation == 0.2);
  CHECK(study.uncertain->preload.kind == Kind::uniform);
  CHECK(study.uncertain->preload.low == 0.8);
  CHECK(study.uncertain->preload.high == 1.25);
  CHECK(study.uncertain->force.kind == Kind::none);
  const auto& resolved = study.resolved["study"]["uncertain"];
  CHECK(resolved["samples"] == 4000);
  CHECK(resolved["seed"] == 1);
  CHECK(resolved["quantiles"] == std::vector<double>{0.05, 0.5, 0.95});
  const StudyCase other = case_texts::read_study_text(scattered_text + "seed = 7\nquantiles = [0.1, 0.99]\n",
                                                      {"study.uncertain.force={ lognormal = 0.1 }"});
  CHECK(other.uncertain->samples == 200);
  CHECK(other.uncertain->seed == 7);
  CHECK(other.uncertain->quantiles == std::vector<double>{0.1, 0.99});
  CHECK(other.uncertain->force.deviation == 0.1);
  CHECK_FALSE(case_texts::read_study_text(study_text).uncertain);
}

TEST_CASE("Wrong scatter is refused in one line with place, key, what was expected and given", "[study]") {
  const auto line = [](const std::string& from, const std::string& to, const std::string& place,
                       const std::string& key, const std::string& expected, const std::string& given) {
    return Mistake{from, to, place, "study.uncertain" + key, expected, given};
  };
  const std::string mu = "mu = { lognormal = 0.2 }";
  const std::string preload = "preload = { uniform = [0.8, 1.25] }";
  const Mistake mistakes[] = {
      line("lognormal = 0.2", "lognormal = 0", ":15:20", ".mu.lognormal", "> 0 and <= 1", "got 0"),
      line("lognormal = 0.2", "lognormal = \"wide\"", ":15:20", ".mu.lognormal", "> 0 and <= 1",
           "got \"wide\""),
      line("lognormal = 0.2", "normal = 0.2", ":15:17", ".mu.normal",
           "unknown key; expected one of lognormal, uniform", ""),
      line("lognormal = 0.2", "", ":15:6", ".mu", "{ lognormal = ... } or { uniform = [...] }", ""),
      line(mu, "mu = { lognormal = 0.2, uniform = [1, 2] }", ":15:6", ".mu",
           "{ lognormal = ... } or { uniform = [...] }", ""),
      line(mu, "mu = 0.2", ":15:6", ".mu", "a table", "got 0.2"),
      line("[0.8, 1.25]", "[1.25, 0.8]", ":16:23", ".preload.uniform", "0 < low < high", "an array"),
      line("[0.8, 1.25]", "[0, 1.25]", ":16:24", ".preload.uniform[0]", "> 0", "got 0"),
      line("[0.8, 1.25]", "[1]", ":16:23", ".preload.uniform", "0 < low < high", "an array"),
      line("samples = 200", "samples = 99", ":17:11", ".samples", ">= 100 and <= 1e6", "got 99"),
      line("samples = 200", "seed = -1", ":17:8", ".seed", "an integer >= 0", "got -1"),
      line("samples = 200", "quantiles = [0.5, 0.5]", ":17:13", ".quantiles", "rising numbers", "an array"),
      line("samples = 200", "quantiles = []", ":17:13", ".quantiles", "rising numbers", "an empty array"),
      line("samples = 200", "quantiles = [0.5, 1]", ":17:19", ".quantiles[1]", "> 0 and < 1", "got 1"),
      line("samples", "sample", ":17:10", ".sample", "did you mean 'samples'?", ""),
      line(mu + "\n" + preload, "", ":14:1", ".mu", "missing; expected at least one of mu, preload and force",
           ""),
  };
  for (const Mistake& mistake : mistakes) {
    const std::string text = replaced(scattered_text, mistake.from, mistake.to);
    check_message(error_of([&] { case_texts::read_study_text(text); }), mistake);
  }
}

TEST_CASE("Designs of a study may be given in SI units, with lists and ranges of dotted keys", "[study]") {
  const StudyCase study = case_texts::read_study_text(
      rings_text +
      "for_each = { damper.width = { from = 0.05, to = 0.1, count = 2 }, \"base.height\" = [0.04, 0.08] }\n");
  CHECK(study.preload_unit == "N_per_m");
  CHECK(study.keys == std::vector<std::string>{"damper.width", "base.height"});
  REQUIRE(study.count == 4);
  // M* = rho_B w_B h_B/(rho_D w_D h_D), gamma = h_B/h_D sqrt(E_B rho_D/(E_D rho_B)).
  CHECK_THAT(study.design(0).system.mass_ratio, WithinRel(16, rounding));
  CHECK_THAT(study.design(3).system.mass_ratio, WithinRel(16, rounding));
  CHECK_THAT(study.design(2).system.mass_ratio, WithinRel(8, rounding));
  CHECK_THAT(study.design(3).system.frequency_ratio, WithinRel(4, rounding));
  CHECK(study.design(3).geometry->base.height == 0.08);
  CHECK(describe(study.design(1).values) == "damper.width = 0.05, base.height = 0.08");

  const StudyCase listed =
      case_texts::read_study_text(rings_text +
                                  "for_each = [{ damper.width = 0.05, circumference = 2 },\n"
                                  "            { circumference = 1, damper.width = 0.1 }]\n");
  CHECK(listed.keys == std::vector<std::string>{"damper.width", "circumference"});
  CHECK_THAT(listed.design(1).system.mass_ratio, WithinRel(8, rounding));
  CHECK(listed.design(1).geometry->circumference == 1);

  const auto refused = [](const std::string& for_each) {
    return error_of([&] { case_texts::read_study_text(rings_text + "for_each = " + for_each + "\n"); });
  };
  CHECK_THAT(refused("{ damper.with = [1] }"),
             ContainsSubstring("study.for_each.damper.with: unknown key; did you mean 'damper.width'?"));
  CHECK_THAT(refused("{ damper.width = [0.1, 0] }"),
             ContainsSubstring("study.for_each.damper.width[1]: expected a finite number > 0, got 0"));
  CHECK_THAT(refused("[{ damper.width = 0.1 }, { damper.width = -1 }]"),
             ContainsSubstring("study.for_each[1].damper.width: expected a finite number > 0, got -1"));
  CHECK_THAT(refused("{ mass_ratio = [1] }"),
             ContainsSubstring("study.for_each.mass_ratio[0]: not beside [geometry], which gives it"));
  CHECK_THAT(refused("{ preload_per_length = [1] }"),
             ContainsSubstring("preload_per_length cannot be listed: P is swept"));
}

TEST_CASE("study writes quantiles and robust preloads as study_uncertainty finds them", "[study]") {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("case.toml", replaced(scattered_text, "[study.uncertain]",
                                         "for_each = { mass_ratio = [5, 10] }\n[study.uncertain]"));
  const Outcome outcome = arcslip_program("study " + path + " -o " + folder.path("r"));
  CHECK(outcome.status == 0);
  CHECK(outcome.err.empty());
  CHECK_THAT(outcome.out, ContainsSubstring("P_q95") && ContainsSubstring("robust.csv, quantiles.csv"));
  CHECK(names_in(folder.path("r")) == std::set<std::string>{"optimum.csv", "quantiles.csv", "robust.csv",
                                                            "study.sqlite", "summary.json", "sweep.csv"});
  const auto robust = numbers_in(folder.path("r/robust.csv"));
  const auto optimum = numbers_in(folder.path("r/optimum.csv"));
  const auto quantiles = numbers_in(folder.path("r/quantiles.csv"));
  CHECK(read_csv(folder.path("r/robust.csv"))[0] ==
        std::vector<std::string>{"curve", "mass_ratio", "P_q95", "Y_q95", "ratio_q95", "P_opt", "Y_q95_opt",
                                 "ratio_q95_opt", "error", "sampling_error"});
  CHECK(read_csv(folder.path("r/quantiles.csv"))[0] ==
        std::vector<std::string>{"curve", "P", "Y_q5", "Y_q50", "Y_q95", "ratio_q5", "ratio_q50", "ratio_q95",
                                 "error_q5", "error_q50", "error_q95"});
  REQUIRE(robust.size() == 2);
  const FinishedDesign second = study_design(read_study(path), 1);
  REQUIRE(second.uncertain);
  CHECK(robust[1].at("mass_ratio") == 10);
  CHECK(robust[1].at("P_q95") == second.uncertain->preload);  // 17 digits, and the same seed
  CHECK(robust[1].at("Y_q95") == second.uncertain->Y);
  CHECK(robust[1].at("Y_q95_opt") == second.uncertain->Y_nominal);
  CHECK(robust[1].at("P_opt") == optimum[1].at("P_opt"));
  CHECK_THAT(robust[1].at("ratio_q95"), WithinRel(second.uncertain->Y / optimum[1].at("Y_nd_max"), rounding));
  const std::size_t rows = second.uncertain->rows.size();
  REQUIRE(quantiles.size() > rows);
  for (std::size_t i = 0; i < rows; ++i) {
    const auto& row = quantiles[quantiles.size() - rows + i];
    CHECK(row.at("curve") == 1);
    CHECK(row.at("P") == second.uncertain->rows[i].preload);
    CHECK(row.at("Y_q50") == second.uncertain->rows[i].Y[1]);
    CHECK_THAT(row.at("ratio_q95"), WithinRel(row.at("Y_q95") / optimum[1].at("Y_nd_max"), rounding));
  }
  // Without sweep.csv there are no quantiles at every preload either; what stood there is gone.
  CHECK(arcslip_program("study " + path + " --quiet --set study.sweep=false -o " + folder.path("r")).status ==
        0);
  CHECK(names_in(folder.path("r")) ==
        std::set<std::string>{"optimum.csv", "robust.csv", "study.sqlite", "summary.json"});
  CHECK(numbers_in(folder.path("r/robust.csv")) == robust);
}

TEST_CASE("A study of rings has columns in SI units", "[study]") {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("case.toml", rings_text +
                                    "for_each = { damper.width = [0.05, 0.1] }\n"
                                    "[study.uncertain]\nmu = { lognormal = 0.1 }\nsamples = 100\n");
  const Outcome outcome = arcslip_program("study " + path + " -o " + folder.path("r"));
  CHECK(outcome.status == 0);
  CHECK_THAT(outcome.out, ContainsSubstring("preload_N_per_m"));
  // k_B = 2e4/3 N/m, so that p_0 = P k_B/mu; L = 2 m; Omega_D/(2 pi) = 2 pi sqrt(k_D/m_D), where
  // k_D/m_D = E h^2/(12 rho L^4) does not depend on the width; energies are in k_D L^2.
  const double newtons_per_metre = 2e4 / 3 / 0.25;
  const double hertz = 2 * 3.14159265358979324 * std::sqrt(2e11 * 1e-4 / (12 * 4000 * 16.0));
  const auto optimum = numbers_in(folder.path("r/optimum.csv"));
  REQUIRE(optimum.size() == 2);
  for (const auto& row : optimum) {
    CHECK_THAT(row.at("preload_N_per_m"), WithinRel(row.at("P_opt") * newtons_per_metre, rounding));
    CHECK_THAT(row.at("preload_high_N_per_m"), WithinRel(row.at("P_high") * newtons_per_metre, rounding));
    CHECK_THAT(row.at("frequency_Hz"), WithinRel(row.at("eta_opt") * hertz, rounding));
    CHECK_THAT(row.at("Y_m"), WithinRel(2 * row.at("Y_opt"), rounding));
    CHECK_THAT(row.at("Y_nd_max_m"), WithinRel(2 * row.at("Y_nd_max"), rounding));
    const double damper_stiffness = 2e11 * row.at("damper.width") * 1e-6 / (12 * 8.0);
    CHECK_THAT(row.at("energy_J"), WithinRel(4 * damper_stiffness * row.at("energy"), rounding));
  }
  for (const auto& row : numbers_in(folder.path("r/sweep.csv"))) {
    CHECK_THAT(row.at("preload_N_per_m"), WithinRel(row.at("P") * newtons_per_metre, rounding));
    CHECK_THAT(row.at("frequency_Hz"), WithinRel(row.at("eta_peak") * hertz, rounding));
    CHECK_THAT(row.at("Y_m"), WithinRel(2 * row.at("Y_max"), rounding));
  }
  for (const auto& row : numbers_in(folder.path("r/robust.csv"))) {
    CHECK_THAT(row.at("preload_N_per_m"), WithinRel(row.at("P_q95") * newtons_per_metre, rounding));
    CHECK_THAT(row.at("Y_q95_m"), WithinRel(2 * row.at("Y_q95"), rounding));
  }
  for (const auto& row : numbers_in(folder.path("r/quantiles.csv")))
    CHECK_THAT(row.at("preload_N_per_m"), WithinRel(row.at("P") * newtons_per_metre, rounding));
}

TEST_CASE("The study of rotor and ring finds what the case says", "[study]") {
  const StudyCase study = read_study(source_folder() + "/problems/rotor_ring.toml");
  REQUIRE(study.count == 2);
  const auto micrometres = [](const PhysicalScale& scale, double Y) { return 1e6 * scale.displacement(Y); };
  const double newtons_per_metre[] = {312.6, 335.1};
  const double heights[] = {4.56, 2.49};
  for (const std::size_t i : {0U, 1U}) {
    const StudyDesign design = study.design(i);
    const PhysicalScale scale(*design.geometry, design.system);
    const FinishedDesign done = study_design(study, i);
    REQUIRE(done.result.optimum);
    CHECK_THAT(scale.preload(done.result.optimum->peak.preload),
               WithinAbs(newtons_per_metre[i], 0.05));  // as printed there
    CHECK_THAT(micrometres(scale, done.result.optimum->peak.Y), WithinAbs(heights[i], 0.005));
    if (i == 1) continue;
    REQUIRE(done.uncertain);
    CHECK_THAT(scale.preload(done.uncertain->preload), WithinAbs(352, 0.5));
    CHECK_THAT(micrometres(scale, done.uncertain->Y), WithinAbs(6.25, 0.005));
    CHECK_THAT(micrometres(scale, done.uncertain->Y_nominal), WithinAbs(6.70, 0.005));
  }
}

TEST_CASE("A design whose scatter could not be studied keeps its optimum, has nan for the rest and is told",
          "[study]") {
  const TemporaryFolder folder;
  const StudyCase study = read_study(folder.write("case.toml", scattered_text));
  const FinishedDesign design = study_design(study, 0);
  problems::UncertainPeaks failed;
  failed.failure = "lost";
  StudyStore store(folder.path(""), study, false);
  store.add(0, design.values, design.result, &failed);
  std::string csv;
  store.write_robust([&](std::string_view text) { csv += text; });
  CHECK_THAT(csv, ContainsSubstring("\n0,nan,nan,nan,"));
  std::vector<std::string> failures;
  store.visit(StudyStore::Which::failed, [&](const StoredDesign& one) {
    failures.push_back(one.failure);
    CHECK(one.preload == design.result.optimum->peak.preload);
    return true;
  });
  CHECK(failures == std::vector<std::string>{"lost"});
}

TEST_CASE("check tells what scatters and what the units of rings are", "[study]") {
  const TemporaryFolder folder;
  const Outcome scattered = arcslip_program("check " + folder.write("case.toml", scattered_text));
  CHECK_THAT(scattered.out,
             ContainsSubstring("scatter of mu: lognormal, 0.2; of the preload: uniform, 0.8 to "
                               "1.25; of the force: fixed; 200 samples, seed 1"));
  const Outcome rings = arcslip_program("check " + folder.write("rings.toml", rings_text));
  CHECK_THAT(rings.out, ContainsSubstring("P = 1: 26666.7 N/m, Y = 1: 2 m"));
}
