// Whole rings whose sectors turn, in time: against Runge-Kutta steps with matrices of all their dofs and
// against the balance.

#include <Eigen/LU>

#include "arcslip/dense.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "arcslip/time/ring_record.hpp"
#include "arcslip/time/ring_response.hpp"
#include "arcslip/time/ring_tangent.hpp"
#include "catch.hpp"
#include "settled_march.hpp"
#include "timed_cases.hpp"
#include "turning_rings.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Guess;
using problems::HarmonicResponse;
using problems::sector_motions;
using problems::SectorMotions;
using Course = WholeLoad::Course;

namespace {

/// M, C and K of all dofs at a speed, viscously damped.
struct DenseMotion {
  DenseMotion(const SystemParameters& system, double part, double speed) {
    const Index n = structures_of(system).whole()->sectors();
    const double turn = two_pi * speed;
    const double loss = structures_of(system).losses(system).base(system).viscous / two_pi;
    inverse = of_both(&FiniteSector::mass, n).diagonal().cwiseInverse();
    const Matrix k = changed_stiffness(n, part);
    damping = loss * k + turn * of_both(&FiniteSector::gyroscopic, n);
    stiffness = k + turn * turn * of_both(&FiniteSector::stiffness_speed2, n);
  }

  Vector inverse;
  Matrix damping;
  Matrix stiffness;
};

/// Relative motion of the contact i, and its places among all dofs.
std::pair<Index, Index> places(Index i, Index sectors) { return {6 * (i / 2) + i % 2, 6 * sectors + i}; }

/// The first harmonic of all dofs in the settled state, by Runge-Kutta steps between which sliders move.
ComplexVector marched(const SystemParameters& system, const DenseMotion& dense, double eta, double preload) {
  const RingMake& make = structures_of(system).whole()->make();
  const Index n = make.sectors;
  const double w = two_pi * eta;
  Vector sliders = Vector::Zero(2 * n);
  const auto friction = [&](Index i, const Vector& d) {
    const SectorContact& contact = system.contacts[static_cast<std::size_t>(i)];
    if (contact.stiffness == 0) return 0.0;
    const auto [base, damper] = places(i, n);
    const double limit = contact.stiffness * contact.slip_per_preload * preload;
    return std::clamp(contact.stiffness * (d(damper) - d(base) - sliders(i)), -limit, limit);
  };
  ComplexVector load(n);
  for (Index i = 0; i < n; ++i)
    load(i) = make.load.course == Course::given ? make.load.sectors[static_cast<std::size_t>(i)]
                                                : forward((system.wave_number * i) % n, n);
  const auto acceleration = [&](const Vector& d, const Vector& v, double t) {
    Vector f = -(dense.stiffness * d + dense.damping * v);
    for (Index i = 0; i < n; ++i) f(6 * i + 2) += std::real(load(i) * std::polar(1.0, w * t));
    for (Index i = 0; i < 2 * n; ++i) {
      const auto [base, damper] = places(i, n);
      const double force = friction(i, d);
      f(base) += force;
      f(damper) -= force;
    }
    return Vector(f.cwiseProduct(dense.inverse));
  };
  const auto settle = [&](const Vector& d) {
    for (Index i = 0; i < 2 * n; ++i) {
      const SectorContact& contact = system.contacts[static_cast<std::size_t>(i)];
      const auto [base, damper] = places(i, n);
      if (contact.stiffness > 0) sliders(i) = d(damper) - d(base) - friction(i, d) / contact.stiffness;
    }
  };
  return settled_march(8 * n, eta, 2500, acceleration, settle);
}

SystemParameters damped(Index sectors, Index waves, const Rotation& rotation, Course course) {
  SystemParameters one =
      turning_blisk(sectors, waves, rotation, DampingKind::viscous, SectorPath::reduced, true);
  one.base_damping = one.damper_damping = .15;
  one.harmonics = {1, 3, 5, 7, 9, 11, 13, 15};
  return unlike_turning(one, course);
}

/// The motion over a period that repeats itself, from the balance on.
struct Settled {
  Settled(const SystemParameters& system, double eta, double preload)
      : problem(response_of(system)),
        at(problem.guess(eta, preload)),
        motion(build_ring(system), eta, preload),
        state(shoot(motion, motion.travelling(problems::ring_harmonics(problem, at)))) {
    REQUIRE(state.settled);
  }

  HarmonicResponse problem;
  Guess at;
  RingMotion motion;
  SettledMotion state;
};

}  // namespace

TEST_CASE("Unequal sectors that turn and slip move as they do in time", "[whole ring][rotation][numbers]") {
  struct Turning {
    Index sectors;
    Index waves;
    Rotation rotation;
    Course course;
  };
  const auto one = GENERATE(values<Turning>({{4, 1, {25, 0}, Course::travelling},
                                             {4, -1, {25, 0}, Course::travelling},
                                             {4, 2, {-30, 0}, Course::given},
                                             {3, -1, {0, .2}, Course::travelling}}));
  constexpr double eta = 160;
  constexpr double preload = .05;
  const SystemParameters system = damped(one.sectors, one.waves, one.rotation, one.course);
  Settled settled(system, eta, preload);
  const Index n = one.sectors;
  const ComplexVector d = marched(system, DenseMotion(system, .1, one.rotation.at(eta)), eta, preload);
  const double size = d.cwiseAbs().maxCoeff();
  const SectorMotions found = sector_motions(settled.problem, settled.at);
  HarmonicRecord record(settled.motion, {1});
  next_state(settled.motion, settled.state.state, &record);
  CAPTURE(n, one.waves, settled.problem.describe(settled.at.regime));
  CHECK(settled.problem.describe(settled.at.regime) != "stick");
  double worst = 0;
  double timed = std::abs(record.base()(0) - d(0));
  for (Index i = 0; i < 2 * n; ++i) {
    const auto [base, damper] = places(i, n);
    worst = std::max({worst, std::abs(found.base(i % 2, i / 2) - d(base)),
                      std::abs(found.damper(i % 2, i / 2) - d(damper))});
    timed = std::max(timed, std::abs(record.motion(i)(0) - (d(damper) - d(base))));
  }
  CAPTURE(worst / size, timed / size);
  CHECK(worst < 4e-5 * size);  // harmonics above 15
  CHECK(timed < 3e-6 * size);  // sliders begin and end within steps
}

TEST_CASE(
    "Disturbances of stuck sectors that turn fade as those of their matrices do, and slipping ones as "
    "differences tell",
    "[whole ring][rotation]") {
  constexpr double eta = 160;
  const SystemParameters system = damped(3, -1, {25, 0}, Course::travelling);
  {
    Settled stuck(system, eta, 1e3);
    RingTangent tangent(stuck.motion);
    RingState end = stuck.state.state;
    stuck.motion.advance(end, stuck.motion.period(), &tangent);
    const Index modes = 2 * stuck.motion.ring().coordinates();
    const Matrix flow = tangent.at(end).topLeftCorner(modes, modes);
    DenseMotion dense(system, .1, 25);
    for (Index i = 0; i < 6; ++i) {
      const auto [base, damper] = places(i, 3);
      dense.stiffness +=
          spring_matrix(24, {{base, damper, system.contacts[static_cast<std::size_t>(i)].stiffness}});
    }
    Matrix rates = Matrix::Zero(48, 48);
    rates.topRightCorner(24, 24).setIdentity();
    rates.bottomLeftCorner(24, 24) = -(dense.inverse.asDiagonal() * dense.stiffness);
    rates.bottomRightCorner(24, 24) = -(dense.inverse.asDiagonal() * dense.damping);
    const Vector expected = (eigenvalues(rates).real() * stuck.motion.period()).array().exp();
    const Vector found = eigenvalues(flow).cwiseAbs();
    REQUIRE(modes == 48);
    std::vector<double> a(expected.begin(), expected.end());
    std::vector<double> b(found.begin(), found.end());
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(std::abs(a[i] - b[i]) < 1e-9);
  }
  Settled slipping(system, eta, .05);
  CHECK(derivative_error(slipping.motion, slipping.state.state, .43 * slipping.motion.period()) < 1e-6);
}

TEST_CASE("Structural damping of sectors that turn has no motion in time, and single sectors neither",
          "[whole ring][rotation]") {
  const SystemParameters one = turning_blisk(4, 1, {25, 0});
  CHECK_THROWS_WITH(build_ring(one), Catch::Contains("as whole rings alone"));
  const SystemParameters damped = turning_blisk(4, 1, {25, 0}, DampingKind::structural);
  CHECK_THROWS_WITH(build_ring(whole_of(damped, ring_of(damped, Course::travelling))),
                    Catch::Contains("viscous or modal damping"));
}
