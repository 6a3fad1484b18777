// Curves on surfaces over two parameters: where isolas are born and merge, and ridges of observables.

#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "level_set.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

namespace {

template <class Point>
std::vector<Point> points_of(const std::vector<Point>& all, PointType type) {
  std::vector<Point> chosen;
  std::copy_if(all.begin(), all.end(), std::back_inserter(chosen),
               [type](const Point& point) { return point.type == type; });
  return chosen;
}

/// How far a point is from a place.
double off(const AtlasPoint& point, const Place& at) {
  return (Place(point.unknowns(0), point.parameters(0), point.parameters(1)) - at).norm();
}

/// u = g(p, q).
ScalarProblem height_over(std::function<double(double, double)> g,
                          std::function<std::pair<double, double>(double, double)> slopes) {
  return level_set([=](const Place& z) { return z(0) - g(z(1), z(2)); },
                   [=](const Place& z) {
                     const auto [by_p, by_q] = slopes(z(1), z(2));
                     return Place(1, -by_p, -by_q);
                   });
}

/// The surface with the ridges of u.
Atlas with_ridges(const Problem& problem, const Guess& from, AtlasOptions options) {
  options.extrema_of = {"u"};
  Atlas atlas = cover(problem, {from}, options);
  INFO(atlas.reason);
  REQUIRE(atlas.complete());
  return atlas;
}

/// A problem with the observable Y = (u - a)^2.
class Squared : public ScalarProblem {
 public:
  Squared(const ScalarProblem& problem, double a) : ScalarProblem(problem), a_(a) {}
  std::vector<Observable> observables() const override { return {{"Y", true}, {"rough", false}}; }
  void observe(const Vector& u, const Vector&, const Regime&, Vector& values) const override {
    values << (u(0) - a_) * (u(0) - a_), 0;
  }
  double observe(const Vector& u, const Vector&, const Regime&, Index, Gradient& gradient) const override {
    gradient.unknowns(0) = 2 * (u(0) - a_);
    gradient.parameters.setZero();
    return (u(0) - a_) * (u(0) - a_);
  }

 private:
  double a_;
};

}  // namespace

TEST_CASE("Birth and merger of an isola lie on a surface's folds, for either parameter") {
  const double p = 1 / std::sqrt(3.0);
  for (const bool swapped : {false, true}) {
    AtlasOptions options = box(1.3);
    if (swapped) std::swap(options.parameters[0], options.parameters[1]);
    const Atlas atlas = cover(cubic_sheet(), {start(0, 0, 0)}, options);
    INFO(atlas.reason);
    REQUIRE(atlas.complete());
    const auto births = points_of(atlas.folds, PointType::isola_centre);
    const auto mergers = points_of(atlas.folds, PointType::simple_bifurcation);
    REQUIRE(births.size() == 1);
    REQUIRE(mergers.size() == 1);
    CHECK(off(births[0], {0, p, -2 * p / 3}) < 1e-9);
    CHECK(off(mergers[0], {0, -p, 2 * p / 3}) < 1e-9);
    CHECK(births[0].turns == (swapped ? 0 : 1));
    CHECK(mergers[0].turns == (swapped ? 0 : 1));
    CHECK(points_of(atlas.folds, PointType::cusp).empty());
  }
}

TEST_CASE("On a sphere each parameter turns twice, where the other's closed branch shrinks to a point") {
  const ScalarProblem sphere =
      level_set([](const Place& z) { return z.squaredNorm() - 1; }, [](const Place& z) { return 2 * z; });
  for (const Guess& from : {start(0, 1, 0), start(0.6, 0, 0.8), start(0, 0, -1)}) {
    const Atlas atlas = cover(sphere, {from}, box(1.2));
    REQUIRE(atlas.complete());
    const auto births = points_of(atlas.folds, PointType::isola_centre);
    CHECK(points_of(atlas.folds, PointType::simple_bifurcation).empty());
    for (const int turning : {0, 1}) {
      for (const double side : {-1.0, 1.0}) {
        const Place at(0, turning == 0 ? side : 0, turning == 0 ? 0 : side);
        CHECK(std::any_of(births.begin(), births.end(),
                          [&](const AtlasFold& one) { return one.turns == turning && off(one, at) < 1e-9; }));
      }
    }
  }
}

TEST_CASE("A cusp on a surface is no birth, and a curve of folds at one value of a parameter has none") {
  const ScalarProblem cusp =
      level_set([](const Place& z) { return z(0) * z(0) * z(0) - z(2) * z(0) - z(1); },
                [](const Place& z) { return Place(3 * z(0) * z(0) - z(2), -1, -z(0)); });
  const ScalarProblem trough = level_set([](const Place& z) { return z(0) * z(0) - z(2); },
                                         [](const Place& z) { return Place(2 * z(0), 0, -1); });
  for (const Atlas& atlas :
       {cover(cusp, {start(0.5, 0.125, 0)}, box(1)), cover(cusp, {start(0, 0, 0)}, box(1)),
        cover(trough, {start(0.5, 0, 0.25)}, box(1))}) {
    REQUIRE(atlas.complete());
    CHECK(!atlas.folds.empty());
    CHECK(points_of(atlas.folds, PointType::isola_centre).empty());
    CHECK(points_of(atlas.folds, PointType::simple_bifurcation).empty());
  }
}

TEST_CASE("The ridge of 1 - (p - q^2)^2 is p = q^2, from starts on it and beside it") {
  const ScalarProblem hill =
      height_over([](double p, double q) { return 1 - (p - q * q) * (p - q * q); },
                  [](double p, double q) { return std::pair(-2 * (p - q * q), 4 * q * (p - q * q)); });
  for (const Guess& from : {start(1, 0, 0), start(1, 0.25, 0.5), start(0.91, 0.3, 0)}) {
    const Atlas atlas = with_ridges(hill, from, box(1));
    REQUIRE(!atlas.ridges.empty());
    CHECK(atlas.ridges.back().curve == 0);
    CHECK(atlas.ridges.size() > 15);
    for (const AtlasRidge& point : atlas.ridges) {
      CHECK(point.type == PointType::peak);
      CHECK(point.observable == "u");
      const double q = point.parameters(1);
      CHECK(off(point, {1, q * q, q}) < 1e-9);
    }
    CHECK(std::abs(atlas.ridges.front().parameters(1)) == 1);  // from side to side
    CHECK(atlas.ridges.back().parameters(1) == -atlas.ridges.front().parameters(1));
  }
}

TEST_CASE("A ridge goes exactly through centres of charts, be they all on the box's side") {
  const ScalarProblem roof = height_over([](double p, double) { return -p * p; },
                                         [](double p, double) { return std::pair(-2 * p, 0.0); });
  for (const double low : {-1.0, 0.0}) {
    AtlasOptions options = box(1);
    options.from[0] = low;
    const Atlas atlas = with_ridges(roof, start(0, 0, 0), options);
    const auto centres = std::count_if(atlas.charts.begin(), atlas.charts.end(), [](const Chart& chart) {
      return std::abs(chart.parameters(0)) < 1e-13;
    });
    CHECK(centres > (low == 0 ? 10 : 0));
    CHECK(atlas.ridges.back().curve == 0);
    CHECK(std::abs(atlas.ridges.front().parameters(1)) == 1);
    CHECK(atlas.ridges.back().parameters(1) == -atlas.ridges.front().parameters(1));
    for (const AtlasRidge& point : atlas.ridges) {
      CHECK(point.type == PointType::peak);
      CHECK(std::abs(point.parameters(0)) < 1e-12);
    }
  }
}

TEST_CASE("What does not change over the first parameter has no ridges") {
  const ScalarProblem flat = height_over([](double, double q) { return q * q; },
                                         [](double, double q) { return std::pair(0.0, 2 * q); });
  CHECK(with_ridges(flat, start(0, 0, 0), box(1)).ridges.empty());
}

TEST_CASE("Where peaks and troughs meet their curve turns: u = p^3 - q p") {
  const ScalarProblem problem = height_over([](double p, double q) { return p * p * p - q * p; },
                                            [](double p, double q) { return std::pair(3 * p * p - q, -p); });
  for (const Guess& from : {start(0, 0, 0), start(0, 0.5, 0.25)}) {
    const Atlas atlas = with_ridges(problem, from, box(1));
    CHECK(atlas.ridges.back().curve == 0);
    const auto meet = points_of(atlas.ridges, PointType::fold);
    REQUIRE(meet.size() == 1);
    CHECK(off(meet[0], {0, 0, 0}) < 1e-9);
    for (const AtlasRidge& point : atlas.ridges) {
      const double p = point.parameters(0);
      CHECK(std::abs(point.parameters(1) - 3 * p * p) < 1e-9);
      if (point.type == PointType::fold) continue;
      CHECK(point.type == (p < 0 ? PointType::peak : PointType::trough));
    }
  }
}

TEST_CASE("A ridge runs through a birth, where a peak and a trough of an isola meet, and through a merger") {
  const double p = 1 / std::sqrt(3.0);
  const Atlas atlas = with_ridges(cubic_sheet(), start(0, 0, 0), box(1.3));
  // u du = -(3 p^2 - 1)/2 dp along the branch.
  const auto births = points_of(atlas.ridges, PointType::isola_centre);
  const auto mergers = points_of(atlas.ridges, PointType::simple_bifurcation);
  REQUIRE(births.size() == 1);
  REQUIRE(mergers.size() == 1);
  CHECK(off(births[0], {0, p, -2 * p / 3}) < 1e-9);
  CHECK(off(mergers[0], {0, -p, 2 * p / 3}) < 1e-9);
  for (const AtlasRidge& point : atlas.ridges) {
    const double u = point.unknowns(0);
    CHECK(std::abs(std::abs(point.parameters(0)) - p) < 1e-9);
    if (point.type == PointType::peak) CHECK((u > 0) == (point.parameters(0) > 0));
    if (point.type == PointType::trough) CHECK((u > 0) == (point.parameters(0) < 0));
  }
}

TEST_CASE("A ridge runs through folds") {
  const ScalarProblem cusp =
      level_set([](const Place& z) { return z(0) * z(0) * z(0) - z(2) * z(0) - z(1); },
                [](const Place& z) { return Place(3 * z(0) * z(0) - z(2), -1, -z(0)); });
  for (const double a : {0.3, 0.0}) {  // through a fold, and through the cusp
    const Squared problem(cusp, a);
    AtlasOptions options = box(1);
    options.extrema_of = {"Y"};
    const Atlas atlas = cover(problem, {start(0.5, 0.125, 0)}, options);
    INFO(a << ' ' << atlas.reason);
    REQUIRE(atlas.complete());
    CHECK(atlas.ridges.back().curve == 0);
    CHECK(atlas.ridges.size() > 10);
    for (const AtlasRidge& point : atlas.ridges) {
      CHECK(point.type == PointType::trough);
      const double q = point.parameters(1);
      CHECK(off(point, {a, a * a * a - q * a, q}) < 1e-9);
    }
  }
}

TEST_CASE("Ridges are of observables with gradients") {
  const Squared problem(cubic_sheet(), 0);
  AtlasOptions options = box(1);
  options.extrema_of = {"rough"};
  CHECK_THROWS_WITH(cover(problem, {start(0, 0, 0)}, options), Catch::Contains("'rough' has no gradient"));
  options.extrema_of = {"Z"};
  CHECK_THROWS_WITH(cover(problem, {start(0, 0, 0)}, options), Catch::Contains("Z"));
}
