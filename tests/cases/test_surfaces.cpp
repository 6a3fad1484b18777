// Surfaces over two parameters that cases ask for.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "arcslip/continuation/points/normal_form.hpp"
#include "case_runs.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

/// Every so many folds of a surface solved for anew, by their extended problem at the second parameter: how
/// far they move, relative.
double moved_folds(const TracedBranch& traced, const std::string& active, std::size_t every) {
  const continuation::Problem& problem = *traced.base.problem;
  const Index first = continuation::index_of(problem.parameter_names(), active);
  double worst = 0;
  for (std::size_t i = every / 2; i < traced.surface->folds.size(); i += every) {
    const continuation::AtlasFold& fold = traced.surface->folds[i];
    if (fold.type != PointType::fold) continue;
    continuation::FoldProblem folds(problem, first);
    const auto found = continuation::locate(folds, {fold.unknowns, fold.parameters, {}, {}});
    REQUIRE(found);
    worst = std::max(worst, std::abs(found->point.parameters(first) / fold.parameters(first) - 1));
  }
  return worst;
}

/// Of a case file with another [branch].
TracedBranch surface_of(const std::string& name, const std::string& branch, const Settings& settings) {
  const std::string path = source_folder() + "/problems/" + name + ".toml";
  std::ifstream file(path);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  text.resize(text.find("[branch]"));
  const CaseFile read = CaseFile::of_text(path, text + "[branch]\nsurface = true\n" + branch, settings);
  return trace(plan_case(read).branch(0)).front();
}

}  // namespace

TEST_CASE("Ignition and extinction of a stirred tank meet in the cusp of closed form") {
  const Run run("tank_surface");
  REQUIRE(run.traced.size() == 1);
  const TracedBranch& traced = run.traced.front();
  REQUIRE(traced.surface);
  CHECK(traced.branch.stop == Stop::reached_end);
  const continuation::Atlas& surface = *traced.surface;
  CHECK(surface.complete());
  CHECK(surface.components.size() == 1);
  CHECK(surface.components.front().euler == 1);
  int cusps = 0;
  for (const continuation::AtlasFold& fold : surface.folds) {
    const double x = fold.unknowns(0);
    const double heat = fold.parameters(1);
    CHECK(std::abs(heat / 4 * x * (1 - x) - 1) < 1e-9);  // B x (1 - x) = 1
    CHECK(std::abs(fold.parameters(0) / (x / (1 - x) * std::exp(-heat * x / 4)) - 1) < 1e-9);
    CHECK(heat <= 24);
    if (fold.type != PointType::cusp) continue;
    ++cusps;
    CHECK(std::abs(heat - 16) < 1e-9);
    CHECK(std::abs(fold.parameters(0) - std::exp(-2.0)) < 1e-10);
  }
  CHECK(cusps == 1);
  CHECK(surface.folds.front().parameters(1) == 24);  // on the box's side
  CHECK(surface.folds.back().parameters(1) == 24);
}

TEST_CASE("Begun where there are three states, by all solutions, a surface is covered once") {
  const Run run("tank_surface",
                {"branch.all_solutions=true", "model.parameters.p1=0.065", "model.parameters.p2=22"});
  REQUIRE(run.traced.front().surface);
  CHECK(run.traced.front().solutions->count == 3);
  CHECK(run.traced.front().surface->complete());
  CHECK(run.traced.front().surface->components.size() == 1);
}

TEST_CASE("The response of two Duffing oscillators over frequency and force has the folds of its branches") {
  const TracedBranch traced = surface_of("nlvib_duffing_pair",
                                         "parameters = [\"eta\", \"F\"]\nwindow = [0.127, 0.223]\n"
                                         "from = 0.01\nto = 0.2\n",
                                         {"system.harmonics=1"});
  REQUIRE(traced.surface);
  INFO(traced.branch.explanation);
  CHECK(traced.surface->complete());
  CHECK(traced.surface->components.size() == 1);
  CHECK(traced.surface->folds.size() > 50);
  CHECK(moved_folds(traced, "eta", 10) < 1e-9);
}

TEST_CASE("A surface with friction is covered in the piece where it begins, and told to end there") {
  const TracedBranch traced = surface_of("cubic_response",
                                         "parameters = [\"eta\", \"P\"]\nwindow = [0.5, 12.0]\n"
                                         "from = 0.01\nto = 10.0\n",
                                         {"system.preload=0.3"});
  REQUIRE(traced.surface);
  CHECK(traced.branch.stop == Stop::min_step);
  CHECK(traced.branch.explanation.find("the surface leaves its regime") != std::string::npos);
  const continuation::Problem& problem = *traced.base.problem;
  for (const continuation::Chart& chart : traced.surface->charts)
    CHECK(continuation::crossed_border(problem, chart.unknowns, chart.parameters, {}, 1e-8) < 0);
}

TEST_CASE("Requests for surfaces that do not fit are refused") {
  const auto refused = [](const Settings& settings) {
    try {
      read_case(source_folder() + "/problems/tank_surface.toml", settings);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refused({"branch.curve=fold"}).find("branch.surface: not beside curve") != std::string::npos);
  CHECK(refused({"branch.surface=false"}).find("branch.parameter") != std::string::npos);
  CHECK(refused({"branch.extrema_of=[\"x\"]"}).find("not beside surface") != std::string::npos);
  CHECK(refused({"branch.from=20"}).find("which is not between 20 and 24") != std::string::npos);
}

TEST_CASE("Surfaces of cycles and of many unknowns are refused") {
  CHECK_THROWS_WITH(surface_of("forced_duffing",
                               "parameters = [\"W\", \"force\"]\nwindow = [0.5, 2]\nfrom = 1\nto = 2\n", {}),
                    ContainsSubstring("branch.surface") && ContainsSubstring("not of cycles"));
  const TracedBranch large = surface_of(
      "brusselator_1d", "parameters = [\"L\", \"A\"]\nwindow = [0.3, 0.5]\nfrom = 1.9\nto = 2.1\n", {});
  CHECK(large.branch.stop == Stop::no_start);
  CHECK_THAT(large.branch.explanation, ContainsSubstring("up to 100 unknowns, and there are 998"));
}
