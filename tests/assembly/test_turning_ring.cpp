// Whole rings whose sectors turn, waves of which differ by their direction: against one sector and against
// matrices of all dofs.

#include <Eigen/LU>

#include "arcslip/dense.hpp"
#include "arcslip/elements/contact.hpp"
#include "catch.hpp"
#include "draws.hpp"
#include "exact_response.hpp"
#include "turning_rings.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Guess;
using problems::HarmonicResponse;
using problems::sector_motions;
using problems::SectorMotions;
using Course = WholeLoad::Course;

namespace {

/// The largest difference of all motions in one harmonic from those of dense matrices under load and contact
/// forces, relative.
double dense_difference(const SystemParameters& system, const HarmonicResponse& problem, const Guess& at,
                        double speed, const ComplexVector& on_base, const ComplexVector& on_damper,
                        Index order = 0) {
  const RingMake& make = structures_of(system).whole()->make();
  const Index n = make.sectors;
  const double eta = at.parameters(0) * problem.system().multiple(order);
  const Loss loss = structures_of(system).losses(system).base(system);
  ComplexVector force = ComplexVector::Zero(8 * n);
  for (Index i = 0; i < n; ++i) {
    const double angle =
        two_pi * static_cast<double>((system.wave_number * i % n + n) % n) / static_cast<double>(n);
    const Complex amplitude = make.load.course == Course::travelling ? std::polar(1.0, -angle)
                              : make.load.course == Course::standing ? Complex(std::cos(angle))
                              : make.load.course == Course::given
                                  ? make.load.sectors[static_cast<std::size_t>(i)]
                                  : Complex(i == 0);
    if (order == 0) force(6 * i + 2) = amplitude;
    force.segment(6 * i, 2) += on_base.segment(2 * i, 2);
    force.segment(6 * n + 2 * i, 2) += on_damper.segment(2 * i, 2);
  }
  const ComplexVector d = dense_z(n, .1, eta, speed, loss.at(eta)).partialPivLu().solve(force);
  const SectorMotions found = sector_motions(problem, at, order);
  double worst = 0;
  for (Index i = 0; i < n; ++i) {
    const ComplexVector base = d.segment(6 * i, 2);
    const ComplexVector damper = d.segment(6 * n + 2 * i, 2);
    worst = std::max({worst, (found.base.col(i) - base).norm(), (found.damper.col(i) - damper).norm(),
                      (found.relative.col(i) - (damper - base)).norm()});
    if (order > 0) continue;
    const ComplexVector tip = d.segment(6 * i + 4, 2);
    worst = std::max(
        {worst, (found.outputs.col(i).head(2) - tip).norm(), std::abs(found.outputs(2, i) - damper(1))});
  }
  return worst / d.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("All sectors that turn do what one of them does, waves of both directions",
          "[whole ring][rotation]") {
  struct Alike {
    Index sectors;
    Index waves;
    Rotation rotation;
  };
  const auto one = GENERATE(values<Alike>({{12, 3, {30, 0}},
                                           {12, -3, {30, 0}},
                                           {12, 4, {-22, 0}},
                                           {12, -4, {0, .25}},
                                           {12, 0, {30, 0}},
                                           {12, 6, {30, 0}},
                                           {5, -2, {0, .5}},
                                           {2, 1, {30, 0}},
                                           {12, 2, {0, .1}}}));
  const auto orders = GENERATE(values<std::vector<int>>({{1}, {1, 3}}));
  const auto path = GENERATE(SectorPath::reduced, SectorPath::full);
  const auto kind = path == SectorPath::full ? DampingKind::viscous : DampingKind::modal;
  SystemParameters system = turning_blisk(one.sectors, one.waves, one.rotation, kind, path);
  system.harmonics = orders;
  const HarmonicResponse sector = response_of(system);
  const HarmonicResponse whole = response_of(whole_of(system, ring_of(system, Course::travelling)));
  for (const double preload : {1e3, .1}) {
    const Guess expected = sector.guess(190, preload);
    const Guess found = whole.guess(190, preload);
    CAPTURE(one.sectors, one.waves, orders.size(), preload, sector.describe(expected.regime));
    CHECK((sector.describe(expected.regime) == "stick") == (preload == 1e3));
    for (Index order = 0; order < std::ssize(orders); ++order) {
      const SectorMotions all = sector_motions(whole, found, order);
      const SectorMotions own = sector_motions(sector, expected, order);
      const double size = sector_motions(sector, expected).base.norm();
      for (Index i = 0; i < one.sectors; ++i) {
        const Index turned = orders[static_cast<std::size_t>(order)] * one.waves * i;
        const Complex turn = forward(turned % one.sectors, one.sectors);
        for (const auto part : {&SectorMotions::relative, &SectorMotions::base, &SectorMotions::damper})
          CHECK(((all.*part).col(i) - turn * (own.*part).col(0)).norm() < 1e-10 * size);
        if (all.outputs.rows() > 0)
          CHECK((all.outputs.col(i) - turn * own.outputs.col(0)).norm() <
                1e-10 * own.outputs.norm() + 1e-12 * size);
      }
    }
  }
}

TEST_CASE("A ring at speed 0 is that of sectors at rest, bit for bit", "[whole ring][rotation]") {
  const SystemParameters still = unlike_turning(
      turning_blisk(6, 2, {}, DampingKind::viscous, SectorPath::reduced, true), Course::standing);
  SystemParameters varied = still;
  varied.varied = "speed";
  varied.speed_low = -20;
  varied.speed_high = 20;
  SystemParameters at_rest = still;
  {
    const auto bare = [](const SectorPart& part) {
      SectorPart rest = part;
      rest.sector.gyroscopic = rest.sector.stiffness_speed2 = SparseMatrix();
      return rest;
    };
    const RingMake& make = structures_of(still).whole()->make();
    const auto& pair = dynamic_cast<const SectorPair&>(*make.structures);
    RingMake other = make;
    other.structures = std::make_shared<const SectorPair>(bare(pair.base()), bare(*pair.damper()), 1e-11);
    at_rest.structures = std::make_shared<const WholeRing>(other);
  }
  const HarmonicResponse expected = response_of(at_rest);
  const Guess at = expected.guess(190, .2);
  const auto evaluated = [&](const SystemParameters& system) {
    const HarmonicResponse problem = response_of(system);
    Vector residual(problem.size());
    Matrix jacobian(problem.size(), problem.size());
    Vector p = at.parameters;
    if (!system.varied.empty()) {
      p.conservativeResize(3);
      p(2) = 0;
    }
    Matrix by_parameters(problem.size(), p.size());
    REQUIRE(problem.evaluate(at.unknowns, p, at.regime, {&residual, &jacobian, &by_parameters}));
    Matrix all(problem.size(), problem.size() + 3);
    all << residual, jacobian, by_parameters.leftCols(2);
    return all;
  };
  const Matrix rest = evaluated(at_rest);
  CHECK(evaluated(still) == rest);
  CHECK((evaluated(varied) - rest).norm() < 1e-9 * rest.norm());  // solved for in place of modes
}

TEST_CASE("Unequal sectors that turn move as matrices of all their dofs do, stuck and slipping",
          "[whole ring][rotation]") {
  const auto [n, waves] =
      GENERATE(values<std::pair<Index, Index>>({{6, 2}, {6, -2}, {9, 3}, {4, 2}, {2, 1}}));
  const auto rotation = GENERATE(Rotation{25, 0}, Rotation{-25, 0}, Rotation{0, .125});
  const auto course = GENERATE(Course::travelling, Course::standing, Course::point, Course::given);
  const SystemParameters system = unlike_turning(
      turning_blisk(n, waves, rotation, DampingKind::viscous, SectorPath::reduced, true), course);
  const HarmonicResponse problem = response_of(system);
  for (const double eta : {150.0, 190.0, 262.0}) {
    for (const double preload : {1e3, .1}) {
      const Guess at = problem.guess(eta, preload);
      CAPTURE(n, waves, to_string(course), eta, preload, problem.describe(at.regime));
      CHECK((problem.describe(at.regime) == "stick") == (preload == 1e3));
      const SectorMotions found = sector_motions(problem, at);
      ComplexVector friction = ComplexVector::Zero(2 * n);
      for (Index i = 0; i < 2 * n; ++i) {
        const SectorContact& contact = system.contacts[static_cast<std::size_t>(i)];
        if (contact.stiffness == 0) continue;
        const Complex r = found.relative(i % 2, i / 2);
        friction(i) = contact.stiffness * r *
                      hysteresis_coefficient(std::abs(r), contact.slip_per_preload * preload).phi;
      }
      CHECK(dense_difference(system, problem, at, rotation.at(eta), friction, -friction) <
            (preload == 1e3 ? 1e-10 : 1e-9));
    }
  }
}

TEST_CASE("In three harmonics unequal sectors that turn move as matrices do under their contacts' forces",
          "[whole ring][rotation]") {
  const auto rotation = GENERATE(Rotation{25, 0}, Rotation{0, -.125});
  SystemParameters one = turning_blisk(6, -2, rotation, DampingKind::viscous, SectorPath::reduced, true);
  one.harmonics = {1, 3, 5};
  const SystemParameters system = unlike_turning(one, Course::travelling);
  const HarmonicResponse problem = response_of(system);
  const Guess at = problem.guess(190, .1);
  const HarmonicResponse::ElementForces forces =
      problem.element_forces(at.unknowns, at.parameters, at.regime);
  for (Index order = 0; order < 3; ++order) {
    const auto which = static_cast<std::size_t>(order);
    CAPTURE(order, problem.describe(at.regime), forces.base[which].norm());
    CHECK(forces.base[which].norm() > 1e-3 * forces.base[0].norm());
    CHECK(dense_difference(system, problem, at, rotation.at(190), forces.base[which], forces.damper[which],
                           order) < 1e-9);
  }
}

TEST_CASE("All derivatives of unequal sectors that turn are exact, and what goes in comes out",
          "[whole ring][rotation]") {
  const auto course = GENERATE(Course::travelling, Course::standing, Course::point);
  const auto orders = GENERATE(values<std::vector<int>>({{1}, {1, 3, 5}}));
  const auto [rotation, varied] = GENERATE(
      take(draws(5),
           values<std::pair<Rotation, std::string>>(
               {{{25, 0}, "speed"}, {{0, .125}, ""}, {{25, 0}, ""}, {{0, 0}, "speed"}, {{25, 0}, "F"}})));
  const auto kind = GENERATE(DampingKind::viscous, DampingKind::structural);
  SystemParameters one = turning_blisk(5, 2, rotation, kind, SectorPath::reduced, true);
  one.harmonics = orders;
  one.varied = varied;
  one.speed_low = -30;
  one.speed_high = 30;
  const HarmonicResponse problem = response_of(unlike_turning(one, course));
  const Guess at = problem.guess(190, .1);
  CAPTURE(to_string(course), orders.size(), varied, problem.describe(at.regime));
  check_exact(problem, at);
}

TEST_CASE("What a force on one contact does to another one the opposite speed does backwards",
          "[whole ring][rotation]") {
  const auto compliance = [](double speed) {
    const SystemParameters system = unlike_turning(
        turning_blisk(6, 2, {speed, 0}, DampingKind::viscous, SectorPath::reduced, true), Course::point);
    const HarmonicSystem built = build_harmonic_system(system);
    return ComplexMatrix(built.base[0].at(190).compliance + built.damper[0].at(190).compliance);
  };
  const ComplexMatrix there = compliance(25);
  CHECK((there - there.transpose()).norm() > .01 * there.norm());
  CHECK((there - compliance(-25).transpose()).norm() < 1e-11 * there.norm());
}

TEST_CASE("A ring that turns is known by the resonances of all its waves", "[whole ring][rotation]") {
  constexpr Index n = 5;
  const SystemParameters one = turning_blisk(n, 1, {28, 0});
  const SystemParameters system = whole_of(one, ring_of(one, Course::point));
  const std::vector<double> known = structures_of(system).whole()->landmarks(system);
  const double turn = two_pi * 28;
  Matrix k = of_both(&FiniteSector::stiffness, n) + turn * turn * of_both(&FiniteSector::stiffness_speed2, n);
  std::vector<Spring> stuck;
  for (Index i = 0; i < n; ++i) {
    stuck.push_back({6 * i, 6 * n + 2 * i, 3e5});
    stuck.push_back({6 * i + 1, 6 * n + 2 * i + 1, 2e5});
  }
  k += spring_matrix(8 * n, stuck);
  const Matrix inverse = of_both(&FiniteSector::mass, n).diagonal().cwiseInverse().asDiagonal();
  Matrix rates = Matrix::Zero(16 * n, 16 * n);
  rates.topRightCorner(8 * n, 8 * n).setIdentity();
  rates.bottomLeftCorner(8 * n, 8 * n) = -inverse * k;
  rates.bottomRightCorner(8 * n, 8 * n) = -turn * inverse * of_both(&FiniteSector::gyroscopic, n);
  const ComplexVector values = eigenvalues(rates);
  int found = 0;
  for (Index i = 0; i < values.size(); ++i) {
    const double eta = values(i).imag() / two_pi;
    if (!(eta > 0)) continue;
    ++found;
    CAPTURE(eta);
    CHECK(std::any_of(known.begin(), known.end(),
                      [&](double one_known) { return std::abs(one_known / eta - 1) < 1e-8; }));
  }
  CHECK(found == 8 * n);
}
