// Special points that fall on one another but for rounding.

#include <cmath>

#include "arcslip/problems/response/forced_response.hpp"
#include "arcslip/problems/ridges/response_slopes.hpp"
#include "catch.hpp"
#include "random_systems.hpp"
#include "scalar_problem.hpp"

using namespace arcslip;
using namespace arcslip::continuation;
using namespace arcslip::testing;
using problems::ForcedResponse;
using problems::ResponseSlopes;

namespace {

/// eta next to a stuck resonance at which R/S is largest, by bisection; 0 where it is not next to it.
double border_top(const FrictionSystem& system, double resonance) {
  const auto slope = [&](double eta) { return ResponseSlopes::on_border(system, eta).by_eta().log_ratio; };
  double width = 1e-9;
  const auto is_inside = [&] {
    return slope(resonance * (1 - width)) > 0 && slope(resonance * (1 + width)) < 0;
  };
  while (width < 0.1 && !is_inside()) width *= 2;
  if (width > 0.1) return 0;
  double below = resonance * (1 - width);
  double above = resonance * (1 + width);
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (below + above);
    (slope(middle) > 0 ? below : above) = middle;
  }
  return below;
}

}  // namespace

TEST_CASE("An extremum and two events at one place, which is to be landed on, are each found once") {
  for (int i = 0; i < 400; ++i) {
    const double square = 3 + 0.01 * i;  // of the resonance
    const double width = std::pow(10, -2 - i % 5);
    const auto away = [=](double p) { return square - p * p; };
    const auto norm = [=](double p) { return away(p) * away(p) + width * width; };
    const auto slope = [=](double p) { return 2 * p * away(p) / norm(p); };
    const ScalarProblem resonance(
        {"p"}, [=](double u, const Vector& p) { return u + 0.5 * std::log(norm(p(0))); },
        [](double, const Vector&) { return 1.0; }, {[=](double, const Vector& p) { return -slope(p(0)); }});
    TraceOptions options = over("p", 1, 3);
    options.max_points = 1000;
    options.extrema_of = {"u"};
    options.stop_at = {std::sqrt(square)};
    options.events = {{"slope", [=](const Vector&, const Vector& p, const Regime&) { return slope(p(0)); }},
                      {"other", [=](const Vector&, const Vector& p, const Regime&) {
                         return away(p(0)) / p(0) / norm(p(0));
                       }}};
    const Branch branch =
        trace(resonance, {Vector::Constant(1, -0.5 * std::log(norm(1))), vector_of({1})}, options);
    CAPTURE(i, branch.explanation);
    REQUIRE(branch.complete());
    CHECK(of_type(branch, PointType::peak).size() == 1);
    CHECK(of_type(branch, PointType::event).size() == 2);
  }
}

TEST_CASE("A response whose resonance touches the border of stick, but for rounding, goes on") {
  RandomSystems draw(3);
  for (int i = 0; i < 150; ++i) {
    SystemParameters s = draw.system();
    s.interface_stiffness = draw.log_uniform(10, 1e5);
    s.fixed_damper = draw.integer(0, 1) == 0;
    if (draw.integer(0, 1) == 0) s.base_damping_kind = DampingKind::structural;
    const ForcedResponse problem(build_system(s));
    const FrictionSystem& system = problem.system();
    const double resonance =
        joined_frequencies({&system.base, &system.damper}, system.contact_stiffness).front();
    const double top = border_top(system, resonance);
    if (top == 0) continue;
    const double beyond = draw.integer(0, 1) == 0 ? 0 : draw.log_uniform(1e-16, 1e-8);
    const double preload = ResponseSlopes::on_border(system, top).preload() *
                           (draw.integer(0, 1) == 0 ? 1 - beyond : 1 + beyond);
    TraceOptions options = over("eta", 0.5 * resonance, 1.5 * resonance);
    if (draw.integer(0, 1) == 0) std::swap(options.from, options.to);
    options.extrema_of = {"Y"};
    options.max_points = 3000;
    const Branch branch = trace(problem, problem.guess(options.from, preload), options);
    CAPTURE(i, preload, branch.explanation);
    REQUIRE(branch.stop == Stop::reached_end);
    const std::size_t switches = of_type(branch, PointType::regime_switch).size();
    CHECK(switches % 2 == (branch.points.front().regime == branch.points.back().regime ? 0 : 1));
    CHECK(of_type(branch, PointType::corner_fold).empty());
    const double way = options.to > options.from ? 1 : -1;
    for (std::size_t k = 1; k < branch.points.size(); ++k)
      CHECK(way * (branch.points[k].parameters(0) / branch.points[k - 1].parameters(0) - 1) > -1e-10);
  }
}
