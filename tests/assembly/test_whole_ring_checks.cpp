// The whole ring against matrices of all its dofs: linear ones solved, and a march in time.

#include <Eigen/LU>

#include "arcslip/problems/tasks/verification.hpp"
#include "arcslip/time/ring_record.hpp"
#include "arcslip/time/ring_response.hpp"
#include "catch.hpp"
#include "settled_march.hpp"
#include "whole_rings.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Guess;
using problems::HarmonicResponse;
using problems::sector_motions;
using problems::SectorMotions;
using Course = WholeLoad::Course;

namespace {

/// A factor of each sector, the same everywhere.
double drawn(Index i, int which) { return std::sin(1.7 * static_cast<double>(i) + 2.9 * which + .3); }

/// All masses of the disk, or of the ring below it: sector after sector, `count` of each.
struct Assembled {
  Matrix mass;
  Matrix stiffness;
};

Assembled disk(Index sectors, double part) {
  Assembled all{Matrix::Zero(3 * sectors, 3 * sectors), {}};
  std::vector<Spring> springs;
  for (Index i = 0; i < sectors; ++i) {
    const Index at = 3 * i;
    all.mass.diagonal().segment<3>(at) << 1.2, .35, .25 * (1 + part * drawn(i, 2));
    springs.push_back({at, -1, 6e5});
    springs.push_back({at, at + 1, 1e6 * (1 + part * drawn(i, 1))});
    springs.push_back({at + 1, at + 2, 2e6});
    springs.push_back({at, 3 * ((i + 1) % sectors), 5e7});
  }
  all.stiffness = spring_matrix(3 * sectors, springs);
  return all;
}

Assembled ring(Index sectors, Index missing) {
  Assembled all{.12 * Matrix::Identity(sectors, sectors), {}};
  std::vector<Spring> springs;
  for (Index i = 0; i < sectors; ++i) {
    springs.push_back({i, -1, 5e3});
    if (i != missing) springs.push_back({i, (i + 1) % sectors, 5e6});
  }
  all.stiffness = spring_matrix(sectors, springs);
  return all;
}

/// The same as changes to equal sectors, viscously damped.
SystemParameters changed(Index sectors, double part, double preload, const RingContacts& contacts,
                         const WholeLoad& load, double zeta, const std::vector<int>& harmonics = {1},
                         double mass_damping = 0) {
  SystemParameters one = blisk(preload, sectors, 2, DampingKind::viscous, {{{0, 1}, {1, -1}}, {{2, 1}}},
                               {{{0, 1}}}, mass_damping);
  one.base_damping = one.damper_damping = zeta;
  one.harmonics = harmonics;
  RingMake make = ring_of(one, load.course);
  make.load.sectors = load.sectors;
  make.base_ports = 2;
  make.damper_ports = 1;
  for (Index i = 0; i < sectors; ++i) {
    make.changes.push_back({true, {{{i, 0, 1}}}, Matrix::Constant(1, 1, 1e6 * part * drawn(i, 1))});
    make.changes.push_back(
        {true, {{{i, 1, 1}}}, Matrix::Zero(1, 1), Matrix::Constant(1, 1, .25 * part * drawn(i, 2))});
  }
  make.changes.push_back({false, {{{sectors - 1, 0, -1}, {0, 0, 1}}}, Matrix::Constant(1, 1, -5e6)});
  return whole_of(one, make, contacts);
}

/// Base and damper together, with stuck contacts of these stiffnesses.
Matrix joined_stiffness(const Assembled& base, const Assembled& damper, const std::vector<double>& stuck) {
  const Index n = damper.mass.rows();
  Matrix k = Matrix::Zero(4 * n, 4 * n);
  k.topLeftCorner(3 * n, 3 * n) = base.stiffness;
  k.bottomRightCorner(n, n) = damper.stiffness;
  std::vector<Spring> springs;
  for (Index i = 0; i < n; ++i) springs.push_back({3 * i, 3 * n + i, stuck[static_cast<std::size_t>(i)]});
  return k + spring_matrix(4 * n, springs);
}

}  // namespace

TEST_CASE("Mistuned stuck sectors with a split ring are what their assembled matrices are", "[whole ring]") {
  for (const Index n : {6, 24}) {
    RingContacts contacts;
    std::vector<double> stuck;
    for (Index i = 0; i < n; ++i) {
      contacts.stiffness.push_back(1 + .3 * drawn(i, 3));
      stuck.push_back(5e6 * contacts.stiffness.back());
    }
    WholeLoad load{Course::given, 2, {}};
    for (Index i = 0; i < n; ++i) load.sectors.emplace_back(1 + drawn(i, 4), drawn(i, 5));
    const HarmonicResponse problem = response_of(changed(n, .05, 1e9, contacts, load, 1e-3));
    const Assembled base = disk(n, .05);
    const Assembled damper = ring(n, n - 1);
    const Assembled none{base.mass * 0, base.stiffness * 0};
    for (const double eta : {545.0, 553.7, 561.0}) {
      const SectorMotions found = sector_motions(problem, problem.guess(eta, 1e9));
      const double w = two_pi * eta;
      const Complex loss(1, 2 * 1e-3 / 550 * eta);
      ComplexMatrix z = loss * joined_stiffness(base, damper, std::vector<double>(stuck.size(), 0.0));
      z += joined_stiffness(none, {damper.mass, 0 * damper.stiffness}, stuck).cast<Complex>();
      z.topLeftCorner(3 * n, 3 * n) -= w * w * base.mass.cast<Complex>();
      z.bottomRightCorner(n, n) -= w * w * damper.mass.cast<Complex>();
      ComplexVector force = ComplexVector::Zero(4 * n);
      for (Index i = 0; i < n; ++i) force(3 * i + 2) = load.sectors[static_cast<std::size_t>(i)];
      const ComplexVector d = z.partialPivLu().solve(force);
      CAPTURE(n, eta);
      for (Index i = 0; i < n; ++i) {
        CHECK(std::abs(found.base(0, i) - d(3 * i)) < 1e-10 * d.norm());
        CHECK(std::abs(found.outputs(0, i) - d(3 * i + 2)) < 1e-10 * d.norm());
        CHECK(std::abs(found.damper(0, i) - d(3 * n + i)) < 1e-10 * d.norm());
      }
    }
  }
}

// Whitehead (1966): mistuning raises the highest amplitude of one family of modes at most by this factor.
TEST_CASE("Mistuning raises amplitudes by less than Whitehead's factor", "[whole ring]") {
  constexpr Index n = 12;
  const WholeLoad load{Course::travelling, 2, {}};
  const auto highest = [&](double part) {
    SystemParameters system = changed(n, part, 1e9, {}, load, 1e-3);
    const HarmonicResponse problem = response_of(system);
    double most = 0;
    for (double eta = 545; eta < 562; eta += .25) {
      const Guess at = problem.guess(eta, 1e9);
      most = std::max(most, sector_motions(problem, at).outputs.cwiseAbs().maxCoeff());
    }
    return most;
  };
  const double tuned = highest(0);
  for (const double part : {.005, .02, .05}) {
    CAPTURE(part);
    CHECK(highest(part) < tuned * (1 + std::sqrt(static_cast<double>(n))) / 2);
  }
}

namespace {

/// The first harmonic of all masses in the settled state, by Runge-Kutta steps between which sliders move.
ComplexVector marched(const Assembled& base, const Assembled& damper, const std::vector<double>& stiffness,
                      const std::vector<double>& limits, const WholeLoad& load, double eta, double zeta,
                      double mass_damping) {
  const Index n = damper.mass.rows();
  const double w = two_pi * eta;
  const Matrix k = joined_stiffness(base, damper, std::vector<double>(stiffness.size(), 0.0));
  Vector mass(4 * n);
  mass << base.mass.diagonal(), damper.mass.diagonal();
  const Vector inverse = mass.cwiseInverse();
  const double damping = 2 * zeta / (550 * two_pi);
  Vector sliders = Vector::Zero(n);
  const auto slider_force = [&](Index i, const Vector& d) {
    const double r = d(3 * n + i) - d(3 * i);
    const auto at = static_cast<std::size_t>(i);
    return std::clamp(stiffness[at] * (r - sliders(i)), -limits[at], limits[at]);
  };
  const auto acceleration = [&](const Vector& d, const Vector& v, double t) {
    Vector f = -(k * (d + damping * v));
    f -= mass_damping * mass.cwiseProduct(v);
    for (Index i = 0; i < n; ++i) {
      f(3 * i + 2) += std::real(load.sectors[static_cast<std::size_t>(i)] * std::polar(1.0, w * t));
      const double friction = slider_force(i, d);
      f(3 * i) += friction;
      f(3 * n + i) -= friction;
    }
    return Vector(f.cwiseProduct(inverse));
  };
  const auto settle = [&](const Vector& d) {
    for (Index i = 0; i < n; ++i)
      sliders(i) = d(3 * n + i) - d(3 * i) - slider_force(i, d) / stiffness[static_cast<std::size_t>(i)];
  };
  return settled_march(4 * n, eta, 1200, acceleration, settle);
}

}  // namespace

TEST_CASE("Unequal sectors that slip move as they do in time", "[whole ring][numbers]") {
  constexpr double zeta = .02;
  constexpr double mass_damping = 100;
  constexpr double preload = .1;
  const std::vector<int> orders{1, 3, 5, 7, 9, 11, 13, 15};
  struct Drawn {
    Index sectors;
    int draw;
    double eta;
  };
  for (const auto& [n, draw, eta] : {Drawn{6, 0, 556}, Drawn{6, 1, 548}, Drawn{12, 0, 553}}) {
    RingContacts contacts;
    std::vector<double> stiffness;
    std::vector<double> limits;
    WholeLoad load{Course::given, 2, {}};
    for (Index i = 0; i < n; ++i) {
      contacts.stiffness.push_back(1 + .3 * drawn(i, 3 + draw));
      contacts.limit.push_back(1 + .5 * drawn(i, 6 + draw));
      stiffness.push_back(5e6 * contacts.stiffness.back());
      limits.push_back(preload * contacts.limit.back());
      load.sectors.emplace_back(1 + drawn(i, 4 + draw), drawn(i, 5 + draw));
    }
    const SystemParameters system = changed(n, .05, preload, contacts, load, zeta, orders, mass_damping);
    const HarmonicResponse problem = response_of(system);
    const Guess at = problem.guess(eta, preload);
    const SectorMotions found = sector_motions(problem, at);
    const ComplexVector d =
        marched(disk(n, .05), ring(n, n - 1), stiffness, limits, load, eta, zeta, mass_damping);
    CAPTURE(n, draw, problem.describe(at.regime));
    CHECK(problem.describe(at.regime) != "stick");
    double worst = 0;
    for (Index i = 0; i < n; ++i) {
      worst = std::max({worst, std::abs(found.base(0, i) - d(3 * i)),
                        std::abs(found.outputs(0, i) - d(3 * i + 2)),
                        std::abs(found.damper(0, i) - d(3 * n + i))});
    }
    CAPTURE(worst / d.cwiseAbs().maxCoeff());
    CHECK(worst < 1e-5 * d.cwiseAbs().maxCoeff());
    RingMotion motion(build_ring(system), eta, preload);
    const SettledMotion settled = shoot(motion, motion.travelling(problems::ring_harmonics(problem, at)));
    REQUIRE(settled.settled);
    HarmonicRecord record(motion, {1});
    next_state(motion, settled.state, &record);
    double timed = std::abs(record.base()(0) - d(0));
    for (Index i = 0; i < n; ++i)
      timed = std::max(timed, std::abs(record.motion(i)(0) - (d(3 * n + i) - d(3 * i))));
    CAPTURE(timed / d.cwiseAbs().maxCoeff());
    CHECK(timed < 2e-6 * d.cwiseAbs().maxCoeff());
  }
}
