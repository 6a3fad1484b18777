// Extrema and events at corners of a branch and beside them, against closed forms.

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "catch.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;

TEST_CASE("A zero of a function of pieces at the corner of a trough is told once") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(0.2, 1);
  constexpr double little = 1e-4;
  for (int i = 0; i < 200; ++i) {
    const double corner = part(random);
    const double before = -1e-3 * part(random);
    const double behind = 1e-3 * part(random);
    const auto slope = [=](const Vector& p) { return p(0) > corner ? behind : before; };
    const ScalarProblem bent(
        {"p"}, [=](double u, const Vector& p) { return u - 1 - slope(p) * (p(0) - corner); },
        [](double, const Vector&) { return 1.0; }, {[=](double, const Vector& p) { return -slope(p); }});
    // It passes zero a few bits before the corner, and has noise of as many.
    const double off = 2e-15 * part(random);
    const auto zero = [=](const Vector& p) {
      return (p(0) - corner + off + 1) - 1 + 4e-16 * std::round(std::sin(1e17 * p(0)));
    };
    TraceOptions options = over("p", corner - little * part(random), corner + little);
    options.extrema_of = {"u"};
    options.max_step = little;
    options.events = {{"zero", [=](const Vector&, const Vector& p, const Regime&) { return zero(p); },
                       [=](const Vector&, const Vector& p, const Regime&) {
                         return p(0) > corner + 0.3 * little ? 1 : 0;
                       }}};
    const Branch branch = trace(bent, {vector_of({1}), vector_of({options.from})}, options);
    CAPTURE(corner, before, behind, off);
    CHECK(branch.complete());
    CHECK(of_type(branch, PointType::trough).size() == 1);
    CHECK(of_type(branch, PointType::event).size() == 1);
  }
}

namespace {

/// What falls up to a corner at x = 0, rises behind it and falls again from `way` on, and its slope.
double bent_at(double x, double way) { return 1 + (x > 0 ? way * x - 0.5 * x * x : -0.1 * x); }
double slope_at(double x, double way) { return x > 0 ? way - x : -0.1; }

void check_pair(const Branch& branch, double corner, double way, double tolerance) {
  CHECK(branch.complete());
  const auto troughs = of_type(branch, PointType::trough);
  const auto peaks = of_type(branch, PointType::peak);
  REQUIRE(troughs.size() == 1);
  REQUIRE(peaks.size() == 1);
  CHECK_THAT(troughs[0].parameters(0), WithinAbs(corner, 1e-10));
  CHECK_THAT(peaks[0].parameters(0), WithinAbs(corner + way, tolerance));
}

}  // namespace

TEST_CASE("A trough at a corner is told although a peak follows at once") {
  constexpr double corner = 0.4137;
  const double way = GENERATE(1e-8, 1e-6, 1e-4, 1e-3);
  const double max_step = GENERATE(0.003, 0.01, 0.03, 0.1);
  CAPTURE(way, max_step);
  const ScalarProblem bent(
      {"p"}, [=](double u, const Vector& p) { return u - bent_at(p(0) - corner, way); },
      [](double, const Vector&) { return 1.0; },
      {[=](double, const Vector& p) { return -slope_at(p(0) - corner, way); }});
  TraceOptions options = over("p", 0, 1);
  options.extrema_of = {"u"};
  options.max_step = max_step;
  options.events = {{"zero", [=](const Vector&, const Vector& p, const Regime&) { return p(0) - corner; },
                     [=](const Vector&, const Vector& p, const Regime&) { return p(0) > 0.9 ? 1 : 0; }}};
  const Branch branch = trace(bent, {vector_of({1}), vector_of({0})}, options);
  check_pair(branch, corner, way, 1e-10);
  CHECK(of_type(branch, PointType::event).size() == 1);
}

namespace {

constexpr double corner_at = 0.4137;

/// u = height(p - corner) from p = 0 to 1, with an event of one piece near the corner.
Branch traced_over_corner(const std::function<double(double)>& height,
                          const std::function<double(double)>& slope, double max_step,
                          const std::function<double(double)>& event) {
  const ScalarProblem bent(
      {"p"}, [&](double u, const Vector& p) { return u - height(p(0) - corner_at); },
      [](double, const Vector&) { return 1.0; },
      {[&](double, const Vector& p) { return -slope(p(0) - corner_at); }});
  TraceOptions options = over("p", 0, 1);
  options.extrema_of = {"u"};
  options.max_step = max_step;
  options.events = {{"zero",
                     [&](const Vector&, const Vector& p, const Regime&) { return event(p(0) - corner_at); },
                     [](const Vector&, const Vector& p, const Regime&) { return p(0) > 0.9 ? 1 : 0; }}};
  Branch branch = trace(bent, {vector_of({height(-corner_at)}), vector_of({0})}, options);
  CHECK(branch.complete());
  return branch;
}

void check_places(const Branch& branch, PointType type, const std::vector<double>& ways_before) {
  INFO(to_string(type));
  const auto found = of_type(branch, type);
  REQUIRE(found.size() == ways_before.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    CHECK_THAT(found[i].parameters(0), WithinAbs(corner_at - ways_before[i], 1e-9));
}

}  // namespace

TEST_CASE("A trough before a corner that is a peak is told where an event lies on the corner") {
  const double way = GENERATE(1e-5, 1e-4, 1e-3, 1e-2);
  const double max_step = GENERATE(0.003, 0.01, 0.03, 0.1, 0.3);
  CAPTURE(way, max_step);
  const Branch branch = traced_over_corner([=](double x) { return 1 + (x > 0 ? -x : x * (0.5 * x + way)); },
                                           [=](double x) { return x > 0 ? -1 : x + way; }, max_step,
                                           [](double x) { return x; });
  check_places(branch, PointType::trough, {way});
  check_places(branch, PointType::peak, {0});
  check_places(branch, PointType::event, {0});
}

TEST_CASE("An event that ends on a corner is told where the corner is a peak, also if it has just begun") {
  const double way = GENERATE(1e-5, 1e-4, 1e-3, 1e-2);
  const double max_step = GENERATE(0.003, 0.01, 0.03, 0.1, 0.3);
  CAPTURE(way, max_step);
  const Branch branch = traced_over_corner([](double x) { return 1 + (x > 0 ? -x : 0.5 * x); },
                                           [](double x) { return x > 0 ? -1 : 0.5; }, max_step,
                                           [=](double x) { return std::min(x + way, -20 * x); });
  check_places(branch, PointType::peak, {0});
  check_places(branch, PointType::event, {way, 0});
}

namespace {

/// u = p, of which the same is told, as the greater one of two functions.
class GreaterOfTwo : public ScalarProblem {
 public:
  GreaterOfTwo(double corner, double way)
      : ScalarProblem(
            {"p"}, [](double u, const Vector& p) { return u - p(0); },
            [](double, const Vector&) { return 1.0; }, {[](double, const Vector&) { return -1.0; }}),
        corner_(corner),
        way_(way) {}

  void observe(const Vector& u, const Vector& p, const Regime& regime, Vector& values) const override {
    Gradient gradient{Vector(1), Vector(1)};
    values = Vector::Constant(1, observe(u, p, regime, 0, gradient));
  }
  double observe(const Vector& u, const Vector& /*p*/, const Regime& /*regime*/, Index /*which*/,
                 Gradient& gradient) const override {
    const double x = u(0) - corner_;
    gradient.piece = x > 0 ? 1 : 0;
    gradient.unknowns(0) = slope_at(x, way_);
    gradient.parameters.setZero();
    return bent_at(x, way_);
  }

 private:
  double corner_;
  double way_;
};

}  // namespace

TEST_CASE("A trough at a corner between pieces and the peak beside it are told, both within one step") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> part(0.2, 0.6);
  const double way = GENERATE(1e-3, 1e-2, 3e-2);
  const double max_step = GENERATE(0.03, 0.1, 0.3);
  const bool back = GENERATE(false, true);
  for (int i = 0; i < 20; ++i) {
    const double corner = part(random);
    const GreaterOfTwo problem(corner, way);
    TraceOptions options = back ? over("p", 1, 0) : over("p", 0, 1);
    options.extrema_of = {"u"};
    options.max_step = max_step;
    const Branch branch = trace(problem, {vector_of({options.from}), vector_of({options.from})}, options);
    CAPTURE(corner, way, max_step, back);
    check_pair(branch, corner, way, 1e-9);
  }
}
