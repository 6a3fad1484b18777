// What leaves cycles that are put together of pieces, and curves of their special points: of oscillators
// that hit walls, by their exact motion from one impact to the next.

#include <Eigen/LU>
#include <cmath>

#include "cases/cycles.hpp"
#include "cycle_cases.hpp"

namespace {

using namespace arcslip;
using namespace arcslip::testing;

constexpr double zeta = 0.05;

/// x'' + 2 zeta x' + x = cos(w t) from (gap, -r speed) on, at phase w t.
struct Flight {
  double w, r;

  std::pair<double, double> at(double phase, double begin, double velocity, double time) const {
    const Complex forced = 1.0 / Complex(1 - w * w, 2 * zeta * w);
    const auto steady = [&](double t) { return forced * std::polar(1.0, phase + w * t); };
    const auto speed = [&](double t) { return Complex(0, w) * steady(t); };
    const double x = begin - steady(0).real();
    const double v = velocity - speed(0).real();
    const double own = std::sqrt(1 - zeta * zeta);
    const double s = (v + zeta * x) / own;
    const double cosine = std::cos(own * time);
    const double sine = std::sin(own * time);
    const double decay = std::exp(-zeta * time);
    return {steady(time).real() + decay * (x * cosine + s * sine),
            speed(time).real() + decay * ((own * s - zeta * x) * cosine - (own * x + zeta * s) * sine)};
  }

  /// Phase and speed of the impact at `to` about `time` after one at `from` with this phase and speed.
  Eigen::Vector2d next(const Eigen::Vector2d& impact, double from, double to, double time) const {
    double velocity = 0;
    for (int round = 0; round < 20; ++round) {
      const auto [x, v] = at(impact(0), from, -r * impact(1), time);
      velocity = v;
      time -= (x - to) / v;
    }
    return {impact(0) + w * time, velocity};
  }
};

/// The derivatives of a map of phase and speed, by differences.
template <class Map>
Eigen::Matrix2d slopes(const Map& map, const Eigen::Vector2d& at) {
  constexpr double h = 1e-5;
  Eigen::Matrix2d result;
  for (Index k = 0; k < 2; ++k) {
    const Eigen::Vector2d step = h * Eigen::Vector2d::Unit(k);
    result.col(k) = (map(at + step) - map(at - step)) / (2 * h);
  }
  return result;
}

/// Phase and speed at the end of a piece: beside x and v is what part of a period has passed.
Eigen::Vector2d impact(const continuation::OrbitProblem& orbits, const Vector& u, Index piece) {
  const Vector last = orbits.orbit(u).rightCols(1);
  return {two_pi * last(3 * piece + 2), last(3 * piece + 1)};
}

/// How far two impacts differ, whatever the round.
double apart(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::hypot(2 * std::sin(0.5 * (a(0) - b(0))), a(1) - b(1));
}

const std::string one_wall =
    "[model]\nkind = \"piecewise\"\nperiod = \"2*pi/w\"\nparameters = { w = 2.8, r = 0.8, gap = 0.5 }\n"
    "equations = { x = \"v\", v = \"cos(w*t) - 0.1*v - x\" }\nstart = { v = 0.5 }\n"
    "[model.pieces.free]\nuntil = \"x - gap\"\nreset = { v = \"-r*v\" }\n"
    "[cycles]\nsettle = 400\ndegree = 7\ntolerance = 1e-9\n";

const std::string two_walls =
    "[model]\nkind = \"piecewise\"\nperiod = \"2*pi/w\"\nparameters = { w = 2, r = 0.8, gap = 0.5 }\n"
    "equations = { x = \"v\", v = \"cos(w*t) - 0.1*v - x\" }\nstart = { x = -0.5, v = 0.5 }\n"
    "[model.pieces.right]\nuntil = \"x - gap\"\nreset = { v = \"-r*v\" }\n"
    "[model.pieces.left]\nuntil = \"x + gap\"\nreset = { v = \"-r*v\" }\n"
    "[cycles]\nsettle = 400\ndegree = 7\ntolerance = 1e-9\n";

}  // namespace

TEST_CASE("Orbits with two different impacts are those of the exact motion", "[cycles][pieces]") {
  const auto all = Run("impact_oscillator", {"cycles.degree=7", "cycles.tolerance=1e-9"}).traced;
  REQUIRE(all.size() == 3);
  const auto doublings = values_at(all[0], PointType::period_doubling, "w");
  for (std::size_t i = 1; i < all.size(); ++i) {
    const continuation::OrbitProblem& orbits = *orbits_of(all[i]);
    const double begin = value(all[i], all[i].branch.points.front(), "w");
    CHECK((std::abs(begin - doublings[0]) < 1e-5 || std::abs(begin - doublings[1]) < 1e-5));
    CHECK(all[i].branch.points.size() > 5);
    double widest = 0;
    for (const BranchPoint& point : all[i].branch.points) {
      const Flight flight{value(all[i], point, "w"), 0.8};
      const Eigen::Vector2d one = impact(orbits, point.unknowns, 0);
      const Eigen::Vector2d other = impact(orbits, point.unknowns, 1);
      const double there = value(all[i], point, "T_free_2");
      const double back = value(all[i], point, "T_free");
      CHECK(apart(flight.next(one, 0.5, 0.5, there), other) < 1e-7);
      CHECK(apart(flight.next(other, 0.5, 0.5, back), one) < 1e-7);
      CHECK_THAT(there + back, WithinAbs(8 * pi / flight.w, 1e-9));
      widest = std::max(widest, apart(one, other));
    }
    CHECK(widest > 0.01);
  }
}

TEST_CASE("Curves of doublings and folds of impacts are those of the exact motion", "[cycles][pieces]") {
  const auto [kind, multiplier, last] = GENERATE(
      table<std::string, double, std::string>({{"period_doubling", -1, "2"}, {"cycle_fold", 1, "3.5"}}));
  const auto curves =
      traced_of(one_wall + "[branch]\ncurve = \"" + kind +
                "\"\nparameters = [\"w\", \"r\"]\nwindow = [2.8, " + last + "]\nfrom = 0.8\nto = 0.7\n");
  REQUIRE(!curves.empty());
  CHECK(curves[0].branch.points.size() > 4);
  for (const BranchPoint& point : curves[0].branch.points) {
    const continuation::BasePoint at = curves[0].curve->split(point.unknowns, point.parameters, point.regime);
    const Flight flight{at.parameters(0), at.parameters(1)};
    const auto round = [&](const Eigen::Vector2d& from) {
      return flight.next(from, 0.5, 0.5, 4 * pi / flight.w);
    };
    const auto& orbits = dynamic_cast<const continuation::OrbitProblem&>(*curves[0].base.problem);
    const Eigen::Vector2d once = impact(orbits, at.unknowns, 0);
    CHECK(apart(round(once), once) < 1e-7);
    const Eigen::Matrix2d slope = slopes(round, once);
    CHECK_THAT((slope - multiplier * Eigen::Matrix2d::Identity()).determinant(), WithinAbs(0, 1e-6));
  }
}

TEST_CASE("A curve of points that a branch of impacts has none of has no start", "[pieces]") {
  const auto none =
      traced_of(one_wall + "[branch]\ncurve = \"neimark_sacker\"\nparameters = [\"w\", \"r\"]\n" +
                "window = [2.8, 2]\nfrom = 0.8\nto = 0.7\n");
  REQUIRE(none.size() == 1);
  CHECK(none[0].branch.stop == Stop::no_start);
  CHECK_THAT(none[0].branch.explanation,
             ContainsSubstring("no neimark_sacker was found") && ContainsSubstring("a piece vanishes there"));
}

TEST_CASE("Impacts on two walls lose their symmetry where one passage of the exact motion turns it",
          "[cycles][pieces]") {
  const auto all = traced_of(two_walls +
                             "[branch]\nparameter = \"w\"\nfrom = 1.4\nto = 3\nstart = "
                             "2\nswitching = true\n");
  REQUIRE(all.size() == 2);
  const auto leaving = points(all[0], PointType::branch_point);
  REQUIRE(leaving.size() == 1);
  const auto exact = [](const TracedBranch& traced, const BranchPoint& point) {
    const Flight flight{value(traced, point, "w"), 0.8};
    const continuation::OrbitProblem& orbits = *orbits_of(traced);
    const Eigen::Vector2d right = impact(orbits, point.unknowns, 0);
    const Eigen::Vector2d left = impact(orbits, point.unknowns, 1);
    CHECK(apart(flight.next(right, 0.5, -0.5, value(traced, point, "T_left")), left) < 1e-7);
    CHECK(apart(flight.next(left, -0.5, 0.5, value(traced, point, "T_right")), right) < 1e-7);
  };
  for (const TracedBranch& one : all) {
    CHECK(one.branch.points.size() > 10);
    for (const BranchPoint& point : one.branch.points) exact(one, point);
  }
  const Flight flight{value(all[0], leaving[0], "w"), 0.8};
  const auto half = [&](const Eigen::Vector2d& from) {  // to the other wall, seen from there
    Eigen::Vector2d to = flight.next(from, 0.5, -0.5, pi / flight.w);
    return Eigen::Vector2d(to(0) - pi, -to(1));
  };
  const Eigen::Matrix2d slope = slopes(half, impact(*orbits_of(all[0]), leaving[0].unknowns, 0));
  CHECK_THAT((slope + Eigen::Matrix2d::Identity()).determinant(), WithinAbs(0, 1e-6));
  const double asymmetry = value(all[1], all[1].branch.points.back(), "T_right") -
                           value(all[1], all[1].branch.points.back(), "T_left");
  CHECK(std::abs(asymmetry) > 0.1);
}

TEST_CASE("A flow that is cut into pieces doubles its periods as before", "[cycles][pieces][numbers]") {
  const auto all = traced_of(
      "[model]\nkind = \"piecewise\"\nparameters = { c = 2.5 }\nequations = { x = \"-y - z\", y = \"x + "
      "0.2*y\", z = \"0.2 + z*(x - c)\" }\nstart = { x = 2, y = -3 }\n[model.pieces.right]\nuntil = \"x - "
      "2\"\n[model.pieces.left]\nuntil = \"x - 2\"\n[cycles]\nsettle = 400\ndegree = 7\nintervals = "
      "40\ndoublings = 2\n[branch]\nparameter = \"c\"\nfrom = 2.5\nto = 4\nswitching = true\n");
  REQUIRE(all.size() == 3);
  check_values(values_at(all[0], PointType::period_doubling, "c"), {2.832445030}, 1e-7);
  check_values(values_at(all[1], PointType::period_doubling, "c"), {3.83735815}, 1e-6);
  CHECK_THAT(value(all[1], all[1].branch.points.front(), "T"), WithinAbs(2 * 5.76982002, 1e-3));
  const auto last = all[2].problem().observables();
  CHECK(std::any_of(last.begin(), last.end(), [](const auto& one) { return one.name == "T_left_4"; }));
}
