// Branches as polylines, against the same branches traced with steps so small that these are drawn
// themselves.

#include "arcslip/continuation/path/polyline.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/curves/curve.hpp"
#include "arcslip/problems/response/forced_response.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"
#include "library_cases.hpp"
#include "random_systems.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

/// A panel of a picture: a range of the parameter, and of an observable that is shown over it.
struct Panel {
  double low, high;
  bool logarithmic;
  static constexpr double width = 800, height = 640;  // pixels: 6.8 x 5.4 cm at 300 dots per inch
};

using Points = std::vector<std::pair<double, double>>;

Points shown(const Problem& problem, const Branch& branch, Index parameter, Index observable) {
  Points points;
  Vector values;
  for (const BranchPoint& point : branch.points) {
    problem.observe(point.unknowns, point.parameters, point.regime, values);
    points.emplace_back(point.parameters(parameter), values(observable));
  }
  return points;
}

/// `looked_at` is the problem that what is filled in is looked at with.
Branch filled(const Problem& problem, const Branch& branch, Index parameter,
              const Problem* looked_at = nullptr) {
  std::vector<double> values;
  Vector observed;
  Branch result;
  const auto drawn = [&](const BranchPoint& point) -> const std::vector<double>& {
    problem.observe(point.unknowns, point.parameters, point.regime, observed);
    values.assign(observed.begin(), observed.end());
    return values;
  };
  result.points = polyline(branch, parameter, drawn, looked_at).points;
  return result;
}

/// The farthest that a point of `dense` in the panel is from the polyline, in pixels.
double farthest(const Points& polyline, const Points& dense, const Panel& panel) {
  double low = 1e300, high = -1e300;
  for (const auto& [x, y] : dense) {
    if (x < panel.low || x > panel.high) continue;
    low = std::min(low, y);
    high = std::max(high, y);
  }
  const auto place = [&](const std::pair<double, double>& point) {
    const double up = panel.logarithmic ? std::log(point.second / low) / std::log(high / low)
                                        : (point.second - low) / (high - low);
    return Eigen::Vector2d(Panel::width * (point.first - panel.low) / (panel.high - panel.low),
                           Panel::height * up);
  };
  double worst = 0;
  std::size_t near = 0;  // the branch runs along both in the same order
  for (const auto& point : dense) {
    if (point.first < panel.low || point.first > panel.high) continue;
    const Eigen::Vector2d p = place(point);
    double least = 1e300;
    for (std::size_t k = near; k + 1 < polyline.size(); ++k) {
      const Eigen::Vector2d a = place(polyline[k]);
      const Eigen::Vector2d along = place(polyline[k + 1]) - a;
      const double part = along.squaredNorm() > 0 ? (p - a).dot(along) / along.squaredNorm() : 0;
      const double away = (a + std::clamp(part, 0.0, 1.0) * along - p).norm();
      if (away < least) {
        least = away;
        near = k;
      }
      if (least < 1 && away > 100) break;
    }
    worst = std::max(worst, least);
  }
  return worst;
}

}  // namespace

TEST_CASE("The polyline of a needle is within a pixel of it, enlarged as it may be") {
  const double width = GENERATE(1e-2, 1e-4, 1e-6);
  const Needle needle(width);
  TraceOptions options = over("p", 0.5, 2);
  options.extrema_of = {"amplitude"};
  const Guess guess{vector_of({std::log(2 * width)}), vector_of({0.5})};
  const Branch branch = trace(needle, guess, options);
  REQUIRE(branch.complete());
  const Points drawn = shown(needle, filled(needle, branch, 0), 0, 0);
  options.max_step = 2e-4;
  const Points dense = shown(needle, trace(needle, guess, options), 0, 0);
  for (const bool logarithmic : {false, true}) {
    for (const double half : {0.4, 6e-3, std::max(10 * width, 1e-3)}) {  // pictures enlarge to 0.8 %
      CAPTURE(width, logarithmic, half);
      CHECK(farthest(drawn, dense, {1 - half, 1 + half, logarithmic}) < 1);
    }
  }
  CHECK(drawn.size() < 8 * branch.points.size());
}

TEST_CASE("The polyline of a curve with few points is within a pixel of it") {
  const Instance lorenz("lorenz84", {{"T", 0.04}});
  TraceOptions options = over("F", 3, 1);
  const Branch branch = lorenz.trace(options);
  const auto hopfs = of_type(branch, PointType::hopf);
  REQUIRE(hopfs.size() == 3);
  for (const BranchPoint& hopf : hopfs) {
    const CurveStart start = curve_through(*lorenz.problem, "F", hopf);
    options = over("T", 1e-4, 0.1);
    const CurveWindow window{1, 3};
    const Branch curve = trace_curve(*start.problem, start.point, options, window);
    REQUIRE(curve.complete());
    const Index second = index_of(start.problem->parameter_names(), "T");
    const Branch drawn = filled(*start.problem, curve, second);
    options.max_step = 2e-3;
    const Branch small_steps = trace_curve(*start.problem, start.point, options, window);
    const Index observables = std::ssize(start.problem->observables());
    for (Index i = 0; i < observables; ++i) {
      CAPTURE(i, curve.points.size(), drawn.points.size());
      const Points dense = shown(*start.problem, small_steps, second, i);
      CHECK(farthest(shown(*start.problem, drawn, second, i), dense, {1e-4, 0.1, false}) < 1);
    }
  }
}

TEST_CASE("Polylines of random responses are within a pixel of them, also where peaks are enlarged",
          "[numbers]") {
  RandomSystems random(5);
  for (int i = 0; i < 8; ++i) {
    const SystemParameters system = random.system();
    const problems::ForcedResponse problem(build_system(system));
    const auto [from, to] = resonance_range(system);
    TraceOptions options = over("eta", from, to);
    options.extrema_of = {"Y"};
    const Guess guess = problem.guess(from, system.preload);
    const Branch branch = trace(problem, guess, options);
    REQUIRE(branch.complete());
    options.max_step = 2e-3;
    const Branch small_steps = trace(problem, guess, options);
    const Points drawn = shown(problem, filled(problem, branch, 0), 0, problems::ForcedResponse::Y);
    const Points dense = shown(problem, small_steps, 0, problems::ForcedResponse::Y);
    CAPTURE(i, drawn.size(), branch.points.size());
    CHECK(farthest(drawn, dense, {from, to, true}) < 1);
    for (const BranchPoint& peak : of_type(branch, PointType::peak)) {
      const double half = 0.004 * (to - from);
      CHECK(farthest(drawn, dense, {peak.parameters(0) - half, peak.parameters(0) + half, true}) < 1);
    }
    CHECK(drawn.size() < 16 * branch.points.size());  // steps are long where the contact sticks
  }
}

TEST_CASE("What the points of a branch do not tell is solved for, or left out") {
  // u = x + depth tanh((x - 0.3)/width), which has no value where it is steep, if it is not to have one.
  constexpr double width = 0.02, depth = 0.2;
  const bool has_values = GENERATE(true, false);
  const auto u_at = [](double p) { return p + depth * std::tanh((p - 0.3) / width); };
  const auto slope_at = [](double p) {
    return 1 + depth / width / std::pow(std::cosh((p - 0.3) / width), 2);
  };
  const ScalarProblem step(
      {"p"},
      [=](double u, const Vector& p) {
        return has_values || std::abs(p(0) - 0.3) > 0.25 ? u - u_at(p(0)) : std::nan("");
      },
      [](double, const Vector&) { return 1.0; }, {[=](double, const Vector& p) { return -slope_at(p(0)); }});
  Branch branch;
  for (const double p : {-0.5, 0.0, 0.32, 1.0}) {
    BranchPoint& point = branch.points.emplace_back();
    point.unknowns = vector_of({u_at(p)});
    point.parameters = vector_of({p});
    point.tangent = vector_of({slope_at(p), 1}).normalized();
    if (branch.points.size() == 1) continue;
    const BranchPoint& last = branch.points.end()[-2];
    point.arclength = last.arclength + std::hypot(point.unknowns(0) - last.unknowns(0),
                                                  point.parameters(0) - last.parameters(0));
  }
  const Branch drawn = filled(step, branch, 0, &step);
  const auto between = std::count_if(drawn.points.begin(), drawn.points.end(), [](const BranchPoint& point) {
    return point.parameters(0) > 0 && point.parameters(0) < 0.32;
  });
  CAPTURE(has_values, between);
  CHECK((has_values ? between > 10 : between == 0));
  for (const BranchPoint& point : drawn.points)
    CHECK_THAT(point.unknowns(0), WithinAbs(u_at(point.parameters(0)), 1e-3));
}

TEST_CASE("A polyline keeps all points, corners among them, and the counts of what is unstable") {
  const Branch corner = trace(Corner(1, 3), {vector_of({-1}), vector_of({-1})}, over("p", -1, 3));
  const Branch drawn = filled(Corner(1, 3), corner, 0);
  CHECK(drawn.points.size() == corner.points.size());  // it is straight
  Branch single = corner;
  single.points.resize(1);
  CHECK(filled(Corner(1, 3), single, 0).points.size() == 1);

  const Instance cusp("cusp");
  const Branch branch = cusp.trace(over("mu", -2, 2));
  const Branch curve = filled(*cusp.problem, branch, 0);
  std::size_t next = 0;
  for (const BranchPoint& point : curve.points) {
    if (next < branch.points.size() && point.arclength == branch.points[next].arclength) ++next;
    const bool between_folds = std::abs(point.unknowns(0)) < std::sqrt(1.0 / 3) - 1e-6;
    if (point.type == PointType::regular) CHECK(point.unstable == (between_folds ? 1 : 0));
  }
  CHECK(next == branch.points.size());
}

TEST_CASE("What is drawn is looked at where that is open, and what is rounding is not drawn") {
  const Needle needle(1e-4);
  const Branch branch = trace(needle, {vector_of({std::log(2e-4)}), vector_of({0.5})}, over("p", 0.5, 2));
  std::vector<double> values(1);
  std::size_t looks = 0;
  const auto points = [&](const auto& value) {
    looks = 0;
    const auto drawn = [&](const BranchPoint& point) -> const std::vector<double>& {
      ++looks;
      values[0] = value(point);
      return values;
    };
    return polyline(branch, 0, drawn).points.size();
  };
  const std::size_t count = points([](const BranchPoint& point) { return std::exp(point.unknowns(0)); });
  CHECK(count > 3 * branch.points.size());
  CHECK(looks < 3 * count / 2);
  // A limit that a sum of large numbers only has to their rounding.
  const auto limit = [](const BranchPoint& point) { return 1 + 1e-11 * std::sin(1e6 * point.parameters(0)); };
  CHECK(points(limit) == branch.points.size());
  const auto wave = [](const BranchPoint& point) { return 1 + 1e-8 * std::sin(20 * point.parameters(0)); };
  CHECK(points(wave) > branch.points.size());
}
