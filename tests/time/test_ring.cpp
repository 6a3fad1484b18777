#include <cmath>
#include <numbers>

#include "arcslip/assembly/sector_pair.hpp"
#include "arcslip/sectors/dynamic_stiffness.hpp"
#include "arcslip/structure/sector.hpp"
#include "arcslip/time/ring_record.hpp"
#include "arcslip/time/ring_response.hpp"
#include "catch.hpp"
#include "ring_cases.hpp"
#include "time/first_crossing.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

/// Coefficients of factor * prod (x - root).
Vector polynomial(double factor, const std::vector<double>& roots) {
  Vector c = Vector::Zero(static_cast<Index>(roots.size()) + 1);
  c(0) = factor;
  Index degree = 0;
  for (const double root : roots) {
    ++degree;
    for (Index m = degree; m >= 1; --m) c(m) = c(m - 1) - root * c(m);
    c(0) *= -root;
  }
  return c;
}

/// Energy that a motion has not accounted for, over its input.
double unaccounted(RingMotion& motion, RingState& state, double duration) {
  EnergyRecord work(motion);
  const double before = motion.energy(state);
  motion.advance(state, duration, &work);
  return (work.input() - work.elements() - work.damping() - (motion.energy(state) - before)) / work.input();
}

/// c_h of base and damper by linear solves: the elements reduced under a wave of h n lengths.
Complex compliance(const SystemParameters& s, int order, double eta) {
  const auto make = s.model == StructureModel::rods ? rod_element : beam_element;
  const Index n = order * s.wave_number;
  const auto seen = [&](const ChainElement& element, double damping) {
    const ReducedStructure reduced = reduce(element, n, s.elements);
    return dynamic_stiffness(reduced, damping).contact_response(order * eta, 0).compliance;
  };
  return seen(make(s.mass_ratio, s.stiffness_ratio(), n, s.elements), base_damping_factor(s)) +
         seen(make(1, 1, n, s.elements), damper_damping_factor(s));
}

}  // namespace

TEST_CASE("The first crossing of a polynomial is found however close its roots are", "[ring]") {
  // Two roots 2e-6 apart are known from the coefficients to sqrt(1e-16) of that or so.
  CHECK_THAT(first_crossing(polynomial(-1, {0.3, 0.300002})).value(), WithinAbs(0.3, 1e-10));
  CHECK_FALSE(first_crossing(polynomial(1, {0.3, 0.300002}) - Vector::Unit(3, 0)));  // below zero throughout
  CHECK_THAT(first_crossing(polynomial(1, {0.7})).value(), WithinAbs(0.7, 1e-15));
  CHECK_THAT(first_crossing(polynomial(1, {0.2, 0.5, 0.9})).value(), WithinAbs(0.2, 1e-14));
  CHECK(first_crossing(polynomial(-1, {0.4})).value() == 0);         // positive from the start
  CHECK_FALSE(first_crossing(polynomial(1, {1.5})));                 // outside
  CHECK_FALSE(first_crossing(polynomial(-1, {0.5, 0.5})));           // touches from below
  CHECK_FALSE(first_crossing(polynomial(-1, {-0.5, 0.0, 1.0, 2})));  // zero at both ends, below between
}

TEST_CASE("A ring is refused where its damping is not viscous or modal, or nothing presses it", "[ring]") {
  SystemParameters structural = small_beams();
  structural.base_damping_kind = DampingKind::structural;
  CHECK_THROWS_AS(build_ring(structural), std::invalid_argument);
  CHECK_THROWS_AS(RingMotion(build_ring(small_beams()), 1, 0), std::invalid_argument);
  CHECK_THROWS_AS(RingMotion(build_ring(small_beams()), 0, 1), std::invalid_argument);
}

TEST_CASE("Nodes move by the waves of their modes as by these, any rows of them", "[ring]") {
  SystemParameters system = GENERATE(small_beams(), small_rods());
  system.elements = GENERATE(5, 8);
  const Ring ring = build_ring(system);
  const NodeWaves waves(ring);
  std::vector<Index> rows;  // in no order
  for (Index i = 0; i < ring.motion.rows(); i += 2) rows.push_back((3 * i + 1) % ring.motion.rows());
  const NodeWaves::Rows some = waves.of(rows);
  const Matrix position = Matrix::Random(ring.coordinates(), 3);
  const Matrix force = Matrix::Random(std::ssize(rows), 3);
  Matrix x(std::ssize(rows), 3);
  Matrix pushed(ring.coordinates(), 3);
  waves.displace(some, position, x);
  waves.push(some, force, pushed);
  const Matrix motion = ring.motion(rows, Eigen::all);
  CHECK((x - motion * position).norm() < 1e-13 * motion.norm() * position.norm());
  CHECK((pushed - motion.transpose() * force).norm() < 1e-13 * motion.norm() * force.norm());
}

TEST_CASE("Turning a ring moves each node's motion to the node before", "[ring]") {
  const Ring ring = build_ring(GENERATE(small_beams(), small_rods()));
  const Index nodes = ring.nodes();
  Matrix next(nodes, ring.coordinates());
  next << ring.relative().bottomRows(nodes - 1), ring.relative().topRows(1);
  const Matrix turn = ring.turned(Matrix::Identity(ring.coordinates(), ring.coordinates()));
  CHECK((ring.relative() * turn - next).norm() < 1e-13 * next.norm());
  const Matrix square = turn.transpose() * turn;
  CHECK((square - Matrix::Identity(square.rows(), square.cols())).norm() < 1e-13);
}

TEST_CASE("A ring that sticks throughout has the linear reduced response", "[ring]") {
  const SystemParameters s = GENERATE(small_beams(7), small_rods(), [] {
    SystemParameters held = small_beams();
    held.fixed_damper = true;
    return held;
  }());
  const double eta = GENERATE(0.7, 3.7, 21.0);
  RingMotion motion(build_ring(s), eta, 1e6);
  const SettledMotion settled = shoot(motion, motion.at_rest());
  REQUIRE(settled.settled);
  CHECK(settled.rounds <= 2);  // linear: one step of Newton's method, another for its rounding
  HarmonicRecord record(motion, {1, 3});
  RingState state = settled.state;
  motion.advance(state, motion.period(), &record);
  CHECK(motion.count().events == 0);

  const FrictionSystem system = build_system(s);
  const ContactResponse base = system.base.at(eta);
  const ContactResponse damper = system.damper.at(eta);
  const double k = system.contact_stiffness;
  const Complex r = -base.free / (1.0 + k * (base.compliance + damper.compliance));
  CHECK(std::abs(record.relative()(0) - r) < 1e-10 * std::abs(r));
  const Complex y = base.free + k * base.compliance * r;
  CHECK(std::abs(record.base()(0) - y) < 1e-10 * std::abs(y));
  const Complex u = -k * damper.compliance * r;
  CHECK(std::abs(record.damper()(0) - u) <= 1e-10 * std::abs(u) + 1e-15 * std::abs(y));  // that one is y + r
  CHECK(std::abs(record.base()(1)) < 1e-12 * std::abs(y));
}

TEST_CASE("What the load feeds in from rest is stored or lost in friction and damping", "[ring]") {
  struct Case {
    SystemParameters system;
    double eta;
    double preload;
  };
  SystemParameters driven = small_rods();
  driven.base_damping = -0.01;
  const Case c =
      GENERATE_COPY(Case{small_beams(), 3.7, 0.01}, Case{small_beams(7), 0.6, 0.01},
                    Case{small_rods(), 2.3, 0.03}, Case{driven, 3.1, 0.03}, Case{small_beams(), 3.7, 1e-5});
  RingMotion motion(build_ring(c.system), c.eta, c.preload);
  RingState state = motion.at_rest();
  CHECK(std::abs(unaccounted(motion, state, 3.3 * motion.period())) < 1e-10);
  CHECK(motion.count().events > 20);
}

TEST_CASE("In the settled response power in is power lost, and friction takes its share", "[ring]") {
  RingMotion motion(build_ring(small_beams()), 3.7, 0.03);
  const SettledMotion settled = shoot(motion, motion.travelling({one_harmonic(small_beams(), 3.7, 0.03)}));
  REQUIRE(settled.settled);
  EnergyRecord work(motion);
  RingState state = settled.state;
  motion.advance(state, motion.period(), &work);
  CHECK_THAT(work.input(), WithinRel(work.elements() + work.damping(), 1e-10));
  CHECK(work.elements() > 0.05 * work.input());
  CHECK(work.damping() > 0);
}

TEST_CASE("Each harmonic of the settled ring obeys its own travelling wave", "[ring]") {
  // r_h + k c_h f_h = -y_0 delta_h1, where c_h belongs to the propagation constant h a: no harmonic is left
  // out on one side and nothing is reduced on the other.
  struct Case {
    SystemParameters system;
    double eta;
    double preload;
  };
  const Case c = GENERATE(Case{small_beams(), 3.7, 0.03}, Case{small_rods(), 2.3, 0.03});
  RingMotion motion(build_ring(c.system), c.eta, c.preload);
  const SettledMotion settled = shoot(motion, motion.travelling({one_harmonic(c.system, c.eta, c.preload)}));
  REQUIRE(settled.settled);
  HarmonicRecord record(motion, {1, 3, 5, 7, 9, 21, 2, 4});
  RingState state = settled.state;
  motion.advance(state, motion.period(), &record);
  CHECK(motion.count().events > 0);
  const Complex free = build_system(c.system).base.at(c.eta).free;
  for (Index h = 0; h < 8; ++h) {
    const int order = record.orders()[static_cast<std::size_t>(h)];
    CAPTURE(order);
    const Complex wanted =
        -compliance(c.system, order, c.eta) * record.force()(h) - (order == 1 ? free : 0.0);
    CHECK(std::abs(record.relative()(h) - wanted) <
          1e-11 * std::abs(free));  // rounding of the first harmonic
    if (order % 2 == 0) CHECK(std::abs(record.relative()(h)) < 1e-11 * std::abs(free));
  }
  CHECK(std::abs(record.relative()(1)) > 1e-4 * std::abs(free));
}

TEST_CASE("A contact that hardly resists has the harmonics of Caughey's loop", "[ring]") {
  SystemParameters s = small_beams();
  s.fixed_damper = true;
  s.interface_stiffness = 1e-3;  // over K* = 80: the higher harmonics of r are some 1e-8 of the first
  const double eta = 2;
  const double limit = s.interface_stiffness / s.stiffness_ratio();  // P/S
  double amplitude = std::abs(build_system(s).base.at(eta).free);
  for (int i = 0; i < 3; ++i) amplitude = std::abs(one_harmonic(s, eta, 0.3 * amplitude * limit).motion(0));
  const double preload = 0.3 * amplitude * limit;  // R = 5, S = 1.5
  RingMotion motion(build_ring(s), eta, preload);
  const SettledMotion settled = shoot(motion, motion.travelling({one_harmonic(s, eta, preload)}));
  REQUIRE(settled.settled);
  HarmonicRecord record(motion, {1, 3, 5, 7});
  RingState state = settled.state;
  motion.advance(state, motion.period(), &record);

  // Caughey (1960), k = 2, slip force 3, X = 5: coefficients of cos h wt and sin h wt, nine decimals.
  const Complex expected[] = {{2.523157877, 2.673803044},
                              {0.653488258, -0.606062023},
                              {-0.224799961, -0.148021737},
                              {0.038686505, 0.096538041}};
  const Complex turn = record.relative()(0) / std::abs(record.relative()(0));
  const double unit = s.interface_stiffness / static_cast<double>(s.elements) * amplitude / 10;
  for (Index h = 0; h < 4; ++h) {
    const Complex force =
        record.force()(h) / unit / std::pow(turn, record.orders()[static_cast<std::size_t>(h)]);
    CHECK(std::abs(force - expected[h]) < 1e-6);
  }
}
