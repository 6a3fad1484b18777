// Whole rings in time and the disturbances of their responses: alike they are one sector, and unlike what the
// motion of all nodes tells.

#include <cmath>

#include "arcslip/assembly/structures.hpp"
#include "arcslip/problems/response/floquet_response.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "arcslip/time/ring_record.hpp"
#include "arcslip/time/ring_stability.hpp"
#include "catch.hpp"
#include "ring_cases.hpp"
#include "whole_rings.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Guess;
using problems::FloquetResponse;
using Course = WholeLoad::Course;

namespace {

struct WholeTimed {
  Complex base;     ///< y_1 of node 1
  Complex forward;  ///< r_1 of it
  double growth;    ///< in a period
  bool slips;
};

WholeTimed whole_timed(const SystemParameters& system, double eta) {
  const auto problem = testing::response_of(system);
  const Guess at = problem.guess(eta, system.preload);
  RingMotion motion(build_ring(system), eta, system.preload);
  const SettledMotion found = shoot(motion, motion.travelling(problems::ring_harmonics(problem, at)));
  REQUIRE(found.settled);
  HarmonicRecord record(motion, {1}, true);
  next_state(motion, found.state, &record);
  const RingStability stability = floquet_stability(motion, found.state);
  return {record.base()(0), record.relative()(0), stability.growth(), stability.slips};
}

/// The greatest |mu| that the balance tells.
double balanced_growth(const SystemParameters& system, double eta, int highest) {
  SystemParameters wide = system;
  wide.harmonics = odd_up_to(highest);
  const auto problem = problems::build_floquet_response(wide);
  const Guess at = problem->guess(eta, system.preload);
  return problem->worst(at.unknowns, at.parameters, at.regime).growth;
}

SystemParameters at_preload(SystemParameters one, double preload) {
  one.preload = preload;
  return one;
}

/// Under this part of the preload below which one of its contacts begins to slip.
SystemParameters slipping(SystemParameters system, double eta, double part = .5) {
  constexpr double sticks = 1e6;
  const auto problem = testing::response_of(system);
  const ComplexMatrix relative = problems::sector_motions(problem, problem.guess(eta, sticks)).relative;
  double holding = 0;
  for (Index i = 0; i < relative.size(); ++i) {
    const SectorContact& contact = problem.system().contacts[static_cast<std::size_t>(i)];
    holding = std::max(holding, std::abs(relative.reshaped()(i)) / contact.slip_per_preload);
  }
  system.preload = part * holding;
  return system;
}

/// Contacts, blades and one link that differ, viscously damped.
SystemParameters uneven_disk(Index sectors, double preload, Course course, double base_damping) {
  SystemParameters one =
      blisk(preload, sectors, 1, DampingKind::viscous, {{{0, 1}, {1, -1}}, {{2, 1}}}, {{{0, 1}}}, 100);
  one.base_damping = base_damping;
  one.damper_damping = .02;
  RingMake make = ring_of(one, course);
  make.base_ports = 2;
  make.damper_ports = 1;
  RingContacts contacts;
  for (Index i = 0; i < sectors; ++i) {
    const double z = std::sin(1.7 * static_cast<double>(i) + .3);
    make.changes.push_back({true, {{{i, 0, 1}}}, Matrix::Constant(1, 1, 4e4 * z)});
    make.changes.push_back({true, {{{i, 1, 1}}}, Matrix::Zero(1, 1), Matrix::Constant(1, 1, .01 * z)});
    contacts.limit.push_back(1 + .3 * z);
    contacts.stiffness.push_back(1 - .2 * z);
  }
  make.changes.push_back({false, {{{sectors - 1, 0, -1}, {0, 0, 1}}}, Matrix::Constant(1, 1, -5e6)});
  return whole_of(one, make, contacts);
}

}  // namespace

TEST_CASE("All sectors alike move in time as one of them", "[ring][whole ring]") {
  struct Alike {
    SystemParameters one;
    double eta;
  };
  const auto disk = [](Index sectors, Index waves) {
    SystemParameters one = blisk(.3, sectors, waves);
    one.base_damping = one.damper_damping = .01;
    return one;
  };
  SystemParameters rods = at_preload(small_rods(6), .1);
  rods.harmonics = {1, 3, 5};
  // n and N with a common factor, n = N/2, n = 0 and n beyond N/2.
  for (const Alike& of : {Alike{rods, 2.3},
                          {at_preload(small_beams(5), 1), 3.7},
                          {disk(12, 4), 553},
                          {disk(6, 3), 560},
                          {disk(4, 0), 500},
                          {disk(5, 3), 553}}) {
    const SystemParameters one = slipping(of.one, of.eta);
    const WholeTimed expected = whole_timed(one, of.eta);
    const WholeTimed found = whole_timed(whole_of(one, ring_of(one, Course::travelling)), of.eta);
    CAPTURE(of.one.elements, of.one.wave_number, of.eta, expected.slips);
    CHECK(expected.slips);
    CHECK(std::abs(found.base - expected.base) < 1e-9 * std::abs(expected.base));
    CHECK(std::abs(found.forward - expected.forward) < 1e-9 * std::abs(expected.base));
    CHECK_THAT(found.growth, WithinRel(expected.growth, 1e-8));
  }
}

TEST_CASE("The disturbances of all sectors alike are those of one", "[stability][whole ring]") {
  struct Alike {
    SystemParameters one;
    double eta;
  };
  const auto disk = [](Index sectors, Index waves, double damping) {
    SystemParameters one = blisk(.3, sectors, waves, DampingKind::viscous);
    one.base_damping = damping;
    one.damper_damping = .02;
    return one;
  };
  const SystemParameters driven_rods = at_preload(driven(small_rods(6), -.002), .03);
  for (const Alike& of : {Alike{driven_rods, 2.3},
                          {disk(6, 2, .01), 553},
                          {disk(6, 3, .01), 560},
                          {disk(6, 0, .01), 550},
                          {disk(8, 2, -.002), 553},
                          {disk(4, 2, -.002), 560},
                          {disk(3, 0, -.002), 550}}) {
    CAPTURE(of.one.elements, of.one.wave_number, of.eta);
    const SystemParameters one = slipping(of.one, of.eta);
    for (const int highest : {3, 7}) {
      const double expected = balanced_growth(one, of.eta, highest);
      const SystemParameters whole = whole_of(one, ring_of(one, Course::travelling));
      CHECK_THAT(balanced_growth(whole, of.eta, highest), WithinRel(expected, 1e-8));
    }
  }
}

TEST_CASE("Disturbances of unequal sectors are those of their motion in time", "[stability][whole ring]") {
  constexpr double near = 1e-3;
  int unstable = 0;
  double worst = 0;
  for (const double damping : {.01, -.004}) {
    for (const Course course : {Course::standing, Course::point, Course::travelling}) {
      for (const Index sectors : {3, 4, 6}) {
        SystemParameters system =
            slipping(uneven_disk(sectors, .2, course, damping), 553, damping > 0 ? .5 : .9);
        system.harmonics = odd_up_to(9);
        const WholeTimed expected = whole_timed(system, 553);
        const double found = balanced_growth(system, 553, 9);
        CAPTURE(sectors, to_string(course), damping, expected.growth, found);
        CHECK(expected.slips);
        CHECK(std::abs(found - expected.growth) < near);
        worst = std::max(worst, std::abs(found - expected.growth));
        if (expected.growth > 1 + near) ++unstable;
      }
    }
  }
  CAPTURE(worst);
  CHECK(unstable > 0);
  CHECK(unstable < 18);
}

TEST_CASE("A whole ring has modes where its damping keeps them apart", "[whole ring]") {
  const auto modal = [](const SystemParameters& system) {
    SystemParameters other = system;
    other.structures = structures_of(system).in_modes();
    return structures_of(other).wave(other);
  };
  CHECK(modal(uneven_disk(4, 1, Course::standing, .01)).contacts.size() == 4);
  const SystemParameters one = blisk(1, 4, 1, DampingKind::modal, {{{2, 1}}});
  RingMake make = ring_of(one, Course::standing);
  CHECK_NOTHROW(modal(whole_of(one, make)));
  make.base_ports = 1;
  make.changes = {{true, {{{1, 0, 1}}}, Matrix::Constant(1, 1, 1e4)}};
  CHECK_THROWS_WITH(build_ring(whole_of(one, make)), ContainsSubstring("modal damping"));
  const SystemParameters viscous = blisk(1, 4, 1, DampingKind::viscous, {{{2, 1}}});
  make.structures = viscous.structures;
  CHECK_NOTHROW(build_ring(whole_of(viscous, make)));
  const auto refused = [&](const std::string& why) {
    const SystemParameters whole = whole_of(viscous, make);
    CHECK_THROWS_WITH(build_ring(whole), ContainsSubstring(why));
    CHECK_THROWS_WITH(structures_of(whole).whole()->check_changes(whole), ContainsSubstring(why));
  };
  make.changes.front().mass = Matrix::Constant(1, 1, -.25);
  refused("without mass");
  make.changes = {{true, {{{1, 0, 1}}}, Matrix::Constant(1, 1, -1e8)}};
  refused("less than no stiffness");
}
