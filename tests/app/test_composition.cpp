// Whether kinds of systems and tasks compose as the manual's table says: each cell that says yes is run to
// its end, and its numbers are held against another cell's or against what they must be; every other is
// refused by the sentence that its letter stands for.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.hpp"
#include "composition.hpp"

namespace arcslip::testing::composition {
namespace {

void require_done(const Outcome& outcome) {
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
}

std::string stop_at(double value) { return fmt::format("[continuation]\nstop_at = [{}]\n", value); }

struct Task {
  std::string name;
  std::function<Outcome(Cells&)> run;
  std::function<void(Cells&)> check;  // after a run that ended well
};

Outcome run_over_eta(Cells& cells) { return cells.run("run", cells.response(stop_at(cells.kind().eta))); }

Outcome run_over_preload(Cells& cells) {
  return cells.run("run", cells.kind().text +
                              fmt::format("[branch]\nparameter = \"P\"\nfrom = 0.01\nto = 30.0\neta = {}\n",
                                          cells.kind().eta) +
                              stop_at(0.3));
}

/// Y of the first `user` point, and the peaks and switches over eta at P = 0.3.
double at_stop(const Table& table) {
  const auto found = table.of_type("user");
  REQUIRE_FALSE(found.empty());
  return table(found.front(), "Y");
}

void check_response(Cells& cells) {
  const nlohmann::json branch = cells.summary()["branches"][0];
  CHECK(branch["stop"] == "reached_end");
  CHECK(branch["power_error"] < 1e-7);
  CHECK(branch["motion_error"] < 1e-7);
  const Table rows = cells.results();
  for (std::size_t i = 0; i < rows.rows.size(); ++i) CHECK(rows(i, "residual") < 1e-8);
}

void check_preload_response(Cells& cells) {
  check_response(cells);
  const double Y = at_stop(cells.results());
  require_done(run_over_eta(cells));
  const Table over_eta = cells.results();
  bool met = false;  // several responses there may be at one eta
  for (const std::size_t row : over_eta.of_type("user"))
    met = met || std::abs(over_eta(row, "Y") / Y - 1) < 1e-8;
  CHECK(met);
}

Outcome run_curve(Cells& cells, const std::string& type) {
  return cells.run(
      "run", cells.kind().text +
                 fmt::format("[branch]\ncurve = \"{}\"\nparameters = [\"eta\", \"P\"]\nwindow = [{}, {}]\n"
                             "from = 0.2\nto = 3.0\n",
                             type, cells.kind().low, cells.kind().high));
}

/// Each curve passes the special points that the response at the preload of the system has.
void check_curve(Cells& cells, const std::string& type) {
  const Table curve = cells.results();
  require_done(run_over_eta(cells));
  const Table response = cells.results();
  for (const std::size_t at : response.of_type(type)) {
    bool is_passed = false;
    for (std::size_t i = 0; i < curve.rows.size(); ++i) {
      is_passed = is_passed || (std::abs(curve(i, "P") / 0.3 - 1) < 1e-12 &&
                                std::abs(curve(i, "eta") / response(at, "eta") - 1) < 1e-8 &&
                                std::abs(curve(i, "Y") / response(at, "Y") - 1) < 1e-8);
    }
    CAPTURE(at, response(at, "eta"));
    CHECK(is_passed);
  }
}

std::string study_text(const Cells& cells, double from, double to) {
  return cells.kind().text + fmt::format("[study]\nparameter = \"P\"\nfrom = {}\nto = {}\neta = [{}, {}]\n",
                                         from, to, cells.kind().low, cells.kind().high);
}

/// The response at the best preload has Y_opt for its highest point, and those beside it are higher.
void check_study(Cells& cells) {
  const Table optimum = cells.results("optimum.csv");
  const double best = optimum(0, "P_opt");
  for (const double factor : {1.0, 0.9, 1.1}) {
    const std::string text =
        cells.response("", cells.with("preload = 0.3", fmt::format("preload = {:.17g}", factor * best)));
    require_done(cells.run("run", text));
    const Table response = cells.results();
    double highest = 0;
    for (std::size_t i = 0; i < response.rows.size(); ++i) highest = std::max(highest, response(i, "Y"));
    CAPTURE(factor, best);
    if (factor == 1) CHECK_THAT(highest, Catch::Matchers::WithinRel(optimum(0, "Y_opt"), 1e-6));
    CHECK(highest >= optimum(0, "Y_opt") * (1 - 1e-6));
  }
}

void check_scatter(Cells& cells) {
  const Table quantiles = cells.results("quantiles.csv");
  for (std::size_t row = 0; row < quantiles.rows.size(); ++row) {
    CHECK(quantiles(row, "Y_q5") <= quantiles(row, "Y_q50"));
    CHECK(quantiles(row, "Y_q50") <= quantiles(row, "Y_q95"));
  }
}

Outcome run_cycle(Cells& cells, const std::string& more = "") {
  return cells.run(
      "run", cells.kind().text + fmt::format("[branch]\nresponse = \"limit_cycle\"\nparameter = \"zeta_B\"\n"
                                             "start = -1e-2\nfrom = -5e-3\nto = {}\n{}",
                                             more.empty() ? cells.kind().zeta : -1.5e-2, more));
}

/// What the engine counts and what is told of the worst one are the same.
void check_disturbed_cycle(Cells& cells) {
  const Table cycle = cells.results();
  for (std::size_t i = 0; i < cycle.rows.size(); ++i) {
    CHECK(cycle(i, "growth") > 0);
    CHECK((cycle(i, "unstable") > 0) == (cycle(i, "growth") > 1));
  }
}

/// The nonlinear mode of the same zeta_B has no damping at the cycle's amplitude and frequency.
void check_cycle(Cells& cells) {
  const Table cycle = cells.results();
  const std::size_t last = cycle.rows.size() - 1;
  const std::string& text = cells.kind().text;
  const std::size_t at = text.find("base = ") + 7;
  const std::string damped =
      cells.with(text.substr(at - 7, text.find(',', at) - at + 7), "base = " + cycle.text(last, "zeta_B"));
  require_done(cells.run(
      "run", damped + fmt::format("[branch]\nresponse = \"nonlinear_mode\"\nparameter = \"R\"\neta = {}\n"
                                  "from = {}\nto = {:.17g}\n",
                                  cycle(last, "eta"), 1e-3 * cycle(last, "S"), cycle(last, "R"))));
  const Table mode = cells.results();
  const std::size_t end = mode.rows.size() - 1;
  CHECK_THAT(mode(end, "zeta"), Catch::Matchers::WithinAbs(0, 1e-8));
  CHECK_THAT(mode(end, "eta"), Catch::Matchers::WithinRel(cycle(last, "eta"), 1e-8));
}

/// The base moves as it does where the contacts are all but open.
void check_one_way(Cells& cells) {
  const double driven = at_stop(cells.results());
  std::string open = cells.with("preload = 0.3", "preload = 1e-6");
  for (const char* key : {"preload_growth", "normal_stiffness"}) {  // without these nothing is left of them
    if (const std::size_t at = open.find(key); at != std::string::npos)
      open.erase(at, open.find('\n', at) - at);
  }
  require_done(cells.run("run", cells.response(stop_at(cells.kind().eta), open)));
  CHECK_THAT(at_stop(cells.results()), Catch::Matchers::WithinRel(driven, 1e-4));
}

Outcome run_mode(Cells& cells) {
  return cells.run(
      "run", cells.kind().text + fmt::format("[branch]\nresponse = \"nonlinear_mode\"\nparameter = \"R\"\n"
                                             "from = 1e-4\nto = 10.0\neta = {}\n",
                                             cells.kind().eta));
}

/// In stick nothing depends on the amplitude, but for cubic springs that at first do nothing.
void check_mode(Cells& cells) {
  const Table mode = cells.results();
  REQUIRE(mode.rows.size() > 10);
  CHECK(mode.text(0, "regime") == "stick");
  CHECK_THAT(mode(1, "eta"), Catch::Matchers::WithinRel(mode(0, "eta"), 1e-6));
  CHECK_THAT(mode(1, "zeta"), Catch::Matchers::WithinRel(mode(0, "zeta"), 1e-6));
  CHECK(mode.text(mode.rows.size() - 1, "regime") != "stick");
}

/// A force that the damping of the kind can take in: one that friction does not hold feeds an unstable base.
double drawn_force(const Cells& cells) { return cells.kind().name == "negative damping" ? 0.2 : 1; }
std::string drawn_system(const Cells& cells) {
  return cells.with("force = 1.0", fmt::format("force = {}", drawn_force(cells)));
}

Outcome run_backbone(Cells& cells) {
  return cells.run("run", drawn_system(cells) +
                              fmt::format("[branch]\ncurve = \"phase_resonance\"\nparameters = [\"eta\", "
                                          "\"F\"]\nwindow = [{}, {}]\nfrom = {}\nto = {}\n",
                                          cells.kind().low, cells.kind().high, 0.5 * drawn_force(cells),
                                          2 * drawn_force(cells)));
}

/// The load does nothing but work, and the response under the force of the system is there where the curve
/// is.
void check_backbone(Cells& cells) {
  const Table curve = cells.results();
  std::vector<std::pair<double, double>> met;  // eta and Y
  for (std::size_t i = 0; i < curve.rows.size(); ++i) {
    CHECK_THAT(curve(i, "lag"), Catch::Matchers::WithinRel(0.5 * pi, 1e-7));
    if (std::abs(curve(i, "F") / drawn_force(cells) - 1) < 1e-12)
      met.emplace_back(curve(i, "eta"), curve(i, "Y"));
  }
  std::size_t found = 0;
  for (const auto& [eta, Y] : met) {
    require_done(cells.run("run", cells.response(fmt::format("[continuation]\nstop_at = [{:.17g}]\n", eta),
                                                 drawn_system(cells))));
    const Table response = cells.results();
    const auto rows = response.of_type("user");
    found += static_cast<std::size_t>(std::any_of(rows.begin(), rows.end(), [&, Y = Y](std::size_t row) {
      return std::abs(response(row, "Y") / Y - 1) < 1e-7;
    }));
  }
  const bool may_be_apart = cells.kind().name == "negative damping";  // from the response with the least Y
  CHECK(found >= 1);
  CHECK((may_be_apart || found == met.size()));
}

/// Near the eta of the kind, for spectra are dear.
Outcome run_stability(Cells& cells) {
  return cells.run(
      "run",
      cells.kind().text + fmt::format("[branch]\nparameter = \"eta\"\nfrom = {}\nto = {}\nstability = true\n",
                                      0.97 * cells.kind().eta, 1.03 * cells.kind().eta));
}

/// Nothing grows where friction and damping take energy from linear structures.
void check_stability(Cells& cells) {
  const Table response = cells.results();
  const bool may_grow =
      cells.kind().name == "negative damping" || cells.kind().name.find("cubic") != std::string::npos ||
      cells.kind().name.find("stops") != std::string::npos || cells.kind().name == "lift-off";
  bool grows = false;
  for (std::size_t i = 0; i < response.rows.size(); ++i) {
    CHECK(response(i, "growth") > 0);
    grows = grows || response(i, "growth") > 1 + 1e-9;
  }
  CHECK((may_grow || !grows));
}

void check_certificate(Cells& cells) {
  const nlohmann::json certificate = cells.summary()["branches"][0]["certificate"];
  INFO(certificate.dump());
  CHECK(certificate["proven"] == true);
}

void check_verified(Cells& cells) {
  const Table verified = cells.results("verify.csv");
  for (std::size_t i = 0; i < verified.rows.size(); ++i) {
    CHECK(verified(i, "power_error") < 1e-7);
    const double timed = verified(i, "Y_time");
    if (!std::isnan(timed)) CHECK_THAT(timed, Catch::Matchers::WithinRel(verified(i, "Y_harmonics"), 1e-3));
  }
}

/// Beside a peak of R all is lower.
void check_peaks(Cells& cells) {
  const Table response = cells.results();
  const auto peaks = response.of_type("peak");
  REQUIRE_FALSE(peaks.empty());
  for (const std::size_t at : peaks) {
    CAPTURE(at);
    for (const std::size_t beside : {at - 1, at + 1})
      CHECK(response(beside, "R") <= response(at, "R") * (1 + 1e-12));
  }
}

std::vector<Task> tasks() {
  const auto study = [](Cells& cells) { return cells.run("study", study_text(cells, 0.1, 5)); };
  const auto scatter = [](Cells& cells) {
    // A mu of its own, of which each value is another design, is for test_even_studies.cpp.
    const char* mu = cells.kind().name == "lift-off" ? "" : "mu = { lognormal = 0.2 }\n";
    return cells.run("study", study_text(cells, 0.5, 1) + "sweep = true\n[study.uncertain]\n" + mu +
                                  "preload = { uniform = [0.8, 1.25] }\nsamples = 100\n");
  };
  const auto asked = [](const std::string& more, const std::string& options = "") {
    return [=](Cells& cells) { return cells.run("run", cells.response(more), options); };
  };
  const auto verified = [](Cells& cells) {
    return cells.run("run", cells.response(stop_at(cells.kind().eta)), "--verify");
  };
  const auto curve = [](const std::string& type) {
    return [=](Cells& cells) { return run_curve(cells, type); };
  };
  const auto passes = [](const std::string& type) { return [=](Cells& cells) { check_curve(cells, type); }; };
  const auto cycle = [](Cells& cells) { return run_cycle(cells); };
  const auto disturbed_cycle = [](Cells& cells) { return run_cycle(cells, "stability = true\n"); };
  const auto one_way = [](Cells& cells) {
    return cells.run("run", cells.response("response = \"one_way\"\n" + stop_at(cells.kind().eta)));
  };
  return {{"over eta", run_over_eta, check_response},
          {"over P", run_over_preload, check_preload_response},
          {"`peak` curve", curve("peak"), passes("peak")},
          {"`switch` curve", curve("switch"), passes("switch")},
          {"study", study, check_study},
          {"scatter", scatter, check_scatter},
          {"limit cycle", cycle, check_cycle},
          {"its stability", disturbed_cycle, check_disturbed_cycle},
          {"one-way", one_way, check_one_way},
          {"mode", run_mode, check_mode},
          {"phase resonance", run_backbone, check_backbone},
          {"stability", run_stability, check_stability},
          {"`--certify`", asked("", "--certify"), check_certificate},
          {"`--verify`", verified, check_verified},
          {"peaks of R", asked("extrema_of = [\"R\"]\n"), check_peaks}};
}

/// What a letter of the table stands for, in the words of the program.
const std::map<std::string, std::string> reasons = {
    {"a", "certify"}, {"b", "grows without bound"}, {"c", "structural"}, {"d", "\"reduced\""}};

void check_kind(const std::string& name) {
  const auto lines = promised();
  const std::vector<Kind> all = kinds();
  const auto kind = std::find_if(all.begin(), all.end(), [&](const Kind& one) { return one.name == name; });
  REQUIRE(kind != all.end());
  REQUIRE(lines.count(name) == 1);
  const std::vector<std::string>& line = lines.at(name);
  const std::vector<Task> list = tasks();
  REQUIRE(line.size() == list.size());
  Cells cells(*kind);
  for (std::size_t i = 0; i < list.size(); ++i) {
    CHECK(lines.at("")[i] == list[i].name);
    const Outcome outcome = list[i].run(cells);
    INFO(name << ", " << list[i].name << ": " << outcome.err);
    if (line[i] == "yes") {
      CHECK(outcome.status == 0);
      if (outcome.status == 0) list[i].check(cells);
    } else {
      CHECK(outcome.status == 1);
      CHECK(testing::is_one_line(outcome.err));
      CHECK_THAT(outcome.err, Catch::Matchers::Contains(reasons.at(line[i])));
    }
  }
}

}  // namespace

TEST_CASE("The table of what works with what has a hundred and forty that do", "[composition]") {
  std::size_t working = 0;
  const auto lines = promised();
  CHECK(lines.size() == 1 + kinds().size() + 1);  // with the rule below the head
  for (const auto& [name, cells] : lines) {
    if (!name.empty()) working += static_cast<std::size_t>(std::count(cells.begin(), cells.end(), "yes"));
  }
  CHECK(working >= 140);
}

TEST_CASE("All tasks compose with one contact in one harmonic", "[composition]") { check_kind("plain"); }
TEST_CASE("All tasks compose with five harmonics", "[composition]") { check_kind("five harmonics"); }
TEST_CASE("All tasks compose with cubic springs", "[composition]") { check_kind("cubic springs"); }
TEST_CASE("All tasks compose with a contact to ground", "[composition]") { check_kind("contact to ground"); }
TEST_CASE("All tasks compose with negative damping", "[composition][numbers]") {
  check_kind("negative damping");
}
TEST_CASE("All tasks compose with structural damping", "[composition]") { check_kind("structural damping"); }
TEST_CASE("All tasks compose with a growing preload", "[composition][numbers]") {
  check_kind("growing preload");
}
TEST_CASE("All tasks compose with stops in five harmonics", "[composition][numbers]") {
  check_kind("stops of `[[element]]`, five harmonics");
}
TEST_CASE("All tasks compose with cubic springs in five harmonics", "[composition][numbers]") {
  check_kind("cubic, five harmonics");
}
TEST_CASE("All tasks compose with a load of five harmonics", "[composition][numbers]") {
  check_kind("`[excitation]`, five harmonics");
}
TEST_CASE("All tasks compose with masses on springs", "[composition]") { check_kind("masses on springs"); }
TEST_CASE("All tasks compose with a sector", "[composition]") { check_kind("sector"); }
TEST_CASE("All tasks compose with a sector of three contacts", "[composition][numbers][long]") {
  check_kind("three contacts");
}
TEST_CASE("All tasks compose with a sector of three contacts in five harmonics",
          "[composition][numbers][long]") {
  check_kind("three contacts, five harmonics");
}
TEST_CASE("All tasks compose with lift-off", "[composition][numbers][long]") { check_kind("lift-off"); }
TEST_CASE("All tasks compose with microslip", "[composition][numbers]") { check_kind("microslip"); }
TEST_CASE("All tasks compose with a structure without symmetry", "[composition][numbers]") {
  check_kind("without symmetry");
}
TEST_CASE("All tasks compose with the full path of a sector", "[composition][numbers]") {
  check_kind("`path = \"full\"`");
}

}  // namespace arcslip::testing::composition
