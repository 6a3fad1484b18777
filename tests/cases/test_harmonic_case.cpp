#include <cmath>
#include <nlohmann/json.hpp>

#include "arcslip/cases/study_case.hpp"
#include "arcslip/elements/hysteresis_loop.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "arcslip/results/results.hpp"
#include "case_runs.hpp"
#include "cases/design_study.hpp"
#include "mistakes.hpp"
#include "program.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

const std::string small_rods =
    "[system]\nmodel = \"rods\"\nwave_number = 1\nelements = 6\nmass_ratio = 5.0\nfrequency_ratio = 2.0\n"
    "interface_stiffness = 40.0\ndamping = { base = 0.01, damper = 0.01 }\nforce = 1.0\npreload = 0.6\n";
const std::string over_resonance = "[branch]\nparameter = \"eta\"\nfrom = 1.4\nto = 2.4\n";

}  // namespace

TEST_CASE("Where a harmonic resonates without damping a response that ends there says so", "[harmonics]") {
  // Of three rods each the harmonic 3 moves all alike: nothing resists but the stuck contacts, nothing damps
  // it.
  const double eta = std::sqrt(1e4 * (1 + 1 / 20.0)) / (3 * two_pi);
  const std::string three =
      "[system]\nmodel = \"rods\"\nwave_number = 1\nelements = 3\nmass_ratio = 20.0\nfrequency_ratio = "
      "4.0\ninterface_stiffness = 1e4\ndamping = { base = 0.01, damper = 0.01 }\nforce = 1.0\n";
  const auto is_said = ContainsSubstring(fmt::format(
      "the harmonic 3, the wave 0 of 3 sectors, resonates without damping at eta = {:.10g}", eta));
  const TemporaryFolder folder;
  const Case input =
      read_case(folder.write("case.toml", three + "harmonics = 3\npreload = 0.1\n[branch]\nparameter = "
                                                  "\"eta\"\nfrom = 1.6\nto = 8.0\n"));
  const auto traced = trace(input.branches.front());
  REQUIRE(traced.size() == 1);
  CHECK_FALSE(traced[0].branch.complete());
  CHECK_THAT(traced[0].branch.explanation, is_said);
  const StudyCase study = read_study(folder.write(
      "study.toml",
      three + "harmonics = 3\n[study]\nparameter = \"P\"\nfrom = 0.01\nto = 10.0\neta = [1.6, 8.0]\n"));
  CHECK_THAT(study_preload(study, study.design(0)).failure, is_said);
  const Case damped = read_case(folder.write(
      "damped.toml", small_rods + "harmonics = 3\n" + over_resonance + "[continuation]\nmax_points = 5\n"));
  CHECK_THAT(trace(damped.branches.front()).at(0).branch.explanation, !ContainsSubstring("without damping"));
}

TEST_CASE("The case of three numbers of harmonics has the peaks that it says", "[cases]") {
  const Run run("harmonics");
  REQUIRE(run.traced.size() == 3);
  const auto highest = [&](std::size_t branch) { return points(run.traced[branch], PointType::peak).back(); };
  CHECK_THAT(value(run.traced[0], highest(0), "Y"), WithinRel(0.00718851766, 1e-8));
  CHECK_THAT(value(run.traced[2], highest(2), "Y"), WithinRel(0.00848350500, 1e-8));
  CHECK_THAT(value(run.traced[2], points(run.traced[2], PointType::user).at(0), "Y"),
             WithinRel(0.0084264657, 1e-8));
  std::string text;
  write_branches(run.traced, [&](std::string_view piece) { text += piece; });
  CHECK_THAT(text, ContainsSubstring(",Y_h9"));
  CHECK_THAT(text, ContainsSubstring("nan"));  // what one harmonic has no value for
}

TEST_CASE("Where a further slip begins is a point, whatever the steps", "[harmonics]") {
  const Run coarse("harmonics"), fine("harmonics", {"continuation.max_step=0.02"});
  const auto further = [](const TracedBranch& traced) {
    const auto& problem = dynamic_cast<const problems::HarmonicProblem&>(traced.problem());
    std::vector<double> found;
    const std::vector<BranchPoint>& points = traced.branch.points;
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      if (points[i].type_name() != "further_slip") continue;
      found.push_back(value(traced, points[i], "eta"));
      const auto slips = [&](const BranchPoint& beside) {
        const double S = problem.slip_threshold(0, beside.unknowns, beside.parameters);
        const HarmonicVector x = problem.motion(beside.unknowns, beside.parameters, 0);
        const OddMotion motion(problem.system().orders, x);
        return HysteresisLoop(motion, S).slips();
      };
      CHECK(std::abs(slips(points[i + 1]) - slips(points[i - 1])) == 1);
    }
    return found;
  };
  for (const std::size_t branch : {1, 2}) {
    const std::vector<double> there = further(coarse.traced[branch]), same = further(fine.traced[branch]);
    REQUIRE(there.size() == 2);
    REQUIRE(same.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) CHECK_THAT(there[i], WithinRel(same[i], 1e-9));
  }
}

TEST_CASE("The summary of every forced response says how far its power and motion are balanced",
          "[harmonics]") {
  for (const char* name : {"figure_8", "harmonics", "preload_response"}) {
    const Run run(name);
    const nlohmann::ordered_json summary = summarize(run.input, run.traced, 0);
    for (const auto& branch : summary["branches"]) {
      CAPTURE(name, branch["branch"].dump());
      // the residual 1e-10 over the share of the force's apparent power that is dissipated, 1e-6 and more
      CHECK(branch["power_error"].get<double>() * branch["power_cancellation"].get<double>() < 1e-4);
      // the residual over twice the damping ratio, which a resonance amplifies it by
      CHECK(branch["motion_error"].get<double>() < 1e-10 / 2e-4);
    }
  }
}

TEST_CASE("The case of a nonlinear mode runs from its frequency in stick to that of the base alone",
          "[cases]") {
  const Run run("nonlinear_mode");
  const std::vector<BranchPoint>& all = run.traced[0].branch.points;
  CHECK_THAT(value(run.traced[0], all.front(), "eta"), WithinRel(3.67375221, 1e-8));
  CHECK_THAT(value(run.traced[0], all.back(), "eta"), WithinRel(4.000005298, 1e-7));
  CHECK_THAT(value(run.traced[0], points(run.traced[0], PointType::peak).back(), "zeta"),
             WithinRel(0.041, 0.02));
}

TEST_CASE("Automatic harmonics are as many as the branch asks for", "[harmonics]") {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& harmonics) {
    const Case input = read_case(folder.write("case.toml", small_rods + harmonics + over_resonance));
    return trace(input.branches.front());
  };
  const auto peak = [](const TracedBranch& traced) {
    double best = 0;
    for (const BranchPoint& point : points(traced, PointType::peak))
      best = std::max(best, value(traced, point, "Y"));
    return best;
  };
  const auto loose = run("harmonics = \"auto\"\nharmonics_tolerance = 1e-2\n");
  const auto found = run("harmonics = \"auto\"\n");
  const auto many = run("harmonics = 63\n");
  const std::vector<int> orders = found.front().base.harmonics;
  CHECK(orders.size() > loose.front().base.harmonics.size());
  CHECK(orders.size() < 32);
  CHECK_THAT(peak(found.front()), WithinRel(peak(many.front()), 1e-4));
}

TEST_CASE("Verified points agree with the ring in time as far as harmonics are many", "[harmonics]") {
  const TemporaryFolder folder;
  const Case input = read_case(folder.write("case.toml", small_rods + over_resonance));
  const auto traced = trace(input.branches.front());
  const SystemParameters& system = input.branches.front().problem.system;
  const auto checked = problems::verify(system, {1}, traced.front().branch, {.samples = 3});
  REQUIRE(checked.size() >= 6);
  int timed = 0;
  for (const problems::Verification& point : checked) {
    const BranchPoint& at = traced.front().branch.points[point.point];
    CAPTURE(to_string(at.type), at.parameters(0));
    CHECK(point.power_error < 1e-8);
    CHECK_THAT(point.Y, WithinRel(value(traced.front(), at, "Y"), 1e-8));  // the residual over the damping
    if (std::isnan(point.Y_time)) continue;
    ++timed;
    CHECK_THAT(point.Y_harmonics, WithinRel(point.Y_time, 2e-3));  // 15 harmonics
    // where nothing slips both rings swing against each other as rigid bodies, which nothing damps; where
    // slip begins it need not in time
    const bool slips = at.regime != 0 && value(traced.front(), at, "R_over_S") > 1 + 1e-9;
    CHECK(point.growth < (slips ? 1 : 1 + 1e-9));
  }
  CHECK(timed >= 4);
}

TEST_CASE("A branch without points is verified as one that holds nothing", "[harmonics]") {
  CHECK(problems::verify({}, {1}, {}, {.samples = 3}).empty());
}

TEST_CASE("Harmonics that cannot be taken are refused in one line", "[harmonics]") {
  const TemporaryFolder folder;
  const std::string text = small_rods + "harmonics = 3\n" + over_resonance;
  const auto mistake = GENERATE(values<Mistake>({
      {"harmonics = 3", "harmonics = 4", ":11:13", "system.harmonics", "an odd integer from 1 to 255",
       "got 4"},
      {"harmonics = 3", "harmonics = 257", ":11:13", "system.harmonics", "255", "got 257"},
      {"harmonics = 3", "harmonics = 3.0", ":11:13", "system.harmonics", "odd integer", "got 3"},
      {"harmonics = 3", "harmonics = \"all\"", ":11:13", "system.harmonics", "\"auto\"", "all"},
      {"harmonics = 3", "harmonics = [3, 5]", ":11:13", "system.harmonics", "holds 1", ""},
      {"harmonics = 3", "harmonics = [1, 5, 3]", ":11:13", "system.harmonics", "ascends", ""},
      {"harmonics = 3", "harmonics_tolerance = 1e-3", ":11:23", "harmonics_tolerance", "\"auto\"", ""},
  }));
  CHECK_NOTHROW(read_case(folder.write("case.toml", text)));
  const std::string path = folder.write("case.toml", replaced(text, mistake.from, mistake.to));
  check_message(error_of([&] { read_case(path); }), mistake);
}

TEST_CASE("max_seconds bounds the way to the first point, and an interrupt ends it", "[harmonics]") {
  const TemporaryFolder folder;
  const Case input = read_case(folder.write(
      "case.toml", replaced(small_rods, "preload = 0.6", "preload = 0.01") + "harmonics = 127\n" +
                       replaced(over_resonance, "1.4", "2.0") + "[continuation]\nmax_seconds = 1e-3\n"));
  const TracedBranch late = trace(input.branches[0]).front();
  CHECK(late.branch.stop == Stop::time_limit);
  CHECK(late.branch.points.empty());
  CHECK_THAT(late.branch.explanation, ContainsSubstring("on the way from a high preload") &&
                                          ContainsSubstring("max_seconds have passed"));

  CaseBranch request = input.branches[0];
  request.options.max_seconds = 1e3;
  long asked = 0;
  request.options.go_on = [&] { return ++asked < 20; };
  const TracedBranch ended = trace(request).front();
  CHECK(ended.branch.stop == Stop::interrupted);
  CHECK(ended.branch.points.empty());
  CHECK(asked == 20);
  CHECK_THAT(ended.branch.explanation, ContainsSubstring("on the way from a high preload"));
}

TEST_CASE("Harmonics that are found while tracing take no more time than there is", "[harmonics]") {
  const TemporaryFolder folder;
  const Case input =
      read_case(folder.write("case.toml", small_rods + "harmonics = \"auto\"\n" + over_resonance));
  CaseBranch request = input.branches[0];
  long asked = 0;
  request.options.go_on = [&] { return ++asked > 0; };
  REQUIRE(trace(request).front().branch.complete());
  const long needed = asked;
  for (const double part : {0.1, 0.3, 0.5, 0.7, 0.9, 0.99}) {
    asked = 0;
    const auto allowed = static_cast<long>(part * static_cast<double>(needed));
    request.options.go_on = [&] { return ++asked < allowed; };
    CHECK(trace(request).front().branch.stop == Stop::interrupted);
  }
}

TEST_CASE("The program writes what it verifies, and refuses what it cannot", "[harmonics]") {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", small_rods + "harmonics = 3\n" + over_resonance);
  const Outcome done = arcslip_program("run '" + path + "' --verify -o '" + folder.path("out") + "'");
  CHECK(done.status == 0);
  CHECK_THAT(done.out, ContainsSubstring("points solved anew"));
  CHECK_THAT(read(folder.path("out/verify.csv")), ContainsSubstring("Y_time"));
  const Outcome refused =
      arcslip_program("run '" + case_named("limit_cycle") + "' --verify -o '" + folder.path("no") + "'");
  CHECK(refused.status == 1);
  CHECK_THAT(refused.err, ContainsSubstring("--verify is for forced responses, not for limit cycles"));
}

TEST_CASE("A study takes harmonics, listed or found") {
  const TemporaryFolder folder;
  const auto study = [&](const std::string& harmonics) {
    return read_study(folder.write(
        "study.toml", small_rods + "harmonics = " + harmonics +
                          "\n[study]\nparameter = \"P\"\nfrom = 0.1\nto = 10.0\neta = [0.5, 6.0]\n"));
  };
  CHECK(study("[1, 3]").design(0).system.harmonics == std::vector<int>{1, 3});
  CHECK_FALSE(study("3").design(0).harmonics_tolerance);
  CHECK(study("\"auto\"").design(0).harmonics_tolerance == 1e-4);
}
