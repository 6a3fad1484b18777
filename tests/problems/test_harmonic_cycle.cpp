// Self-excited vibration and responses of a base that moves as if alone, in several harmonics and contacts.

#include "arcslip/problems/response/harmonic_cycle.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/elements/memoryless.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "arcslip/problems/response/limit_cycle.hpp"
#include "arcslip/problems/response/one_way_response.hpp"
#include "catch.hpp"
#include "paper_cases.hpp"
#include "random_systems.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::Guess;
using problems::HarmonicCycle;
using problems::HarmonicResponse;
using problems::LimitCycle;

namespace {

SystemParameters held_rods(int highest) {
  SystemParameters parameters = rods(1);
  parameters.elements = 12;
  parameters.interface_stiffness = 100;
  parameters.fixed_damper = true;
  parameters.harmonics = odd_up_to(highest);
  return parameters;
}

/// Two unequal contacts a sector of three modes on each side.
HarmonicSystem two_contacts(const std::vector<int>& orders, double stiffening) {
  HarmonicSystem system;
  system.orders = orders;
  for (const int h : orders) {
    const auto mode = [h](double frequency, Complex a, Complex b, double load) {
      return ContactMode{frequency * std::sqrt(h), ContactVector(Eigen::Vector2cd(a, b)),
                         h == 1 ? load : 0.0};
    };
    system.base.push_back(
        ContactModes(2, {mode(1.1, 0.3, {0.2, 0.1}, 1), mode(2.3, 0.2, -0.3, 0.4), mode(5.0, 0.1, 0.2, -0.3)},
                     Loss{.viscous = -0.004}));
    system.damper.push_back(
        ContactModes(2, {mode(0.8, 0.9, {0.7, -0.2}, 0), mode(3.1, 0.5, -0.8, 0)}, Loss{.viscous = 0.002}));
  }
  system.contacts = {{3.0, 0.4}, {5.0, 0.3}};
  system.base_loss_per_zeta = {.viscous = 2};
  if (stiffening != 0) {
    for (Index i = 0; i < 2; ++i) system.others.push_back({1, 0, i, cubic_spring(stiffening, 20)});
  }
  return system;
}

/// What base, damper and friction take from a motion without load over a cycle, and the largest of these.
std::pair<double, double> work_of(const HarmonicCycle& cycle, const BranchPoint& point) {
  const HarmonicSystem& system = cycle.system();
  HarmonicSystem damped = system;
  for (ContactModes& base : damped.base) {
    std::vector<ContactMode> modes = base.modes();
    for (ContactMode& mode : modes) mode.load = 0;
    base = ContactModes(2, modes, point.parameters(HarmonicCycle::zeta) * system.base_loss_per_zeta);
  }
  const HarmonicResponse response(damped);
  Vector u(cycle.size());
  u << point.unknowns(HarmonicCycle::amplitude), 0, point.unknowns.tail(u.size() - 2);
  Vector p(2);
  p << point.unknowns(HarmonicCycle::eta), point.parameters(HarmonicCycle::preload);
  const HarmonicResponse::ElementForces forces = response.element_forces(u, p, point.regime);
  double sum = forces.energy;
  double largest = forces.energy;
  for (std::size_t a = 0; a < system.orders.size(); ++a) {
    const int h = system.orders[a];
    for (const double part : {damped.base[a].work(h * p(0), forces.base[a]).damping,
                              damped.damper[a].work(h * p(0), forces.damper[a]).damping}) {
      sum += h * part;
      largest = std::max(largest, std::abs(h * part));
    }
  }
  return {sum, largest};
}

}  // namespace

TEST_CASE("Limit cycles in several harmonics are those of an independent balance", "[cycle]") {
  struct Known {
    int highest;
    double eta;
    double R;
  };
  const Known known = GENERATE(values<Known>(
      {{1, 4.109548671, 0.844397994}, {9, 4.109557706, 0.843814851}, {21, 4.109557720, 0.843814315}}));
  const HarmonicCycle problem(build_harmonic_system(held_rods(known.highest)));
  const Guess at = problem.guess(-1e-3, 1);
  CHECK_THAT(at.unknowns(HarmonicCycle::eta), WithinAbs(known.eta, 1e-9));
  CHECK_THAT(at.unknowns(HarmonicCycle::amplitude), WithinAbs(known.R, 1e-9));
}

TEST_CASE("In one harmonic of one contact limit cycles are those of the scalar equation",
          "[cycle][random][numbers]") {
  RandomSystems draw(7);
  int found = 0;
  for (int i = 0; i < 16; ++i) {
    SystemParameters parameters = draw.system();
    parameters.base_damping = -1e-3;
    const LimitCycle scalar(build_system(parameters));
    const HarmonicCycle general(build_harmonic_system(parameters));
    const double zeta = -draw.log_uniform(1e-4, 1e-1);
    Guess expected;
    try {
      expected = scalar.guess(zeta, parameters.preload);
    } catch (const std::invalid_argument&) {
      CHECK_THROWS_AS(general.guess(zeta, parameters.preload), std::invalid_argument);
      continue;
    }
    CAPTURE(i, zeta, expected.unknowns(0));
    const Guess at = general.guess(zeta, parameters.preload);
    CHECK_THAT(at.unknowns(HarmonicCycle::eta), WithinRel(expected.unknowns(LimitCycle::eta), 1e-8));
    CHECK_THAT(std::log(at.unknowns(HarmonicCycle::amplitude)),
               WithinAbs(expected.unknowns(LimitCycle::log_R), 1e-6));
    ++found;
  }
  CHECK(found > 3);
}

TEST_CASE("A limit cycle of two contacts in five harmonics lives on what its base feeds in", "[cycle]") {
  const double stiffening = GENERATE(0.0, 0.02);
  const HarmonicCycle problem(two_contacts(odd_up_to(9), stiffening));
  const Guess start = problem.guess(-0.003, 1);
  const Branch branch = continuation::trace_both(problem, start, over("zeta_B", -0.0005, -0.05));
  INFO(branch.explanation);
  REQUIRE(branch.points.size() > 5);
  bool both_slip = false;
  for (const BranchPoint& point : branch.points) {
    const auto [sum, largest] = work_of(problem, point);
    CAPTURE(point.regime, point.unknowns(0), point.unknowns(1), point.parameters(0), stiffening);
    CHECK(std::abs(sum) < 1e-8 * largest);
    both_slip = both_slip || point.regime == continuation::regime_of_bits(3);
  }
  CHECK(both_slip);
}

TEST_CASE("Derivatives of limit cycles and one-way responses are exact", "[cycle]") {
  const double stiffening = GENERATE(0.0, 0.02);
  HarmonicSystem system = two_contacts({1, 3, 5}, stiffening);
  const HarmonicCycle cycle(system);
  Guess at = cycle.guess(-0.003, 1);
  at.unknowns.array() += 0.01 * at.unknowns.norm();
  const auto of_cycle = continuation::check_derivatives(cycle, at.unknowns, at.parameters, at.regime);
  INFO(of_cycle.where);
  CHECK(of_cycle.worst < 1e-6);
  system.one_way = true;
  const HarmonicResponse response(system);
  Guess driven = response.guess(1.3, 0.2);
  driven.unknowns.array() += 0.01 * driven.unknowns.norm();
  const auto of_response =
      continuation::check_derivatives(response, driven.unknowns, driven.parameters, driven.regime);
  INFO(of_response.where);
  CHECK(of_response.worst < 1e-6);
}

TEST_CASE("A base that moves as if alone does so in all harmonics, whatever the contacts do", "[one_way]") {
  HarmonicSystem system = two_contacts({1, 3, 5}, 0);
  system.one_way = true;
  const HarmonicResponse problem(system);
  for (const double preload : {0.01, 0.1, 1.0}) {
    const Guess at = problem.guess(1.3, preload);
    Vector values;
    problem.observe(at.unknowns, at.parameters, at.regime, values);
    CAPTURE(preload, at.regime);
    CHECK_THAT(values(HarmonicResponse::Y), WithinRel(std::abs(system.base[0].at(1.3).free(0)), 1e-10));
    const auto names = continuation::observable_names(problem);
    for (const char* name : {"Y_h3", "Y_h5"})
      CHECK(values(continuation::index_of(names, name)) < 1e-10 * values(HarmonicResponse::Y));
  }
}

TEST_CASE("One-way responses of one contact are those of the scalar equation", "[one_way][random]") {
  RandomSystems draw(11);
  for (int i = 0; i < 30; ++i) {
    SystemParameters parameters = draw.system();
    const problems::OneWayResponse scalar(build_system(parameters));
    parameters.one_way = true;
    const HarmonicResponse general(build_harmonic_system(parameters));
    const double eta = draw.log_uniform(0.3, 30);
    Vector expected;
    Vector found;
    const Guess one = scalar.guess(eta, parameters.preload);
    scalar.observe(one.unknowns, one.parameters, one.regime, expected);
    const Guess other = general.guess(eta, parameters.preload);
    general.observe(other.unknowns, other.parameters, other.regime, found);
    CAPTURE(i, eta);
    for (Index k = 0; k < 9; ++k) CHECK_THAT(found(k), WithinRel(expected(k), 1e-8) || WithinAbs(0, 1e-12));
  }
}

TEST_CASE("Vibration without a load takes even harmonics as well") {
  CHECK_NOTHROW(HarmonicCycle(two_contacts({1, 3}, 1)));
  CHECK_NOTHROW(HarmonicCycle(two_contacts({1, 0, 2, 3}, 1)));
}
