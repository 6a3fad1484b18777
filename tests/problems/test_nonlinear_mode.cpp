#include <cmath>

#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/problems/response/limit_cycle.hpp"
#include "arcslip/problems/response/nonlinear_mode.hpp"
#include "catch.hpp"
#include "paper_cases.hpp"
#include "random_systems.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::PointType;
using problems::ForcedResponse;
using problems::NonlinearMode;

namespace {

/// m = 1, c, k = 1 with a Jenkins element of stiffness 0.25 and slip force 0.2 at P = 1, eta = w/(2 pi).
HarmonicSystem jenkins_oscillator(int highest) {
  HarmonicSystem system;
  system.orders = odd_up_to(highest);
  for (const int h : system.orders) {
    const double unit = 1 / two_pi;  // the shape of a unit mass over 2 pi
    system.base.push_back({1,
                           {{1 / two_pi, ContactVector::Constant(1, unit), h == 1 ? unit : 0.0}},
                           Loss{.mass = 0.01 / two_pi}});  // c = 2 pi mu
    system.damper.push_back({1, {}, {}});
  }
  system.contacts = {{0.25, 0.8}};
  return system;
}

Branch backbone(const NonlinearMode& problem, double eta, double preload, double from, double to,
                const std::vector<double>& stops = {}) {
  continuation::TraceOptions options = over("R", from, to);
  options.stop_at = stops;
  return continuation::trace(problem, problem.guess(eta, from, preload), options);
}

double quantity(const NonlinearMode& problem, const BranchPoint& point, NonlinearMode::Quantity which) {
  Vector values;
  problem.observe(point.unknowns, point.parameters, point.regime, values);
  return values(which);
}

}  // namespace

TEST_CASE("The mode of a mass on a Jenkins element goes from sqrt(1.25) to 1", "[nonlinear mode]") {
  // tmdsimpy tests/test_epmc.py: w = 1.118033988750 at small amplitude, 1 at 1e5
  for (const int highest : {1, 5}) {
    const NonlinearMode problem(jenkins_oscillator(highest));
    const Branch branch = backbone(problem, 0.18, 1, 1e-3, 1e5);
    CAPTURE(highest, branch.explanation);
    REQUIRE(branch.complete());
    const BranchPoint& first = branch.points.front();
    CHECK_THAT(two_pi * quantity(problem, first, NonlinearMode::eta), WithinRel(1.118033988750, 1e-12));
    CHECK_THAT(quantity(problem, first, NonlinearMode::zeta), WithinRel(0.005 / 1.118033988750, 1e-10));
    const BranchPoint& last = branch.points.back();
    CHECK_THAT(two_pi * quantity(problem, last, NonlinearMode::eta), WithinRel(1.0, 1e-7));
    // 4 Fs (R - S) of friction over 2 pi w^2 R^2 of the energy, R = 1e5, beside c
    CHECK_THAT(quantity(problem, last, NonlinearMode::zeta), WithinRel(0.005 + 0.8 / (two_pi * 1e5), 1e-4));
    CHECK(of_type(branch, PointType::regime_switch).size() == 1);
  }
}

TEST_CASE("In stick the mode is the complex eigenvalue of the joined structures", "[nonlinear mode]") {
  // mass-proportional damping makes it exact: d_k with mu = -2 zeta eta is zero where eta and zeta say
  const NonlinearMode problem(
      one_harmonic({ContactModes(1, {{1, ContactVector::Ones(1), 1}}, Loss{.mass = 0.06}),
                    ContactModes(1, {{2, ContactVector::Ones(1), 0}}, Loss{.mass = 0.06}),
                    {{3, 1}}}));
  const Branch branch = backbone(problem, 1, 1, 0.1, 0.5);
  REQUIRE(branch.complete());
  // 1/(w - 1) + 1/(w - 4) = 1/3 at w = eta^2: w^2 - 11 w + 19 = 0
  const double square = (11 - std::sqrt(45.0)) / 2;
  for (const BranchPoint& point : branch.points) {
    CHECK_THAT(quantity(problem, point, NonlinearMode::eta), WithinRel(std::sqrt(square), 1e-9));
    CHECK_THAT(quantity(problem, point, NonlinearMode::zeta), WithinRel(0.03 / std::sqrt(square), 1e-9));
  }
}

TEST_CASE("All derivatives of nonlinear modes are exact", "[nonlinear mode]") {
  RandomSystems draw(9);
  for (int i = 0; i < 8; ++i) {
    SystemParameters parameters = figure_8(1);
    parameters.harmonics = odd_up_to(i % 2 == 0 ? 1 : 5);
    parameters.preload_growth = i % 4 == 0 ? 0.02 : 0;
    const NonlinearMode problem(build_harmonic_system(parameters));
    Vector u(problem.size());
    u(0) = draw.uniform(3, 5);
    u(1) = draw.uniform(-0.05, 0.1);
    const double S =
        problem.system().contacts[0].slip_per_preload * (1 + parameters.preload_growth * u(0) * u(0));
    Vector p(2);
    p << S * (i < 5 ? draw.uniform(1.6, 30) : 0.4), 1;
    for (Index a = 1; a < problem.harmonics(); ++a) {
      const Complex r = std::polar(p(0) * std::pow(2 * a + 1, -2.5), draw.uniform(-3, 3));
      u(2 * a) = r.real();
      u(2 * a + 1) = r.imag();
    }
    const continuation::DerivativeReport report = check_derivatives(problem, u, p, i < 5 ? 1 : 0);
    CAPTURE(i, report.where);
    CHECK(report.worst < 1e-6);  // of differences, near the poles of the compliance
  }
}

TEST_CASE("Where its damping vanishes a mode is the limit cycle", "[nonlinear mode]") {
  SystemParameters parameters = figure_8(1);
  parameters.base_damping = -1e-3;
  const NonlinearMode mode(build_harmonic_system(parameters));
  const double S = mode.system().contacts[0].slip_per_preload;
  continuation::TraceOptions options = over("R", 0.5 * S, 1e4 * S);
  options.events = {{"limit cycle", [](const Vector& u, const Vector&, const Regime&) {
                       return u(NonlinearMode::damping);
                     }}};
  const Branch branch = continuation::trace(mode, mode.guess(3.7, 0.5 * S, 1), options);
  CAPTURE(branch.explanation);
  REQUIRE(branch.complete());
  const std::vector<BranchPoint> cycles = of_type(branch, PointType::event);
  REQUIRE(!cycles.empty());
  const problems::LimitCycle direct(build_system(parameters));
  for (const BranchPoint& cycle : cycles) {
    Vector u(2);
    u << cycle.unknowns(0), std::log(cycle.parameters(0));
    Vector p(2);
    p << -1e-3, 1;
    Vector residual(2);
    REQUIRE(direct.evaluate(u, p, 0, {&residual}));
    CAPTURE(cycle.parameters(0) / S, cycle.unknowns(0));
    CHECK(residual.norm() < 1e-8);
  }
}

TEST_CASE("Near a mode the forced response is what the mode alone gives", "[nonlinear mode]") {
  // Two resonances far apart; the load drives one of them.
  const auto structure = [](double frequency, double load) {
    return ContactModes(1, {{frequency, ContactVector::Ones(1), load}}, Loss{.modal = 2e-3});
  };
  const ContactSystem system{structure(1, 1), structure(30, 0), {{0.05, 1}}};
  const NonlinearMode mode(one_harmonic(system));
  const problems::ForcedResponse direct(
      {ModalModel({{1, 1, 1}}, Loss{.modal = 2e-3}), ModalModel({{30, 1, 0}}, Loss{.modal = 2e-3}), 0.05, 1});
  const Branch branch = backbone(mode, 1, 1, 0.3, 100, {2, 5, 20, 60});
  REQUIRE(branch.complete());
  for (const BranchPoint& point : of_type(branch, PointType::user)) {
    const double force = quantity(mode, point, NonlinearMode::force);
    // the response scales with force and preload: at F = 1 and P = 1/force
    const double eta = quantity(mode, point, NonlinearMode::eta);
    const Branch response = trace_over_eta(direct, 1 / force, 0.8 * eta, 1.2 * eta);
    const std::vector<BranchPoint> peaks = of_type(response, PointType::peak);
    REQUIRE(peaks.size() == 1);
    CAPTURE(point.parameters(0), force);
    CHECK_THAT(peaks[0].parameters(0), WithinRel(eta, 2e-3));
    Vector values;
    direct.observe(peaks[0].unknowns, peaks[0].parameters, peaks[0].regime, values);
    CHECK_THAT(force * values(ForcedResponse::Y), WithinRel(quantity(mode, point, NonlinearMode::Y), 1e-2));
    const auto flanks = mode.flanks(point.unknowns, point.parameters, point.regime, 1.5 * force);
    REQUIRE(flanks);
    for (const double flank : *flanks) {
      const continuation::Guess at = direct.guess(flank, 1 / (1.5 * force));
      direct.observe(at.unknowns, at.parameters, at.regime, values);
      CHECK_THAT(
          1.5 * force * values(ForcedResponse::Y),
          WithinRel(quantity(mode, point, NonlinearMode::Y), 5e-2));  // beside the peak, at zeta = 0.06
    }
    CHECK(!mode.flanks(point.unknowns, point.parameters, point.regime, 0.9 * force));
  }
}
