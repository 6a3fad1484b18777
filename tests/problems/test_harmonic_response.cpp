#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "arcslip/problems/response/power_balance.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "arcslip/time/ring_record.hpp"
#include "arcslip/time/ring_response.hpp"
#include "catch.hpp"
#include "paper_cases.hpp"
#include "random_systems.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::Guess;
using continuation::PointType;
using continuation::Regime;
using problems::ForcedResponse;
using problems::HarmonicResponse;

namespace {

HarmonicResponse balanced(SystemParameters parameters, int highest) {
  parameters.harmonics = odd_up_to(highest);
  return HarmonicResponse(build_harmonic_system(parameters));
}

/// An observable by name.
double observed(const HarmonicResponse& problem, const Vector& u, const Vector& p, const Regime& regime,
                const std::string& name) {
  Vector values;
  problem.observe(u, p, regime, values);
  return values(continuation::index_of(continuation::observable_names(problem), name));
}

double observed(const HarmonicResponse& problem, const Guess& at, const std::string& name) {
  return observed(problem, at.unknowns, at.parameters, at.regime, name);
}

double observed(const HarmonicResponse& problem, const BranchPoint& at, const std::string& name) {
  return observed(problem, at.unknowns, at.parameters, at.regime, name);
}

/// One mass on a spring, x'' + x, held by a contact to ground: shape and load are 1.
HarmonicSystem oscillator(int highest, double stiffness, double damping) {
  HarmonicSystem system;
  system.orders = odd_up_to(highest);
  for (const int h : system.orders) {
    system.base.push_back({1, {{1, ContactVector::Ones(1), h == 1 ? 1.0 : 0.0}}, Loss{.modal = 2 * damping}});
    system.damper.push_back({1, {}, {}});
  }
  system.contacts = {{stiffness, 1 / stiffness}};  // the slip force is P
  return system;
}

}  // namespace

TEST_CASE("One harmonic has the branches of the scalar equation", "[harmonics]") {
  for (const double preload : {0.1, 1.0, 50.0}) {
    const ForcedResponse scalar(build_system(figure_8(preload)));
    const HarmonicResponse problem = balanced(figure_8(preload), 1);
    const Branch expected = trace_over_eta(scalar, preload, 0.5, 120);
    const Branch found = trace_over_eta(problem, preload, 0.5, 120);
    CAPTURE(preload, found.explanation);
    REQUIRE(found.complete());
    for (const PointType type : {PointType::peak, PointType::trough, PointType::regime_switch}) {
      const std::vector<BranchPoint> right = of_type(expected, type);
      const std::vector<BranchPoint> points = of_type(found, type);
      REQUIRE(points.size() == right.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        CHECK_THAT(points[i].parameters(0), WithinRel(right[i].parameters(0), 1e-10));
        CHECK_THAT(observed(problem, points[i], "Y"),
                   WithinRel(quantity(scalar, right[i], ForcedResponse::Y), 1e-10));
      }
    }
  }
}

TEST_CASE("Without slip any number of harmonics is the linear response", "[harmonics]") {
  const ForcedResponse scalar(build_system(figure_8(1e3)));
  const HarmonicResponse problem = balanced(figure_8(1e3), 15);
  for (const double eta : {0.5, 3.67, 4.0, 60.0, 100.0}) {
    const Guess right = scalar.guess(eta, 1e3);
    const Guess found = problem.guess(eta, 1e3);
    REQUIRE(found.regime == 0);
    Vector values;
    scalar.observe(right.unknowns, right.parameters, right.regime, values);
    CAPTURE(eta);
    CHECK_THAT(observed(problem, found, "Y"), WithinRel(values(ForcedResponse::Y), 1e-10));
    CHECK_THAT(observed(problem, found, "U"), WithinRel(values(ForcedResponse::U), 1e-10));
    CHECK(observed(problem, found, "Y_h3") == 0);
  }
}

TEST_CASE("At the best preload of figure 8 nine harmonics give Y = 0.00843, many 0.0083267", "[harmonics]") {
  const HarmonicResponse few = balanced(figure_8(1), 9);
  const Guess known = few.guess(3.841, 1);
  const auto Y = [&](int highest) {  // from the solution of nine harmonics
    const HarmonicResponse problem = balanced(figure_8(1), highest);
    Guess guess{Vector::Zero(problem.size()), known.parameters, known.regime};
    const Index shared = std::min(problem.size(), few.size());
    guess.unknowns.head(shared) = known.unknowns.head(shared);
    const Branch branch = continuation::trace(problem, guess, over("eta", 3.841, 3.8410001));
    return observed(problem, branch.points.at(0), "Y");
  };
  CHECK_THAT(Y(1), WithinRel(0.007188, 1e-4));
  CHECK_THAT(Y(9), WithinRel(0.00843, 0.01));
  // Harmonics 29 and 31 travel round 30 elements as one wave back and forth and meet its other mode, so that
  // more than these must be kept. From 151 on the last digits no longer change.
  const double many = Y(151);
  CHECK_THAT(many, WithinRel(Y(201), 1e-6));
  CHECK_THAT(many, WithinRel(0.0083267, 1e-5));
}

TEST_CASE("The ring of figure 8 in time has the amplitude of many harmonics at the best preload",
          "[harmonics][numbers]") {
  const HarmonicResponse problem = balanced(figure_8(1), 63);
  const Guess at = problem.guess(3.841, 1);
  RingMotion motion(build_ring(figure_8(1)), 3.841, 1);
  const SettledMotion settled = shoot(motion, motion.travelling(problems::ring_harmonics(problem, at)), 1e-9);
  REQUIRE(settled.settled);
  RingState state = settled.state;
  HarmonicRecord record(motion, {1, 3});
  motion.advance(state, motion.period(), &record);
  CHECK_THAT(observed(problem, at, "Y"), WithinRel(std::abs(record.base()(0)), 1e-4));
  CHECK_THAT(observed(problem, at, "R_h3"), WithinRel(std::abs(record.relative()(1)), 1e-3));
  CHECK_THAT(std::abs(record.base()(0)), WithinRel(0.0083267258, 1e-8));
}

TEST_CASE("Branches of nine harmonics lose no energy, whatever the preload", "[harmonics]") {
  for (const double preload : {1e-4, 0.1, 1.0, 5.0, 50.0}) {
    const HarmonicResponse problem = balanced(figure_8(preload), 9);
    const Branch branch = trace_over_eta(problem, preload, 0.5, 120);
    CAPTURE(preload, branch.explanation);
    REQUIRE(branch.complete());
    for (const BranchPoint& point : branch.points) {
      const problems::PowerBalance power =
          power_balance(problem, point.unknowns, point.parameters, point.regime);
      CAPTURE(point.parameters(0), power.input, power.friction);
      CHECK(power.friction >= 0);
      CHECK(power.error() * power.cancellation() < 1e-6);  // the residual 1e-10 over the damping ratio 1e-4
    }
  }
}

TEST_CASE("Branches of random systems in five harmonics reach their end and lose no energy", "[harmonics]") {
  RandomSystems draw(1);
  for (int i = 0; i < 20; ++i) {
    const SystemParameters parameters = draw.system();
    const auto [low, high] = resonance_range(parameters);
    const HarmonicResponse problem = balanced(parameters, 5);
    const Branch branch = trace_over_eta(problem, parameters.preload, low, high);
    CAPTURE(i, branch.explanation);
    REQUIRE(branch.complete());
    double worst = 0;
    for (const BranchPoint& point : branch.points) {
      const problems::PowerBalance power =
          power_balance(problem, point.unknowns, point.parameters, point.regime);
      worst = std::max(worst, power.error() * power.cancellation());
    }
    CHECK(worst < 1e-4);  // the residual 1e-10 over damping ratios down to 1e-6
  }
}

TEST_CASE("Corners within slip, where the branch of a negative damping turns back, are passed",
          "[harmonics]") {
  SystemParameters parameters = figure_8(1);
  parameters.base_damping = -1e-2;
  const HarmonicResponse problem = balanced(parameters, 25);
  const Branch branch = trace_over_eta(problem, 1, 3.9, 4.1);
  CAPTURE(branch.explanation);
  REQUIRE(branch.complete());
  CHECK(branch.points.back().regime == 0);
  const auto turns = [](const BranchPoint& point) { return point.type == PointType::corner_fold; };
  CHECK(std::any_of(branch.points.begin(), branch.points.end(), turns));
  for (const BranchPoint& point : branch.points) {
    const problems::PowerBalance power =
        power_balance(problem, point.unknowns, point.parameters, point.regime);
    CHECK(power.error() * power.cancellation() < 1e-6);
  }
}

TEST_CASE("The error of power is one of phases, however light the damping of a system is", "[harmonics]") {
  RandomSystems draw(29);
  double largest_cancellation = 0;
  double largest_of_works = 0;
  for (int i = 0; i < 60; ++i) {
    SystemParameters s;
    s.model = draw.integer(0, 1) == 0 ? StructureModel::rods : StructureModel::beams;
    s.elements = draw.integer(3, 60);
    s.mass_ratio = draw.log_uniform(1e-3, 1e3);
    s.frequency_ratio = draw.log_uniform(0.01, 100);
    s.interface_stiffness = draw.log_uniform(1e-3, 1e8);
    s.base_damping = draw.log_uniform(1e-7, 0.5);
    s.damper_damping = draw.log_uniform(1e-7, 0.5);
    s.preload = draw.log_uniform(1e-6, 1e6);
    const FrictionSystem system = build_system(s);
    const std::vector<double> resonances =
        joined_frequencies({&system.base, &system.damper}, system.contact_stiffness);
    const HarmonicResponse problem = balanced(s, 1);
    const Branch branch = trace_over_eta(problem, s.preload, 0.3 * resonances[0], 1.3 * resonances[0]);
    CAPTURE(i, branch.explanation);
    REQUIRE(branch.complete());
    for (const BranchPoint& point : branch.points) {
      const problems::PowerBalance power =
          power_balance(problem, point.unknowns, point.parameters, point.regime);
      CHECK(power.error() < 1e-3);  // the residual 1e-10 over damping ratios down to 1e-7
      largest_cancellation = std::max(largest_cancellation, power.cancellation());
      largest_of_works = std::max(largest_of_works, power.error() * power.cancellation());
    }
  }
  CHECK(largest_cancellation > 1e6);
  CHECK(largest_of_works > 1e-3);
}

TEST_CASE(
    "A harmonic that moves both rings as rigid bodies has an undamped resonance, which stick does not feel",
    "[harmonics]") {
  // of 9 nodes harmonic 9 moves all alike; nothing damps the stuck rings against each other at eta = 0.6126
  for (const double preload : {1.0, 50.0}) {
    SystemParameters parameters = rods(preload);
    parameters.elements = 9;
    const HarmonicResponse problem = balanced(parameters, 9);
    const Branch branch = trace_over_eta(problem, preload, 0.5, 20);
    CAPTURE(preload, branch.explanation);
    CHECK(branch.complete());
  }
}

TEST_CASE("All derivatives with several harmonics are exact", "[harmonics]") {
  RandomSystems draw(5);
  for (int i = 0; i < 12; ++i) {
    SystemParameters parameters = figure_8(1);
    parameters.preload_growth = i % 3 == 0 ? 0.02 : 0;
    const HarmonicResponse problem = balanced(parameters, i % 2 == 0 ? 3 : 7);
    const double eta = draw.uniform(3, 5);
    Vector p(2);
    p << eta, 1;
    const double S =
        problem.system().contacts[0].slip_per_preload * (1 + parameters.preload_growth * eta * eta);
    Vector u(problem.size());
    const double amplitude = S * (i < 8 ? draw.uniform(1.6, 30) : 0.4);
    for (Index a = 0; a < problem.harmonics(); ++a) {
      const Complex r = std::polar(amplitude * std::pow(2 * a + 1, -2.5), draw.uniform(-3, 3));
      u(2 * a) = r.real();
      u(2 * a + 1) = r.imag();
    }
    const continuation::DerivativeReport report = check_derivatives(problem, u, p, i < 8 ? 1 : 0);
    CAPTURE(i, report.where);
    CHECK(report.worst < 1e-7);  // of differences
  }
}

TEST_CASE("A stiff contact with many harmonics approaches Den Hartog's Coulomb friction",
          "[harmonics][numbers]") {
  // X of x'' + x + f sgn x' = cos(r t), motion without stops [Den Hartog, Trans. ASME 53 (1931) 107]
  struct Case {
    double r;
    double friction;
    double amplitude;
  };
  const auto error = [](const Case& one, int highest, double stiffness) {
    const HarmonicResponse problem(oscillator(highest, stiffness, 0));
    return std::abs(observed(problem, problem.guess(one.r, one.friction), "R_peak") / one.amplitude - 1);
  };
  for (const Case& one : {Case{0.9, 0.4, 4.6203419164}, {1.1, 0.2, 4.5909249073}}) {
    CAPTURE(one.r, one.friction);
    const double soft = error(one, 15, 1e2);
    const double stiff = error(one, 15, 1e5);
    CHECK(stiff < 0.3 * soft);                 // the spring's share falls with its stiffness,
    CHECK(error(one, 31, 1e5) < 0.7 * stiff);  // that of the harmonics left out as 1/H, for the force jumps
    CHECK(error(one, 31, 1e5) < 4e-3);
  }
}
