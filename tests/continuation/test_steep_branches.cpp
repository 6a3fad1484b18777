// Branches that are nearly vertical and turn within 1e-8: their points, and what lies between them.

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "arcslip/continuation/path/corrector.hpp"
#include "arcslip/continuation/path/interpolation.hpp"
#include "arcslip/problems/response/forced_response.hpp"
#include "catch.hpp"
#include "random_systems.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using arcslip::problems::ForcedResponse;
using arcslip::testing::RandomSystems;

namespace {

struct Response {
  ForcedResponse problem;
  Branch branch;
};

Response response(const SystemParameters& system) {
  Response result{ForcedResponse(build_system(system)), {}};
  TraceOptions options;
  options.parameter = "eta";
  std::tie(options.from, options.to) = arcslip::testing::resonance_range(system);
  options.extrema_of = {"Y"};
  result.branch = trace(result.problem, result.problem.guess(options.from, system.preload), options);
  REQUIRE(result.branch.complete());
  return result;
}

/// How far a sample is from the branch, across it and in the problem's scale, and how far it is said to be.
struct Distance {
  double found;
  double estimated;
};

Distance distance(const ForcedResponse& problem, const InterpolatedBranch& curve, double s, double step) {
  Corrector corrector(problem, ForcedResponse::eta, {});
  CurvePoint point = corrector.make_point();
  const Sample sample = curve.at(s);
  const Sample next = curve.at(std::min(s + 1e-4 * step, curve.end()));
  point.unknowns = sample.unknowns;
  point.parameters = sample.parameters;
  point.regime = sample.regime;
  corrector.set_scale(point);
  const CurvePoint origin = point;
  Vector along(2);
  along << next.unknowns - sample.unknowns, next.parameters(0) - sample.parameters(0);
  along = along.cwiseQuotient(origin.scale).normalized();
  const bool converged = corrector.correct(point, origin, along, 0, true) == Correction::converged;
  Vector away(2);
  corrector.difference(point, origin, away);
  const double infinite = std::numeric_limits<double>::infinity();
  return {converged ? away.norm() : infinite, sample.error.cwiseQuotient(origin.scale).norm()};
}

}  // namespace

TEST_CASE("Between the points of random responses the curve stays on the branch, as near as it says") {
  constexpr double shortest = 1e-7;  // below, tips of needles are passed as corners
  RandomSystems random(7);
  long samples = 0;
  long beyond = 0;
  for (int i = 0; i < 60; ++i) {
    const auto [problem, branch] = response(random.system());
    const InterpolatedBranch curve(branch, ForcedResponse::eta);
    for (std::size_t k = 0; k + 1 < branch.points.size(); ++k) {
      const BranchPoint& from = branch.points[k];
      const double length = branch.points[k + 1].arclength - from.arclength;
      if (length < shortest) continue;
      const double run = branch.points[k + 1].parameters(0) - from.parameters(0);
      CAPTURE(i, from.parameters(0), run, length);
      for (const double part : {0.2, 0.5, 0.8}) {
        const double s = from.arclength + part * length;
        const double place = (curve.at(s).parameters(0) - from.parameters(0)) / run;
        CHECK((place > -1e-9 && place < 1 + 1e-9));
        const Distance apart = distance(problem, curve, s, length);
        ++samples;
        if (!std::isfinite(apart.found)) {  // where it is steepest, what is across the branch is not known
          ++beyond;
          continue;
        }
        CHECK(apart.found < 1e-3);
        CHECK(apart.found < 100 * apart.estimated + 1e-8);
        beyond += static_cast<long>(apart.found > 5 * apart.estimated + 1e-9);
      }
    }
  }
  CHECK(samples > 20000);
  CHECK(beyond < 1e-3 * static_cast<double>(samples));
}

TEST_CASE("Beside a landmark the curve does not leave its segment") {
  SystemParameters rods{
      .model = StructureModel::rods, .mass_ratio = 5, .frequency_ratio = 4, .interface_stiffness = 1000};
  rods.preload = GENERATE(0.1, 1.0, 10.0);
  const auto [problem, branch] = response(rods);
  const InterpolatedBranch curve(branch, ForcedResponse::eta);
  double worst = 0;  // beyond the segment, in its lengths
  for (std::size_t k = 0; k + 1 < branch.points.size(); ++k) {
    const double from = branch.points[k].parameters(0);
    const double run = branch.points[k + 1].parameters(0) - from;
    const double s = branch.points[k].arclength;
    const double length = branch.points[k + 1].arclength - s;
    if (length < 1e-7) continue;
    for (int j = 1; j < 20; ++j) {
      const double place = (curve.at(s + j / 20.0 * length).parameters(0) - from) / run;
      worst = std::max({worst, -place, place - 1});
    }
  }
  CHECK(worst < 1e-9);
}

TEST_CASE("Points of steep responses solve at the parameter that they tell, but for rounding") {
  RandomSystems random(11);
  double worst = 0;
  for (int i = 0; i < 40; ++i) {
    const auto [problem, branch] = response(random.system());
    Linearization at(problem);
    for (const BranchPoint& point : branch.points) {
      REQUIRE(at.evaluate(point.unknowns, point.parameters, point.regime));
      const double rounding = 3e-14 / std::abs(at.jacobian()(0, 0));  // F has terms of up to a hundred
      const double correction = std::abs(at.residual()(0) / at.jacobian()(0, 0));
      worst = std::max(worst, correction / std::max(1e-10, rounding));
    }
  }
  CHECK(worst < 1);
}
