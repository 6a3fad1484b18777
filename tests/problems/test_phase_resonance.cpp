// Curves along which an observable keeps its value: phase resonances, where the load does nothing but work,
// and curves of equal amplitude.

#include <cmath>

#include "arcslip/assembly/sector_pair.hpp"
#include "arcslip/continuation/curves/curve.hpp"
#include "arcslip/continuation/points/level_problem.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/problems/response/forced_response.hpp"
#include "arcslip/problems/response/harmonic_cycle.hpp"
#include "arcslip/problems/response/nonlinear_mode.hpp"
#include "arcslip/problems/response/power_balance.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "sector_examples.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::BasePoint;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::Level;
using continuation::PointType;
using problems::ForcedResponse;
using problems::HarmonicResponse;
using problems::NonlinearMode;

namespace {

const Level quarter_lag{"lag", 0.5 * pi};

/// m = 1, c, k = 1 with a Jenkins element of stiffness 0.25, which slips at 0.2 P, under a force of 1.
HarmonicSystem driven_oscillator(int highest) {
  HarmonicSystem system;
  system.orders = odd_up_to(highest);
  for (const int h : system.orders) {
    const double unit = 1 / two_pi;
    system.base.push_back({1,
                           {{1 / two_pi, ContactVector::Constant(1, unit), h == 1 ? unit : 0.0}},
                           Loss{.mass = 0.02 / two_pi}});
    system.damper.push_back({1, {}, {}});
  }
  system.contacts = {{0.25, 0.8}};
  system.outputs.push_back(driven_motion(system.base[0].with_driven_motion()));
  return system;
}

/// What is read at a point of a curve.
double read(const continuation::Problem& problem, const BasePoint& point, const std::string& name) {
  Vector values;
  problem.observe(point.unknowns, point.parameters, point.regime, values);
  return values(continuation::index_of(continuation::observable_names(problem), name));
}

/// The curves at a level over the preload, through the points that a response over eta has.
template <class Use>
int follow(const continuation::Problem& problem, const continuation::Guess& guess, const Level& level,
           double high, double from, double to, const Use& use) {
  continuation::TraceOptions options = over("eta", guess.parameters(0), high);
  options.extrema_of = {"Y"};
  options.events = {event_at(level, problem)};
  const Branch response = trace(problem, guess, options);
  REQUIRE(response.complete());
  int count = 0;
  for (const BranchPoint& seed : response.points) {
    if (seed.type != PointType::event || !is_at(level, problem, seed)) continue;
    const continuation::CurveStart start = curve_at(level, problem, "eta", seed);
    const Branch curve =
        trace_curve(*start.problem, start.point, over("P", from, to), {guess.parameters(0), high});
    INFO(curve.explanation);
    CHECK(curve.complete());
    for (const BranchPoint& point : curve.points)
      use(start.problem->split(point.unknowns, point.parameters, point.regime));
    ++count;
  }
  return count;
}

SystemParameters some_rods() {
  SystemParameters s;
  s.model = StructureModel::rods;
  s.elements = 12;
  s.mass_ratio = 3;
  s.frequency_ratio = 1.5;
  s.interface_stiffness = 40;
  s.base_damping = 1e-3;
  s.damper_damping = 2e-3;
  s.tells_lag = true;
  return s;
}

}  // namespace

TEST_CASE("The phase resonance of a mass on a Jenkins element is its nonlinear mode", "[phase resonance]") {
  // In one harmonic the balance of what is in phase with the motion is the same equation.
  const HarmonicResponse problem(driven_oscillator(1));
  const NonlinearMode mode(driven_oscillator(1));
  const int count =
      follow(problem, problem.guess(0.1, 10), quarter_lag, 0.3, 1e-2, 1e3, [&](const BasePoint& at) {
        const double eta = at.parameters(0);
        const double R = read(problem, at, "R");
        continuation::TraceOptions options = over("R", 1e-3 * at.parameters(1), R);
        const Branch branch = trace(mode, mode.guess(0.18, options.from, at.parameters(1)), options);
        REQUIRE(branch.complete());
        CHECK_THAT(branch.points.back().unknowns(NonlinearMode::frequency), WithinRel(eta, 1e-9));
        Vector values;
        const BranchPoint& end = branch.points.back();
        mode.observe(end.unknowns, end.parameters, end.regime, values);
        CHECK_THAT(values(NonlinearMode::force), WithinRel(1.0, 1e-8));
      });
  CHECK(count == 1);
}

TEST_CASE("At phase resonance the load does nothing but work", "[phase resonance]") {
  for (const bool is_beam : {false, true}) {
    SystemParameters parameters = some_rods();
    parameters.harmonics = {1, 3, 5};
    if (is_beam) parameters.model = StructureModel::beams;
    const HarmonicResponse problem(build_harmonic_system(parameters));
    const int count =
        follow(problem, problem.guess(1.1, 0.3), quarter_lag, 2, 0.1, 3, [&](const BasePoint& at) {
          const auto forces = problem.element_forces(at.unknowns, at.parameters, at.regime);
          const double drawn = problem.system().outputs.front().amplitude(at.parameters(0), forces.base[0]);
          const problems::PowerBalance power = power_balance(problem, at.unknowns, at.parameters, at.regime);
          CHECK_THAT(power.input, WithinRel(pi * drawn, 1e-9));
          if (!is_beam)  // whose load acts on rotations as well
            CHECK_THAT(read(problem, at, "beta"), WithinRel(0.5 * pi, 1e-9));
        });
    CHECK(count > 0);
  }
}

TEST_CASE("Stuck, phase resonance is where the real part of a compliance vanishes", "[phase resonance]") {
  const SystemParameters parameters = some_rods();
  const HarmonicResponse problem(build_harmonic_system(parameters));
  const FrictionSystem system = build_system(parameters);
  const auto real_part = [&](double eta, double k) {
    const Complex base = system.base.at(eta).compliance;
    const Complex damper = system.damper.at(eta).compliance;
    return std::real(base * (1.0 + k * damper) / (1.0 + k * (base + damper)));
  };
  const int count =
      follow(problem, problem.guess(1.1, 1e3), quarter_lag, 2, 1, 1e4, [&](const BasePoint& at) {
        const double k = system.contact_stiffness;
        const double eta = at.parameters(0);
        if (problem.describe(at.regime) != "stick") return;
        const double slope = (real_part(1.0001 * eta, k) - real_part(0.9999 * eta, k)) / (0.0002 * eta);
        CHECK(std::abs(real_part(eta, k) / (eta * slope)) < 1e-8);
      });
  CHECK(count > 0);
}

TEST_CASE("Phase resonances go through the peaks of a weakly damped response", "[phase resonance]") {
  SystemParameters parameters = some_rods();
  parameters.base_damping = parameters.damper_damping = 1e-5;
  const HarmonicResponse problem(build_harmonic_system(parameters));
  for (const double preload : {1e-4, 1e4}) {  // friction that dissipates next to nothing
    continuation::TraceOptions options = over("eta", 1.1, 2.0);
    options.extrema_of = {"Y"};
    const Branch response = trace(problem, problem.guess(1.1, preload), options);
    const auto peaks = of_type(response, PointType::peak);
    REQUIRE_FALSE(peaks.empty());
    double highest = 0;
    double found = 0;
    for (const BranchPoint& peak : peaks)
      highest = std::max(highest, read(problem, {peak.unknowns, peak.parameters, peak.regime, {}}, "Y"));
    follow(problem, problem.guess(1.1, preload), quarter_lag, 2, 0.9 * preload, preload,
           [&](const BasePoint& at) {
             if (at.parameters(1) != preload) return;
             double nearest = 1;
             for (const BranchPoint& peak : peaks)
               nearest = std::min(nearest, std::abs(at.parameters(0) / peak.parameters(0) - 1));
             constexpr double beside = 0.01;  // an antiresonance, where the lag falls
             if (nearest > beside) return;
             CHECK(nearest < parameters.base_damping);
             found = std::max(found, read(problem, at, "Y"));
           });
    CHECK_THAT(found, WithinRel(highest, 1e-4));  // of second order in the damping, friction's too
  }
}

TEST_CASE("A curve of equal amplitude goes through the regimes", "[phase resonance]") {
  const ForcedResponse problem(build_system(some_rods()));
  const Level level{"Y", 0.5};
  bool sticks = false;
  bool slips = false;
  const int count = follow(problem, problem.guess(1.1, 5), level, 2, 0.05, 30, [&](const BasePoint& at) {
    CHECK_THAT(read(problem, at, "Y"), WithinRel(level.value, 1e-9));
    const bool stuck = problem.describe(at.regime) == "stick";
    CHECK((read(problem, at, "R_over_S") - 1) * (stuck ? 1 : -1) < 1e-9);
    (stuck ? sticks : slips) = true;
  });
  CHECK(count > 0);
  CHECK(sticks);
  CHECK(slips);
}

TEST_CASE("Levels have exact derivatives, those of phases among them", "[phase resonance]") {
  SystemParameters parameters = some_rods();
  parameters.varied = "F";
  const ForcedResponse scalar(build_system(parameters));
  const HarmonicResponse harmonic(build_harmonic_system(parameters));
  const auto check = [](const continuation::Problem& problem, const continuation::Guess& at,
                        const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      const Index which = continuation::index_of(continuation::observable_names(problem), name);
      continuation::LevelProblem level(problem, 0, which,
                                       read(problem, {at.unknowns, at.parameters, at.regime, {}}, name));
      const BasePoint point{at.unknowns, at.parameters, at.regime, {}};
      REQUIRE(level.adapt(point));
      Vector u;
      Vector p;
      level.join(point, u, p);
      CAPTURE(name);
      const auto report = check_derivatives(level, u, p, at.regime);
      INFO(report.where);
      CHECK(report.worst < 1e-6);
    }
  };
  for (const double eta : {0.9, 1.5, 1.9}) {
    for (const double preload : {0.05, 5.0}) {
      const continuation::Guess at = scalar.guess(eta, preload);
      check(scalar, at, {"beta", "alpha", "psi", "Y"});
      check(harmonic, harmonic.guess(eta, preload), {"lag", "beta", "alpha", "psi", "Y"});
    }
  }
}

TEST_CASE("Modes whose damping ratio is held at zero are limit cycles", "[phase resonance]") {
  SystemParameters parameters = some_rods();
  parameters.tells_lag = false;
  parameters.base_damping = -1e-2;
  const HarmonicSystem system = build_harmonic_system(parameters);
  const NonlinearMode mode(system);
  const problems::HarmonicCycle cycle(system);
  const Level undamped{"zeta", 0};
  continuation::TraceOptions options = over("R", 1e-3, 10);
  options.events = {event_at(undamped, mode)};
  const Branch branch = trace(mode, mode.guess(1.7, 1e-3, 1), options);
  const auto seeds = of_type(branch, PointType::event);
  REQUIRE_FALSE(seeds.empty());
  for (const BranchPoint& seed : seeds) {
    const continuation::CurveStart start = curve_at(undamped, mode, "R", seed);
    const Branch curve = trace_curve(*start.problem, start.point, over("P", 0.1, 10));
    REQUIRE(curve.complete());
    for (const BranchPoint& point : curve.points) {
      const BasePoint at = start.problem->split(point.unknowns, point.parameters, point.regime);
      Vector u = at.unknowns;
      u(problems::HarmonicCycle::amplitude) = at.parameters(0);
      Vector residual(cycle.size());
      REQUIRE(cycle.evaluate(u, Eigen::Vector2d(-1e-2, at.parameters(1)), at.regime, {&residual}));
      CHECK(residual.norm() < 1e-10);
      CHECK_THAT(at.parameters(0) / at.parameters(1), WithinRel(seed.parameters(0), 1e-9));
    }
  }
}
