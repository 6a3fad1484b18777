#include "arcslip/problems/response/one_way_response.hpp"

#include "arcslip/continuation/problem/derivative_check.hpp"
#include "case_runs.hpp"
#include "paper_cases.hpp"
#include "rod_response.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::ForcedResponse;
using problems::OneWayResponse;

namespace {

Vector motion(const ForcedResponse& problem, double eta, double preload) {
  const continuation::Guess guess = problem.guess(eta, preload);
  Vector values;
  problem.observe(guess.unknowns, guess.parameters, guess.regime, values);
  return values;
}

SystemParameters light(double mass_ratio, double preload) {
  SystemParameters parameters = figure_8(preload);
  parameters.mass_ratio = mass_ratio;
  return parameters;
}

/// Relative errors of Y, U and R against the coupled response.
std::array<double, 3> errors(const SystemParameters& parameters, double eta) {
  const FrictionSystem system = build_system(parameters);
  const Vector coupled = motion(ForcedResponse(system), eta, parameters.preload);
  const Vector driven = motion(OneWayResponse(system), eta, parameters.preload);
  const auto error = [&](Index i) { return std::abs(driven(i) / coupled(i) - 1); };
  return {error(ForcedResponse::Y), error(ForcedResponse::U), error(ForcedResponse::R)};
}

}  // namespace

TEST_CASE("The base that drives the damper moves as if alone, whatever the friction does") {
  const SystemParameters parameters = figure_8(1);
  const FrictionSystem alone = build_system(parameters);
  const OneWayResponse problem(alone);
  const continuation::Branch branch = trace_over_eta(problem, 1, 0.5, 120);
  REQUIRE(branch.complete());
  Vector values;
  for (const continuation::BranchPoint& point : branch.points) {
    problem.observe(point.unknowns, point.parameters, point.regime, values);
    const Complex y = alone.base.at(point.parameters(0)).free;
    const Complex u = std::polar(values(ForcedResponse::U), -values(ForcedResponse::alpha));
    const Complex r = std::polar(values(ForcedResponse::R), -values(ForcedResponse::psi));
    // R has the residual's 1e-10; r and u are rounded at the size of the larger one.
    CHECK_THAT(values(ForcedResponse::Y), WithinRel(std::abs(y), 1e-9));
    CHECK(std::abs(u - y - r) <= 1e-9 * std::max(std::abs(y), std::abs(u)));
  }
  const auto peaks = of_type(branch, PointType::peak);
  REQUIRE(peaks.size() == 1);
  // Published nowhere: the figure's base without damper, by an independent solver.
  CHECK_THAT(peaks[0].parameters(0), WithinRel(4.000005298, 1e-9));
  CHECK_THAT(quantity(problem, peaks[0], ForcedResponse::Y), WithinRel(3.208115189, 1e-9));
}

TEST_CASE("The driven damper's relative amplitude is that of the closed form for rods") {
  const double preload = GENERATE(0.01, 0.1, 1.0, 10.0);
  const SystemParameters parameters = rods(preload);
  const RodResponse exact(parameters);
  const OneWayResponse problem(build_system(parameters));
  for (const double eta : {0.7, 1.0, 2.5, 3.3, 4.0, 5.6, 9.0}) {
    const RodResponse::Real R = motion(problem, eta, preload)(ForcedResponse::R);
    const auto force = exact.friction(R, exact.slip_threshold(eta));
    const auto left = R * std::abs(1.0L + force * exact.c_damper(eta));
    CHECK_THAT(static_cast<double>(left / std::abs(exact.load() * exact.c_base(eta))), WithinRel(1.0, 1e-9));
  }
}

TEST_CASE("Residual and Y of the driven damper have exact derivatives in both regimes") {
  const OneWayResponse problem(build_system(rods(1)));
  for (const double eta : {1.5, 3.3, 5.9}) {
    for (const double log_ratio : {-3.0, -0.1, 0.1, 1.0, 6.0}) {
      const Vector u = Vector::Constant(1, std::log(problem.system().slip_per_preload) + log_ratio);
      const Vector p = Eigen::Vector2d(eta, 1);
      const int regime = log_ratio < 0 ? ForcedResponse::stick : ForcedResponse::slip;
      const continuation::DerivativeReport report = continuation::check_derivatives(problem, u, p, regime);
      INFO("worst at " << report.where);
      CHECK(report.worst < 1e-8);  // of the differences
    }
  }
}

TEST_CASE("The one-way model's error vanishes as 1/M* away from the base's resonance") {
  for (const double eta : {0.7, 2.0, 8.0, 30.0}) {
    // P M* is kept, so that interfaces slip as much: y_0 does not depend on M*, and S goes as P M*.
    const auto heavy = errors(light(1e3, 0.1), eta);
    const auto heavier = errors(light(1e4, 0.01), eta);
    for (std::size_t i = 0; i < heavy.size(); ++i) {
      CHECK(heavy[i] < 0.01);
      CHECK_THAT(heavy[i] / heavier[i], WithinRel(10.0, 0.02));  // the next term is 1/M* times the first
    }
  }
  CHECK(errors(light(1e3, 0.1), 4)[0] > 0.1);  // at the base's resonance friction holds the base
}

TEST_CASE("Over the preload the base's amplitude is constant and has no extrema") {
  continuation::TraceOptions options = over("P", 0.01, 100);
  options.extrema_of = {"Y"};
  const OneWayResponse problem(build_system(light(100, 1)));
  const continuation::Branch branch = trace(problem, problem.guess(3.99, 0.01), options);
  REQUIRE(branch.complete());
  CHECK(of_type(branch, PointType::peak).empty());
  CHECK(of_type(branch, PointType::trough).empty());
  CHECK(of_type(branch, PointType::regime_switch).size() == 1);
}

TEST_CASE("A case asks for the one-way model by its response", "[cases]") {
  const Run run("one_way");
  REQUIRE(run.traced.size() == 3);
  for (const TracedBranch& traced : run.traced)
    check(traced, PointType::peak, {{{"eta", 4.000005298}, {"Y", 3.208115189}}}, 1e-9);
}
