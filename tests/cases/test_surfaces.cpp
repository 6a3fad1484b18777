// Surfaces over two parameters that cases ask for.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "arcslip/continuation/points/normal_form.hpp"
#include "case_runs.hpp"
#include "results/atlas_table.hpp"

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

/// A case file with another [branch].
CaseFile file_with(const std::string& name, const std::string& branch, const Settings& settings) {
  const std::string path = source_folder() + "/problems/" + name + ".toml";
  std::ifstream file(path);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  text.resize(text.find("[branch]"));
  return CaseFile::of_text(path, text + "[branch]\n" + branch, settings);
}

TracedBranch surface_of(const std::string& name, const std::string& branch, const Settings& settings) {
  return trace(plan_case(file_with(name, "surface = true\n" + branch, settings)).branch(0)).front();
}

/// An oscillator with damping c1 v + c3 v^3 + c5 v^5 [G. Habib, G. Cirillo & G. Kerschen, Nonlinear Dyn. 93
/// (2018) 979] in one harmonic: |F| = v (c1 + 3/4 c3 v^2 + 5/8 c5 v^4) at its resonance W = 1, where the
/// response over W is born or merges with another one as that is extremal over v. Here at v^2 = 1 and 2.
const std::string damped_oscillator = R"case(
[model]
kind = "algebraic"
[model.parameters]
W = 0.5
F = 0.065
[model.definitions]
s = "W^2*(A^2 + B^2)"
h = "0.1 - 0.05*s + 0.01*s^2"
[model.equations]
A = "(1 - W^2)*A + W*h*B - F"
B = "(1 - W^2)*B - W*h*A"
[model.start]
A = 0.08
B = 0.005
[branch]
)case";

std::vector<TracedBranch> of_oscillator(const std::string& branch) {
  const std::string path = source_folder() + "/problems/oscillator.toml";
  return trace(plan_case(CaseFile::of_text(path, damped_oscillator + branch)).branch(0));
}

struct IsolaAt {
  std::string type;
  Vector at;  // unknowns, then both parameters
};

/// The isola centres and simple bifurcations of curves of folds.
std::vector<IsolaAt> isolas_of(const std::vector<TracedBranch>& curves) {
  std::vector<IsolaAt> turns;
  for (const TracedBranch& traced : curves) {
    CHECK(traced.branch.complete());
    for (const BranchPoint& point : traced.branch.points) {
      if (point.type != PointType::isola_centre && point.type != PointType::simple_bifurcation) continue;
      const auto at = traced.curve->split(point.unknowns, point.parameters, point.regime);
      Vector all(at.unknowns.size() + 2);
      all << at.unknowns, at.parameters.head(2);
      turns.push_back({std::string(to_string(point.type)), all});
    }
  }
  return turns;
}

/// Those of a surface, in the second parameter.
std::vector<IsolaAt> isolas_of(const TracedBranch& traced) {
  std::vector<IsolaAt> turns;
  CHECK(traced.surface->complete());
  for (const continuation::AtlasFold& fold : traced.surface->folds) {
    if (fold.turns != 1) continue;
    Vector all(fold.unknowns.size() + 2);
    all << fold.unknowns, fold.parameters.head(2);
    turns.push_back({std::string(to_string(fold.type)), all});
  }
  return turns;
}

/// Checks that there is one of a type, and where.
void check_isola(const std::vector<IsolaAt>& turns, const std::string& type, const Vector& at) {
  INFO(type);
  CHECK(std::count_if(turns.begin(), turns.end(), [&](const IsolaAt& turn) { return turn.type == type; }) ==
        1);
  for (const IsolaAt& turn : turns) {
    if (turn.type == type) CHECK((turn.at - at).cwiseAbs().maxCoeff() < 1e-9 * at.cwiseAbs().maxCoeff());
  }
}

Vector place_of(std::initializer_list<double> given) {
  Vector all(std::ssize(given));
  std::copy(given.begin(), given.end(), all.begin());
  return all;
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
  CHECK(refused({"branch.extrema_of=[\"z\"]"}).find("names among \"x\", \"y\"") != std::string::npos);
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

TEST_CASE(
    "Isolas of autocatalysis are born and merge at the published values, on curves and on the surface") {
  const auto check = [](const std::vector<IsolaAt>& turns) {
    CHECK(turns.size() == 2);
    for (const auto& [type, z, k] :
         {std::tuple{"isola_centre", 0.4, 0.0864}, {"simple_bifurcation", 0.1, 0.0729}})
      check_isola(turns, type, place_of({1 - z, (z + 0.08) / 2, 1 / k, k}));  // k tau = 1
  };
  check(isolas_of(Run("autocatalysis_isolas").traced));
  check(
      isolas_of(surface_of("autocatalysis_isolas",
                           "parameters = [\"tau\", \"k\"]\nwindow = [1, 80]\nfrom = 0.05\nto = 0.1\n", {})));
}

TEST_CASE("A detached resonance is born and merges where its force is extremal at phase resonance") {
  const double born = 0.04 * std::sqrt(2.0);
  const auto check = [&](const std::vector<IsolaAt>& turns) {
    CHECK(turns.size() == 2);
    check_isola(turns, "isola_centre", place_of({0, std::sqrt(2.0), 1, born}));
    check_isola(turns, "simple_bifurcation", place_of({0, 1, 1, 0.06}));
  };
  const std::string ranges = "parameters = [\"W\", \"F\"]\nwindow = [0.5, 1.5]\nfrom = 0.05\nto = 0.07\n";
  check(isolas_of(of_oscillator("curve = \"fold\"\n" + ranges)));
  const TracedBranch surface = of_oscillator("surface = true\n" + ranges).front();
  check(isolas_of(surface));
  const nlohmann::ordered_json told = surface_to_json(surface);
  CHECK(told.at("isola_centres") == 1);
  CHECK(told.at("simple_bifurcations") == 1);
  CHECK(told.at("ridges").get<int>() > 0);
  CHECK(told.at("special").size() == 4);  // with two cusps
  for (const auto& special : told.at("special")) {
    CHECK(special.value("turns", "") == (special.at("type") == "cusp" ? "" : "F"));
    CHECK(special.contains("B"));
  }
  CHECK_THAT(surface_sentence(told), ContainsSubstring("2 cusps, 1 isola centre, 1 simple bifurcation and "));
  CHECK(folds_header(surface) == "branch,fold_curve,point,type,turns,W,F,A,B\n");
  CHECK_THAT(fold_rows(0, surface), ContainsSubstring(",isola_centre,F,1,"));
  CHECK(ridges_header(surface) == "branch,ridge,point,type,observable,W,F,A,B\n");
  CHECK_THAT(ridge_rows(0, surface), ContainsSubstring(",peak,A,"));
}

TEST_CASE("The ridge of a Duffing response over frequency and force is the curve of its peaks") {
  const std::string ranges =
      "parameters = [\"eta\", \"F\"]\nwindow = [0.127, 0.223]\nfrom = 0.01\nto = 0.2\n";
  const TracedBranch traced = surface_of("nlvib_duffing_pair", ranges, {"system.harmonics=1"});
  REQUIRE(traced.surface);
  const auto& ridges = traced.surface->ridges;
  CHECK(ridges.size() > 20);
  std::vector<double> forces;
  const Index eta = continuation::index_of(traced.base.problem->parameter_names(), "eta");
  const Index force = continuation::index_of(traced.base.problem->parameter_names(), "F");
  std::vector<const continuation::AtlasRidge*> chosen;
  for (const auto& ridge : ridges) {
    CHECK(ridge.observable == "Y");
    const double value = ridge.parameters(force);
    if (ridge.type == PointType::peak && value > 0.02 && value < 0.19) chosen.push_back(&ridge);
  }
  std::string listed;
  for (std::size_t i = 0; i < chosen.size(); i += 7)
    listed += fmt::format("{:.17g},", chosen[i]->parameters(force));
  listed.pop_back();
  const CaseFile file = file_with("nlvib_duffing_pair", "curve = \"peak\"\n" + ranges,
                                  {"system.harmonics=1", "continuation.stop_at=[" + listed + "]"});
  const std::vector<TracedBranch> curves = trace(plan_case(file).branch(0));
  for (std::size_t i = 0; i < chosen.size(); i += 7) {
    double nearest = 1;
    for (const TracedBranch& curve : curves) {
      for (const BranchPoint& point : curve.branch.points) {
        const auto at = curve.curve->split(point.unknowns, point.parameters, point.regime);
        if (std::abs(at.parameters(force) / chosen[i]->parameters(force) - 1) > 1e-12) continue;
        nearest = std::min(nearest, std::abs(at.parameters(eta) / chosen[i]->parameters(eta) - 1));
      }
    }
    CHECK(nearest < 1e-8);
  }
}
