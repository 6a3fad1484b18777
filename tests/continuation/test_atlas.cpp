// Surfaces of solutions over two parameters, covered by charts.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "arcslip/continuation/atlas/atlas.hpp"
#include "catch.hpp"
#include "engine_problems.hpp"
#include "level_set.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

ScalarProblem sphere() {
  return level_set([](const Place& z) { return z.squaredNorm() - 1; }, [](const Place& z) { return 2 * z; });
}

ScalarProblem torus(double r) {
  const auto sum = [r](const Place& z) { return z.squaredNorm() + 1 - r * r; };
  return level_set([=](const Place& z) { return sum(z) * sum(z) - 4 * (z(1) * z(1) + z(2) * z(2)); },
                   [=](const Place& z) { return Place(4 * sum(z) * z - 8 * Place(0, z(1), z(2))); });
}

ScalarProblem catastrophe(double size = 1) {
  return level_set([](const Place& z) { return z(0) * z(0) * z(0) - z(2) * z(0) - z(1); },
                   [](const Place& z) { return Place(3 * z(0) * z(0) - z(2), -1, -z(0)); }, size);
}

ScalarProblem plane() {
  return level_set([](const Place& z) { return z(0) - 0.3 * z(1) + 0.2 * z(2); },
                   [](const Place&) { return Place(1, -0.3, 0.2); });
}

/// Areas of all triangles as vectors.
std::vector<Place> areas(const Atlas& atlas, double size = 1) {
  std::vector<Place> all;
  for (const std::array<int, 3>& face : atlas.faces) {
    std::array<Place, 3> corner;
    for (std::size_t i = 0; i < 3; ++i) {
      const Chart& chart = atlas.charts[static_cast<std::size_t>(face[i])];
      corner[i] = {chart.unknowns(0) / size, chart.parameters(0), chart.parameters(1)};
    }
    all.push_back((corner[1] - corner[0]).eval().cross((corner[2] - corner[0]).eval()) / 2);
  }
  return all;
}

double area(const Atlas& atlas) {
  double sum = 0;
  for (const Place& one : areas(atlas)) sum += one.norm();
  return sum;
}

/// Of the triangles' shadows on both parameters, with their signs.
double shadow(const Atlas& atlas) {
  double sum = 0;
  for (const Place& one : areas(atlas)) sum += one(0);
  return std::abs(sum);
}

long count(const Atlas& atlas, PointType type) {
  return std::count_if(atlas.folds.begin(), atlas.folds.end(),
                       [&](const AtlasFold& fold) { return fold.type == type; });
}

/// Checks the folds of the cusp surface and its cusp.
void check_cusp(const Atlas& atlas, double size = 1) {
  INFO(atlas.reason);
  REQUIRE(atlas.complete());
  CHECK(atlas.components.size() == 1);
  CHECK(atlas.components.front().euler == 1);
  CHECK(std::abs(shadow(atlas) - 4) < 1e-12);  // the box, whole
  CHECK(count(atlas, PointType::cusp) == 1);
  CHECK(atlas.folds.size() > 20);
  for (const AtlasFold& fold : atlas.folds) {
    const double p = fold.parameters(0);
    const double q = fold.parameters(1);
    CHECK(std::abs(27 * p * p - 4 * q * q * q) < 1e-12);
    CHECK(std::abs(3 * std::pow(fold.unknowns(0) / size, 2) - q) < 1e-12);
    if (fold.type == PointType::cusp) CHECK(std::hypot(p, q, fold.unknowns(0) / size) < 1e-12);
  }
}

}  // namespace

TEST_CASE("A sphere is closed, with Euler number 2, and its area converges with the square of the radius") {
  std::vector<double> errors;
  for (const double radius : {0.08, 0.04, 0.02}) {
    const Atlas atlas = cover(sphere(), {start(0, 1, 0)}, box(1.2, radius));
    REQUIRE(atlas.complete());
    REQUIRE(atlas.components.size() == 1);
    CHECK(atlas.components.front().closed);
    CHECK(atlas.components.front().euler == 2);
    CHECK(shadow(atlas) < 1e-13);
    errors.push_back(4 * pi - area(atlas));
    for (const AtlasFold& fold : atlas.folds) CHECK(std::abs(fold.parameters.norm() - 1) < 1e-12);
    CHECK(atlas.folds.front().parameters.isApprox(atlas.folds.back().parameters, 1e-12));  // round
  }
  CHECK(std::abs(std::log2(errors[0] / errors[1]) - 2) < 0.1);
  CHECK(std::abs(std::log2(errors[1] / errors[2]) - 2) < 0.1);
}

TEST_CASE("A sphere that touches the box or is cut by it is covered as far as the box goes") {
  const Atlas touching = cover(sphere(), {start(1, 0, 0)}, box(1));
  INFO(touching.reason);
  REQUIRE(touching.complete());
  CHECK(touching.components.front().euler == 2);
  const Atlas cut = cover(sphere(), {start(1, 0, 0)}, box(0.8));
  REQUIRE(cut.complete());
  CHECK(cut.components.front().euler == -2);  // four holes
  CHECK(!cut.components.front().closed);
  for (const Chart& chart : cut.charts) CHECK(chart.parameters.cwiseAbs().maxCoeff() <= 0.8);
}

TEST_CASE("A torus has Euler number 0 and one component") {
  const Atlas atlas = cover(torus(0.4), {start(0, 1.4, 0)}, box(1.5));
  REQUIRE(atlas.complete());
  REQUIRE(atlas.components.size() == 1);
  CHECK(atlas.components.front().closed);
  CHECK(atlas.components.front().euler == 0);
  CHECK(std::abs(area(atlas) / (4 * pi * pi * 0.4) - 1) < 5e-3);
}

TEST_CASE("A plane is cut exactly by the box, whatever the radius and the start") {
  for (const double radius : {0.5, 0.3, 0.1, 0.07}) {
    for (const auto& [p, q] : {std::pair{0.0, 0.0}, {-1.0, 0.3}, {1.0, 0.0}, {-1.0, -1.0}, {1.0, -1.0}}) {
      const Atlas atlas = cover(plane(), {start(0.3 * p - 0.2 * q, p, q)}, box(1, radius));
      INFO(radius << ' ' << p << ' ' << q << ' ' << atlas.reason);
      CHECK(atlas.complete());
      CHECK(std::abs(shadow(atlas) - 4) < 1e-12);
      CHECK(atlas.components.front().euler == 1);
      CHECK(atlas.folds.empty());
      CHECK(static_cast<double>(atlas.charts.size()) < 1.3 * std::pow(1 / radius + 1.5, 2));
    }
  }
}

TEST_CASE("Folds of the cusp surface lie on 27 p^2 = 4 q^3, from starts anywhere") {
  check_cusp(cover(catastrophe(), {start(0.5, 0.125, 0)}, box(1)));
  check_cusp(cover(catastrophe(), {start(0, 0, 0)}, box(1)));                  // on the cusp
  check_cusp(cover(catastrophe(), {start(0.3, -2 * 0.027, 0.27)}, box(1)));    // on a fold
  check_cusp(cover(catastrophe(), {start(1.324717957244746, 1, 1)}, box(1)));  // on a corner
  check_cusp(cover(catastrophe(), {start(0, 0, 1)}, box(1)));                  // on a side
}

TEST_CASE("Unknowns may be of any size") {
  for (const double size : {1e6, 1e-6}) {
    check_cusp(cover(catastrophe(size), {start(0.5 * size, 0.125, 0)}, box(1)), size);
    check_cusp(cover(catastrophe(size), {start(0, 0, 0)}, box(1)), size);
  }
}

TEST_CASE("Sheets closer than a chart's radius are not glued") {
  const ScalarProblem flat = level_set([](const Place& z) { return z(0) * z(0) - 1e-6; },
                                       [](const Place& z) { return Place(2 * z(0), 0, 0); });
  const Atlas two = cover(flat, {start(1e-3, 0, 0), start(-1e-3, 0, 0), start(1e-3, 0.5, 0.5)}, box(1));
  REQUIRE(two.complete());
  CHECK(two.components.size() == 2);
  for (const Chart& chart : two.charts) CHECK((chart.unknowns(0) > 0) == (chart.component == 0));
  const ScalarProblem bent = level_set([](const Place& z) { return z(0) * z(0) - 1e-4 - z(1) * z(1); },
                                       [](const Place& z) { return Place(2 * z(0), -2 * z(1), 0); });
  const Atlas near = cover(bent, {start(1e-2, 0, 0), start(-1e-2, 0, 0)}, box(0.1));
  INFO(near.reason);
  REQUIRE(near.complete());
  CHECK(near.components.size() == 2);
  CHECK(near.folds.empty());
  for (const Chart& chart : near.charts) CHECK((chart.unknowns(0) > 0) == (chart.component == 0));
}

TEST_CASE("The birth of an isola is a curve of folds without a cusp") {
  const ScalarProblem isola = level_set([](const Place& z) { return z(0) * z(0) + z(1) * z(1) - z(2); },
                                        [](const Place& z) { return Place(2 * z(0), 2 * z(1), -1); });
  for (const Guess& from : {start(0, 0, 0), start(0.5, 0, 0.25)}) {
    const Atlas atlas = cover(isola, {from}, box(1));
    INFO(atlas.reason);
    REQUIRE(atlas.complete());
    CHECK(count(atlas, PointType::cusp) == 0);
    for (const AtlasFold& fold : atlas.folds)
      CHECK(std::abs(std::pow(fold.parameters(0), 2) - fold.parameters(1)) < 1e-12);
  }
}

TEST_CASE("A surface that stands nearly upright over both parameters is covered") {
  const ScalarProblem wall = level_set([](const Place& z) { return 1e-5 * z(0) - z(1) - z(2); },
                                       [](const Place&) { return Place(1e-5, -1, -1); });
  const Atlas atlas = cover(wall, {start(0, 0, 0)}, box(1));
  REQUIRE(atlas.complete());
  CHECK(std::abs(shadow(atlas) - 4) < 1e-9);
  CHECK(atlas.charts.size() < 1000);
}

TEST_CASE("What is not covered is told") {
  const ScalarProblem cone = level_set([](const Place& z) { return z(0) * z(0) - z(1) * z(1) - z(2) * z(2); },
                                       [](const Place& z) { return Place(2 * z(0), -2 * z(1), -2 * z(2)); });
  const Atlas tip = cover(cone, {start(0.5, 0.5, 0)}, box(1));
  CHECK(tip.stop == Stop::min_step);
  CHECK(tip.reason.find("Newton's method found no further chart at p = ") != std::string::npos);
  AtlasOptions few = box(1);
  few.most_charts = 50;
  const Atlas begun = cover(plane(), {start(0, 0, 0)}, few);
  CHECK(begun.stop == Stop::max_points);
  CHECK(begun.charts.size() == 50);
  few.go_on = [] { return false; };
  CHECK(cover(plane(), {start(0, 0, 0)}, few).stop == Stop::interrupted);
  // Endless in u.
  const ScalarProblem wave = level_set([](const Place& z) { return std::sin(z(0)) - 3 * z(1) - z(2); },
                                       [](const Place& z) { return Place(std::cos(z(0)), -3, -1); });
  few = box(1);
  few.most_charts = 2000;
  CHECK(!cover(wave, {start(0, 0, 0)}, few).complete());
}

TEST_CASE("A sheet that others cross is followed through the crossing, which is told") {
  const ScalarProblem pitchfork =
      level_set([](const Place& z) { return z(0) * (z(1) - z(0) * z(0)); },
                [](const Place& z) { return Place(z(1) - 3 * z(0) * z(0), z(0), 0); });
  const Atlas atlas = cover(pitchfork, {start(0, 0.5, 0)}, box(1));
  REQUIRE(atlas.complete());
  CHECK(std::abs(shadow(atlas) - 4) < 1e-12);
  CHECK(count(atlas, PointType::branch_point) == static_cast<long>(atlas.folds.size()));
  CHECK(!atlas.folds.empty());
  for (const AtlasFold& fold : atlas.folds) CHECK(std::abs(fold.parameters(0)) < 1e-12);
}

TEST_CASE("Folds on a line where sheets cross are located on it: u (p - u^2 + q/10)") {
  const ScalarProblem pitchfork =
      level_set([](const Place& z) { return z(0) * (z(1) - z(0) * z(0) + z(2) / 10); },
                [](const Place& z) { return Place(z(1) - 3 * z(0) * z(0) + z(2) / 10, z(0), z(0) / 10); });
  for (const Guess& from : {start(0.5, 0.25, 0), start(0.7, 0.49, 0), start(0, 0.5, 0)}) {
    const Atlas atlas = cover(pitchfork, {from}, box(1));
    INFO(atlas.reason);
    REQUIRE(atlas.complete());
    CHECK(count(atlas, PointType::branch_point) == static_cast<long>(atlas.folds.size()));
    CHECK(atlas.folds.size() > 20);
    for (const AtlasFold& fold : atlas.folds) {
      CHECK(std::abs(fold.unknowns(0)) < 1e-12);
      CHECK(std::abs(fold.parameters(0) + fold.parameters(1) / 10) < 1e-12);
    }
  }
}

TEST_CASE("Wrong requests for surfaces are refused") {
  CHECK_THROWS_WITH(cover(plane(), {start(0, 2, 0)}, box(1)),
                    Catch::Contains("a start has p = 2, which is not from -1 to 1"));
  AtlasOptions same = box(1);
  same.parameters[1] = "p";
  CHECK_THROWS_WITH(cover(plane(), {start(0, 0, 0)}, same), Catch::Contains("both parameters are p"));
  CHECK_THROWS_WITH(cover(plane(), {start(0, 0, 0)}, box(0.0)), Catch::Contains("two different numbers"));
  CHECK_THROWS_WITH(cover(plane(), {start(0, 0, 0)}, box(1, 0.7)), Catch::Contains("max_radius"));
  CHECK_THROWS_WITH(cover(plane(), {}, box(1)), Catch::Contains("at least one guess"));
}
