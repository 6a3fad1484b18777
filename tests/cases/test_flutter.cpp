// Limit cycles of waves that a flow feeds: influence coefficients and damping by nodal diameter.

#include <cmath>
#include <numbers>
#include <string>

#include "arcslip/assembly/resonances.hpp"
#include "arcslip/cases/study_case.hpp"
#include "arcslip/elements/contact.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "catch.hpp"
#include "flutter_cases.hpp"
#include "mistakes.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

const std::string all_waves = "1, 2, 3, 4, 5";

BranchPoint at_S_1(const TracedBranch& traced) {
  REQUIRE(traced.branch.complete());
  const auto all = points(traced, PointType::user);
  REQUIRE(all.size() == 1);
  return all.front();
}

double omega(const TracedBranch& traced, const BranchPoint& point) {
  return two_pi * value(traced, point, "eta");
}

/// Rods on a ring that is held, with a section [flutter]; over `influence`, and back behind a fold.
std::string rods_in_flow(const std::string& flutter) {
  return "[system]\nmodel = \"rods\"\nwave_number = 1\nelements = 30\nmass_ratio = 5.0\n"
         "frequency_ratio = 4.0\ninterface_stiffness = 100.0\nfixed_damper = true\nforce = 1.0\n"
         "preload = 1.0\ndamping = { base = 1e-3, kind = \"structural\" }\n[flutter]\n" +
         flutter +
         "\n[branch]\nresponse = \"limit_cycle\"\nparameter = \"influence\"\nfrom = 1.5\nto = 30.0\n";
}

std::vector<TracedBranch> traced_text(const std::string& text) {
  const TemporaryFolder folder;
  return trace(read_case(folder.write("case.toml", text)).branches.front());
}

}  // namespace

TEST_CASE("Cycles of waves in a flow are those of the closed form in one harmonic", "[flutter][numbers]") {
  struct Row {
    double R, w;
  };
  const Row known[] = {{1.018300, 1.1011739},
                       {1.050909, 1.1164376},
                       {1.063566, 1.1380373},
                       {1.049856, 1.1604037},
                       {1.016699, 1.1772389}};
  Settings settings = flutter_of(0.01, all_waves);
  settings.insert(settings.end(), {"system.harmonics=1", "branch.stability=false"});
  const Run run("flutter", settings);
  REQUIRE(run.traced.size() == 5);
  for (int n = 1; n <= 5; ++n) {
    INFO("wave " << n);
    const TracedBranch& traced = run.traced[static_cast<std::size_t>(n - 1)];
    const BranchPoint point = at_S_1(traced);
    const double R = value(traced, point, "R_over_S");
    const double w = omega(traced, point);
    CHECK_THAT(R, WithinAbs(known[n - 1].R, 6e-7));
    CHECK_THAT(w, WithinAbs(known[n - 1].w, 6e-8));
    const double angle = std::numbers::pi * n / 6;
    const double fed = 2 * 0.01 * std::sin(angle) - 0.005 * w;
    CHECK_THAT((1 - 1 / R) / R, WithinRel(std::numbers::pi / 4 * fed / 0.2, 1e-10));
    const double real = slip_coefficient(std::log(R)).phi.real();
    CHECK_THAT(w * w, WithinRel(1 + 0.1 * (1 - std::cos(angle)) + 0.2 * real, 1e-11));
  }
}

TEST_CASE("Cycles in a flow grow or fade in other waves as all nodes do, and the right ones win",
          "[flutter][stability][numbers]") {
  struct Row {
    double g;
    double R[5], w[5], growth[5];
  };
  const auto row = GENERATE(values<Row>({{0.01,
                                          {1.018428, 1.051377, 1.064148, 1.050268, 1.016796},
                                          {1.1011724, 1.1164297, 1.1380268, 1.1603971, 1.1772379},
                                          {1.004295, 1.001786, .992880, .986300, .989184}},
                                         {0.016, {}, {}, {1.012923, 1.003224, .988589, .979107, .984002}}}));
  const Run run("flutter", flutter_of(row.g, all_waves));
  REQUIRE(run.traced.size() == 5);
  for (std::size_t i = 0; i < 5; ++i) {
    INFO("g = " << row.g << ", wave " << i + 1);
    const TracedBranch& traced = run.traced[i];
    const BranchPoint point = at_S_1(traced);
    if (row.R[i] > 0) {
      CHECK_THAT(value(traced, point, "R_over_S"), WithinAbs(row.R[i], 6e-7));
      CHECK_THAT(omega(traced, point), WithinAbs(row.w[i], 6e-8));
    }
    CHECK_THAT(value(traced, point, "growth"), WithinAbs(row.growth[i], 1e-5));
    CHECK(value(traced, point, "stable") == (i < 2 ? 0 : 1));
    // Over P the cycle keeps its shape, and what disturbs it its growth.
    for (const BranchPoint& other : traced.branch.points)
      CHECK_THAT(value(traced, other, "growth"), WithinAbs(value(traced, point, "growth"), 1e-8));
  }
}

TEST_CASE("Along a branch over the flow's strength disturbances grow as under that strength",
          "[flutter][stability][numbers]") {
  Settings settings = flutter_of(0.01, "1, 2, 3");
  settings.insert(settings.end(), {"branch.parameter=influence", "branch.from=0.9", "branch.to=1.7",
                                   "continuation.stop_at=[1.6]"});
  const Run run("flutter", settings);
  const double growth[] = {1.012923, 1.003224, .988589};
  REQUIRE(run.traced.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    INFO("wave " << i + 1);
    const BranchPoint point = at_S_1(run.traced[i]);
    CHECK_THAT(value(run.traced[i], point, "growth"), WithinAbs(growth[i], 1e-5));
  }
  // A forced wave, at the end of the way there and where this is the system's own.
  const auto forced_growth = [](double g, double from, double to) {
    Settings forced = flutter_of(g, "3");
    forced.insert(forced.end(),
                  {"branch.response=\"forced\"", "branch.eta=0.18", "system.force=0.05", "system.harmonics=5",
                   "branch.parameter=influence", fmt::format("branch.from={:.17g}", from),
                   fmt::format("branch.to={:.17g}", to), "continuation.stop_at=[]"});
    const Run forced_run("flutter", forced);
    REQUIRE(forced_run.traced.front().branch.complete());
    return value(forced_run.traced.front(), forced_run.traced.front().branch.points.back(), "growth");
  };
  CHECK_THAT(forced_growth(0.01, 0.8, 1.5), WithinRel(forced_growth(0.015, 0.8 / 1.5, 1), 1e-8));
}

TEST_CASE("A small vibration grows as its wave is fed", "[flutter]") {
  for (Index n = 1; n <= 5; ++n) {
    const ContactSystem wave = build_wave(flutter_system(0.01, n, 1));
    const Resonance mode = resonances(wave).front();
    const double a = std::numbers::pi * static_cast<double>(n) / 6;
    const double w = two_pi * mode.eta;
    CHECK_THAT(w * w, WithinRel(1 + 0.1 * (1 - std::cos(a)), 1e-12));
    CHECK_THAT(mode.damping, WithinRel((0.005 * w - 0.02 * std::sin(a)) / (2 * w * w), 1e-11));
  }
}

TEST_CASE("Friction holds a wave up to R = 2 S, and nothing beyond, whatever the preload",
          "[flutter][numbers]") {
  // Structural damping, so that what feeds does not change with the frequency.
  const std::string start =
      "[system]\nmodel = \"sector\"\nwave_number = 2\nsectors = 12\ncontact_stiffness = 0.2\npreload = 0.2\n"
      "reduction_window = [0.1, 0.4]\ndamping = { base = 1e-3 }\n[system.base]\nmass = \"" +
      source_folder() + "/problems/flutter/mass.mtx\"\nstiffness = \"" + source_folder() +
      "/problems/flutter/stiffness.mtx\"\nleft = [1]\nright = [2]\ncontact = [1]\n"
      "load = { dof = [1], value = [1.0] }\n[flutter]\ncoefficients = [[-1, 0.01], [1, -0.01]]\n"
      "[branch]\nresponse = \"limit_cycle\"\n";
  const std::vector<TracedBranch> branches =
      traced_text(start + "parameter = \"influence\"\nfrom = 0.5\nto = 20.0\n");
  REQUIRE(branches.size() == 1);
  const TracedBranch& traced = branches.front();
  const auto folds = points(traced, PointType::fold);
  REQUIRE(folds.size() == 1);
  CHECK_THAT(value(traced, folds[0], "R_over_S"), WithinRel(2, 1e-6));
  CHECK_THAT(std::pow(omega(traced, folds[0]), 2), WithinRel(1.05 + 0.1, 1e-7));  // Re phi = 1/2
  const double factor = value(traced, folds[0], "influence");
  const double held = factor * 0.02 * std::sin(std::numbers::pi / 3) - 2e-3 * 1.05;
  CHECK_THAT(held, WithinRel(0.2 / std::numbers::pi, 1e-9));
  check_derivatives_along(traced, 1, 5);
  const std::vector<TracedBranch> curves = traced_text(
      start +
      "curve = \"fold\"\nparameters = [\"influence\", \"P\"]\nwindow = [0.5, 20.0]\nfrom = 0.1\nto = 0.8\n");
  REQUIRE(curves.size() == 1);
  REQUIRE(curves.front().branch.complete());
  for (const BranchPoint& point : curves.front().branch.points) {
    const auto at = curves.front().curve->split(point.unknowns, point.parameters, point.regime);
    CHECK_THAT(at.parameters(2), WithinRel(factor, 1e-9));
  }
}

TEST_CASE("Equal loss in all waves has the fold that is known of zeta_B", "[flutter][numbers]") {
  // j x of the sector's own motion is structural damping of -x/(2 w_1^2) in this harmonic, on top of 1e-3.
  const double known = -0.00505776343777;
  const SystemParameters rods = [] {
    const TemporaryFolder folder;
    return read_case(folder.write("case.toml", rods_in_flow("coefficients = [[0, 0.0, 1.0]]")))
        .branches.front()
        .problem.system;
  }();
  const double w = two_pi * build_wave(rods).base.modes().front().frequency;
  const std::vector<TracedBranch> all =
      traced_text(rods_in_flow(fmt::format("coefficients = [[0, 0.0, {:.17g}]]", 2 * w * w * 1e-3)));
  REQUIRE(all.size() == 1);
  const auto folds = points(all[0], PointType::fold);
  REQUIRE(folds.size() == 1);
  CHECK_THAT(value(all[0], folds[0], "R_over_S"), WithinRel(2, 1e-7));
  CHECK_THAT(1e-3 - 1e-3 * value(all[0], folds[0], "influence"), WithinRel(known, 1e-10));
}

TEST_CASE("Damping by nodal diameter is that of its wave alone, one way round or both", "[flutter]") {
  const auto zeta_of = [](Index wave, const std::string& rows) {
    const SystemParameters system =
        flutter_system(0.01, wave, 1, {"flutter.coefficients=[[0, 0.0]]", "flutter.damping=" + rows});
    const Resonance mode = resonances(build_wave(system)).front();
    return mode.damping - 0.005 / (2 * two_pi * mode.eta);
  };
  CHECK_THAT(zeta_of(1, "[[1, -0.01]]"), WithinRel(-0.01, 1e-11));
  CHECK_THAT(zeta_of(2, "[[1, -0.01]]"), WithinAbs(0, 1e-15));
  CHECK_THAT(zeta_of(6, "[[6, 0.02]]"), WithinRel(0.02, 1e-11));
  CHECK_THAT(zeta_of(0, "[[0, 0.02]]"), WithinRel(0.02, 1e-11));
  CHECK_THAT(zeta_of(1, "[[1, -0.01], [-1, 0.03]]"), WithinRel(-0.01, 1e-11));
  CHECK_THAT(zeta_of(1, "[[-1, 0.03]]"), WithinAbs(0, 1e-15));
  const Influence one_way{{}, {{1, -0.01}, {-1, 0.03}, {2, 0.005}}, {}};
  const auto damping = [&](Index wave) {
    const ModeInfluence found = one_way.on(2.0, wave, 12, two_pi);
    return (found.damping * 2.0 - found.stiffness.imag()) / 8;
  };
  CHECK_THAT(damping(1), WithinRel(-0.01, 1e-14));
  CHECK_THAT(damping(11), WithinRel(0.03, 1e-14));
  CHECK_THAT(damping(10), WithinRel(0.005, 1e-14));
  CHECK(one_way.on(2.0, 11, 12, two_pi) == one_way.on(2.0, 1, 12, two_pi).conjugate());
}

TEST_CASE("Coefficients of neighbours are those of waves, there and back", "[flutter]") {
  const Index N = GENERATE(1, 2, 5, 12);
  Influence given;
  for (Index k = -((N - 1) / 2); k <= N / 2; ++k)
    given.coefficients.push_back({k, std::cos(3.0 * static_cast<double>(k)) + 0.3});
  for (const auto& [k, value] : given.coefficients) {
    Complex back = 0;
    for (Index n = 0; n < N; ++n)
      back += given.coefficient(n, N) *
              std::polar(1.0, two_pi * static_cast<double>(k * n) / static_cast<double>(N)) /
              static_cast<double>(N);
    CHECK(std::abs(back - value) < 1e-14);
  }
  for (Index n = 0; n < N; ++n) {
    CHECK(given.coefficient(-n, N) == std::conj(given.coefficient(n, N)));
    if (2 * n % N == 0) CHECK(given.coefficient(n, N).imag() == 0);
  }
}

TEST_CASE("A forced wave in a flow is that of all nodes in time, and its power balances", "[flutter][time]") {
  const int wave = GENERATE(0, 1, 3, 4, 6);  // 3 h is its own conjugate, 4 h meets 0
  Settings settings = flutter_of(0.01, fmt::format("{}", wave));
  settings.insert(
      settings.end(),
      {"branch.response=\"forced\"", "branch.parameter=eta", "branch.from=0.16", "branch.to=0.2",
       "branch.stability=false", "system.harmonics=9", "system.force=0.05", "continuation.stop_at=[]",
       "flutter.coefficients=[[-1, 0.004], [1, -0.004], [2, -0.01], [6, 0.003]]"});
  const Run run("flutter", settings);
  const TracedBranch& traced = run.traced.front();
  REQUIRE(traced.branch.complete());
  check_derivatives_along(traced, 1, 7);
  problems::VerifyOptions options;
  options.most_special = 4;
  options.samples = 1;
  std::size_t timed = 0;
  for (const problems::Verification& one :
       problems::verify(traced.request->problem.system, traced.base.harmonics, traced.branch, options)) {
    INFO("wave " << wave << ", point " << one.point);
    CHECK(one.power_error < 1e-9);
    if (std::isnan(one.Y_time)) continue;
    CHECK_THAT(one.Y_time, WithinRel(one.Y_harmonics, 2e-5));
    ++timed;
  }
  CHECK(timed >= 2);
}

TEST_CASE("A flow may be in files, and its strength be listed", "[flutter]") {
  const TemporaryFolder folder;
  folder.write("flow.csv", "# k, L_k\n-1, 0.01\n1, -0.01\n");
  std::string text = rods_in_flow("coefficients = \"flow.csv\"\ndamping = [[2, -1e-3], [-2, 1e-3]]");
  text = replaced(text, "parameter = \"influence\"\nfrom = 1.5\nto = 30.0",
                  "parameter = \"P\"\nfrom = 1.0\nto = 2.0\nfor_each = { influence = [1.0, 2.5] }");
  const Case input = read_case(folder.write("case.toml", text));
  CHECK(input.resolved["flutter"]["coefficients"].dump() == "[[-1,0.01],[1,-0.01]]");
  CHECK(input.resolved["flutter"]["damping"].dump() == "[[2,-0.001],[-2,0.001]]");
  REQUIRE(input.branches.size() == 2);
  const auto mode = [&](std::size_t i) {
    return build_wave(input.branches[i].problem.system).base.modes().front().influence;
  };
  CHECK(mode(1) == 2.5 * mode(0));
  CHECK(mode(0).stiffness.imag() != 0);
}

TEST_CASE("A flow that cannot be is refused in a line that says why", "[flutter][errors]") {
  const auto message = [](const Settings& settings) {
    return error_of(
        [&] { static_cast<void>(read_case(source_folder() + "/problems/flutter.toml", settings)); });
  };
  struct Refusal {
    Settings settings;
    std::string key, why;
  };
  const auto [settings, key, why] = GENERATE(values<Refusal>({
      {{"flutter.coefficients=[[7, 0.1]]"}, "flutter.coefficients", "from -6 to 6 as neighbours, got 7"},
      {{"flutter.coefficients=[[0.5, 0.1]]"}, "flutter.coefficients", "whole numbers"},
      {{"flutter.coefficients=[[1, 0.1], [1, 0.2]]"}, "flutter.coefficients", "differ, got 1 twice"},
      {{"flutter.coefficients=[[6, 0.1], [-6, 0.2]]"}, "flutter.coefficients", "as the one across is"},
      {{"flutter.coefficients=[[1, 0.1, 0.2, 0.3]]"}, "flutter.coefficients", "got a row of 4"},
      {{"flutter.coefficients=\"strong\""}, "flutter.coefficients", "rows [k, L_k]"},
      {{"flutter.coefficients=[[0, 0.1, 0.1]]"}, "flutter.coefficients", "real ones, or harmonics = 1"},
      {{"flutter.coefficients=[[0, 0.1, 0.1]]", "system.harmonics=1"},
       "flutter.coefficients",
       "no stability"},
      {{"flutter.damping=[[1, 1.5]]"}, "flutter.damping", "> -1 and < 1, got 1.5"},
      {{"flutter.damping=[[1]]"}, "flutter.damping", "got a row of 1"},
      {{"flutter.modes=[2]"}, "flutter.modes", "from 1 to 1, as many as the base has, got 2"},
      {{"flutter.influence=-1"}, "flutter.influence", "> 0, got -1"},
      {{"flutter.gain=1"}, "flutter.gain", "unknown key"},
      {{"ring.load=\"point\""}, "flutter", "not beside [ring]"},
      {{"system.path=\"full\"", "branch.response=\"forced\"", "branch.parameter=eta"},
       "flutter",
       "acts on modes of the base"},
  }));
  const std::string found = message(settings);
  CAPTURE(found);
  CHECK_THAT(found, ContainsSubstring(key) && ContainsSubstring(why));
  CHECK(found.find('\n') == std::string::npos);
}

TEST_CASE("Studies, which take passive structures alone, have no flow", "[flutter][errors]") {
  const CaseFile file(source_folder() + "/problems/flutter.toml",
                      {"study.parameter=P", "study.from=0.1", "study.to=1", "study.eta=[0.15, 0.2]"});
  const std::string found = error_of([&] { static_cast<void>(read_study(file).design(0)); });
  CHECK_THAT(found, ContainsSubstring("flutter") && ContainsSubstring("not of studies"));
}
