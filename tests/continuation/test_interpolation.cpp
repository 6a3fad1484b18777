#include "arcslip/continuation/path/interpolation.hpp"

#include <cmath>

#include "arcslip/continuation/path/trace.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// On the curve mu = x^3 - x, the distance of a sample from it: its Newton correction in x.
double distance(const Sample& sample) {
  const double x = sample.unknowns(0), mu = sample.parameters(0);
  const double slope = std::hypot(1, 3 * x * x - 1);
  return std::abs(mu + x - x * x * x) / slope;
}

Branch cusp_branch(double max_step) {
  TraceOptions options = over("mu", -2, 2);
  options.max_step = max_step;
  return trace(Cusp(), {vector_of({-1.5}), vector_of({-2})}, options);
}

struct Quality {
  double worst;   ///< distance from the curve
  double points;  ///< their number
};

/// u = 1/(1 + p^2), whose derivatives grow as those of a resonance do.
struct Bell {
  ScalarProblem problem{
      {"p"},
      [](double u, const Vector& p) { return u - 1 / (1 + p(0) * p(0)); },
      [](double /*u*/, const Vector& /*p*/) { return 1.0; },
      {[](double /*u*/, const Vector& p) { return 2 * p(0) / std::pow(1 + p(0) * p(0), 2); }}};

  Branch branch(double max_step) const {
    TraceOptions options = over("p", -3, 3);
    options.max_step = max_step;
    return trace(problem, {vector_of({0.1}), vector_of({-3})}, options);
  }
  static double error(const Sample& sample) {
    const double p = sample.parameters(0);
    return std::abs(sample.unknowns(0) - 1 / (1 + p * p));
  }
};

Quality quality(double max_step) {
  const Branch branch = Bell().branch(max_step);
  const InterpolatedBranch curve(branch, 0);
  Quality result{0, static_cast<double>(branch.points.size())};
  for (const Sample& sample : curve.resample(1000))
    result.worst = std::max(result.worst, Bell::error(sample));
  return result;
}

}  // namespace

TEST_CASE("Between its points a branch is interpolated with an error of eighth order") {
  const Quality coarse = quality(0.2);
  const Quality fine = quality(0.05);
  CHECK(coarse.worst < 1e-6);
  // The steps do not all shrink alike, so that 8 is not met exactly.
  CHECK(std::log(coarse.worst / fine.worst) / std::log(fine.points / coarse.points) > 7);
}

TEST_CASE("A cubic between its points is met but for rounding, through both of its folds") {
  const Branch branch = cusp_branch(0.1);
  const InterpolatedBranch curve(branch, 0);
  for (const Sample& sample : curve.resample(1000)) CHECK(distance(sample) < 1e-10);
}

TEST_CASE("The estimated error of a sample is above that of the curve, within a factor") {
  const Bell bell;
  const Branch branch = bell.branch(0.2);
  const InterpolatedBranch curve(branch, 0);
  double estimated = 0;
  double found = 0;
  for (const Sample& sample : curve.resample(2000)) {
    estimated = std::max(estimated, sample.error.norm());
    found = std::max(found, Bell::error(sample));
    CHECK(Bell::error(sample) <= sample.error.norm() + 1e-12);
  }
  CHECK(estimated < 30 * found);
}

TEST_CASE("With its problem a branch is sampled by solutions, at arclengths as at values of the parameter") {
  const Bell bell;
  const Branch branch = bell.branch(0.4);
  const InterpolatedBranch curve(branch, 0, &bell.problem);
  for (const Sample& sample : curve.resample(300)) {
    CHECK(Bell::error(sample) < 1e-14);
    CHECK(sample.error.norm() == 0);
  }
  const std::vector<Sample> found = curve.where(0.123);
  REQUIRE(found.size() == 1);
  CHECK(found[0].parameters(0) == 0.123);
  CHECK(Bell::error(found[0]) < 1e-14);
}

TEST_CASE("Parabolas are met between two points, folds as well as peaks, be these needle-sharp") {
  const double width = GENERATE(1.0, 1e-3, 1e-9);  // u = (p/width)^2, or p and u exchanged
  const bool folds = width == 1 && GENERATE(false, true);
  const double from = folds ? 0 : GENERATE(-1.0, 0.0);  // folds are points of a branch
  const auto exchanged = [&](double p, double u) { return folds ? std::pair(u, p) : std::pair(p, u); };
  Branch branch;
  for (const double x : {from, from + 1.5}) {
    BranchPoint& point = branch.points.emplace_back();
    const auto [p, u] = exchanged(x * width, x * x);
    const auto [p_rate, u_rate] = exchanged(width, 2 * x);
    point.unknowns = vector_of({u});
    point.parameters = vector_of({p});
    point.tangent = vector_of({u_rate, p_rate}).normalized();
  }
  const Vector chord = vector_of({branch.points[1].unknowns(0) - branch.points[0].unknowns(0),
                                  branch.points[1].parameters(0) - branch.points[0].parameters(0)});
  branch.points[1].arclength = chord.norm();
  const InterpolatedBranch curve(branch, 0);
  for (const Sample& sample : curve.resample(100)) {
    const auto [p, u] = exchanged(sample.parameters(0), sample.unknowns(0));
    CHECK_THAT(u, WithinAbs(p / width * (p / width), 2e-3));
  }
}

TEST_CASE("At its points the interpolated branch has their values, and in between all crossings of a value") {
  const Branch branch = cusp_branch(0.1);
  const InterpolatedBranch curve(branch, 0);
  for (const BranchPoint& point : branch.points) {
    const Sample sample = curve.at(point.arclength);
    CHECK_THAT(sample.unknowns(0), WithinAbs(point.unknowns(0), 1e-14));
    CHECK_THAT(sample.parameters(0), WithinAbs(point.parameters(0), 1e-14));
  }
  const std::vector<Sample> roots = curve.where(0.1);
  REQUIRE(roots.size() == 3);
  for (const Sample& root : roots) {
    const double x = root.unknowns(0);
    CHECK(root.parameters(0) == 0.1);
    CHECK_THAT(x * x * x - x, WithinAbs(0.1, 1e-4));
  }
  CHECK(curve.where(3).empty());
  CHECK_THROWS_AS(curve.at(curve.end() + 1), std::out_of_range);
  CHECK_THROWS_AS(curve.resample(1), std::invalid_argument);
}

TEST_CASE("A corner is interpolated as a corner") {
  const Branch branch = trace(Corner(1, 3), {vector_of({-1}), vector_of({-1})}, over("p", -1, 3));
  REQUIRE(branch.complete());
  const InterpolatedBranch curve(branch, 0);
  for (const Sample& sample : curve.resample(500)) {
    const double expected = sample.parameters(0) < 0 ? sample.parameters(0) : sample.parameters(0) / 3;
    CHECK_THAT(sample.unknowns(0), WithinAbs(expected, 1e-9));
  }
}

TEST_CASE("A corner within a regime that an event tells of is interpolated as one, either way") {
  const HiddenCorner problem(1, 3);
  const double start = GENERATE(-1.0, 1.0, 3.0);
  TraceOptions options = over("p", -1, 3);
  options.events = {{"corner", [](const Vector& u, const Vector&, const Regime&) { return u(0); },
                     [](const Vector&, const Vector&, const Regime&) { return 0; }}};
  const Branch branch =
      trace_both(problem, {vector_of({start < 0 ? start : start / 3}), vector_of({start})}, options);
  REQUIRE(branch.complete());
  const auto corners = of_type(branch, PointType::event);
  REQUIRE(corners.size() == 1);
  CHECK_THAT(corners[0].arriving()(0) / corners[0].arriving()(1), WithinAbs(1, 1e-9));
  CHECK_THAT(corners[0].tangent(0) / corners[0].tangent(1), WithinAbs(1.0 / 3, 1e-9));
  const InterpolatedBranch curve(branch, 0);
  for (const Sample& sample : curve.resample(500)) {
    const double expected = sample.parameters(0) < 0 ? sample.parameters(0) : sample.parameters(0) / 3;
    CHECK_THAT(sample.unknowns(0), WithinAbs(expected, 1e-9));
  }
}
