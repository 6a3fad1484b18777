#include <cmath>

#include "arcslip/time/ring_record.hpp"
#include "arcslip/time/ring_response.hpp"
#include "catch.hpp"
#include "ring_cases.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

RingState shifted(RingState state, Index column, double step) {
  const Index coordinates = state.position.size();
  if (column < coordinates) {
    state.position(column) += step;
  } else if (column < 2 * coordinates) {
    state.velocity(column - coordinates) += step;
  } else {
    state.memory(column - 2 * coordinates) += step;
  }
  return state;
}

}  // namespace

TEST_CASE("The derivative of the turned flow is that of finite differences", "[ring]") {
  SystemParameters held = small_rods();
  held.fixed_damper = true;
  const RingCase c = GENERATE_COPY(RingCase{small_beams(), 3.7, 0.03}, RingCase{small_rods(), 2.3, 0.03},
                                   RingCase{held, 2.3, 0.1});
  RingMotion motion(build_ring(c.system), c.eta, c.preload);
  RingState start = motion.travelling({one_harmonic(c.system, c.eta, c.preload)});
  motion.advance(start, 0.37 * motion.period());  // no settled response: any state will do
  const long before = motion.count().events;
  const StateDerivative derivative = next_derivative(motion, start);
  REQUIRE(motion.count().events > before + 1);

  const Index coordinates = motion.ring().coordinates();
  for (Index column = 0; column < derivative.derivative.cols(); ++column) {
    const bool slider_of_slip = column >= 2 * coordinates && start.phase[column - 2 * coordinates] != 0;
    const bool velocity = column >= coordinates && column < 2 * coordinates;
    const double step = 1e-6 * slip_threshold(motion) * (velocity ? motion.frequency() : 1.0);
    const Vector up = stacked(next_state(motion, shifted(start, column, step)));
    const Vector down = stacked(next_state(motion, shifted(start, column, -step)));
    const Vector difference = (up - down) / (2 * step);
    CAPTURE(column, slider_of_slip);
    // Rounding of the states over the step; a central difference across an event is good to the square of it.
    const double scale = std::max(1.0, derivative.derivative.col(column).norm());
    CHECK((difference - derivative.derivative.col(column)).norm() < 1e-6 * scale);
  }
}

TEST_CASE("Newton's method and a long march from rest find the same response", "[ring]") {
  const RingCase c = GENERATE(RingCase{small_rods(), 2.3, 0.03}, RingCase{small_beams(), 3.7, 0.1});
  RingMotion motion(build_ring(c.system), c.eta, c.preload);
  const SettledMotion march = march_until_settled(motion, motion.at_rest(), 1e-12, 2000);
  REQUIRE(march.settled);
  const SettledMotion from_rest = shoot(motion, motion.at_rest());
  const SettledMotion from_balance =
      shoot(motion, motion.travelling({one_harmonic(c.system, c.eta, c.preload)}));
  REQUIRE(from_rest.settled);
  REQUIRE(from_balance.settled);
  CHECK(motion.count().events > 0);
  CHECK(state_distance(motion, march.state, from_rest.state) < 1e-8);
  CHECK(state_distance(motion, from_balance.state, from_rest.state) < 1e-10);
}

// Hardly damped, between the resonances in stick and in slip: what the first steps lead to is far from
// closing.
TEST_CASE("Newton's method finds the response of a hardly damped ring from rest", "[ring]") {
  SystemParameters s = small_beams(30);
  s.mass_ratio = 5;
  s.frequency_ratio = 4;
  s.interface_stiffness = shear_interface_stiffness(33.3, 0.3);
  s.base_damping = s.damper_damping = 1e-4;
  const auto [eta, preload] = GENERATE(std::pair(3.841, 1.0), std::pair(3.9, 1.0), std::pair(3.75, 2.0));
  RingMotion motion(build_ring(s), eta, preload);
  const SettledMotion from_rest = shoot(motion, motion.at_rest());
  REQUIRE(from_rest.settled);
  CHECK(motion.count().events > 0);
  CHECK(motion.count().steps < 200 * motion.ring().nodes());  // of four periods
  const SettledMotion from_balance = shoot(motion, motion.travelling({one_harmonic(s, eta, preload)}));
  REQUIRE(from_balance.settled);
  CHECK(state_distance(motion, from_balance.state, from_rest.state) < 1e-8);
}

TEST_CASE("Each node repeats its neighbour with the delay of the wave, marched without turning", "[ring]") {
  RingMotion motion(build_ring(small_rods()), 2.3, 0.03);
  const Ring& ring = motion.ring();
  RingState state = motion.at_rest();
  motion.advance(state, 120 * motion.period());
  RingState later = state;
  motion.advance(later,
                 motion.period() * static_cast<double>(ring.wave_number) / static_cast<double>(ring.nodes()));
  const Vector now = ring.base * state.position;
  const Vector then = ring.base * later.position;
  const Vector gap = ring.relative() * later.position - later.memory;
  const Vector gap_now = ring.relative() * state.position - state.memory;
  for (Index i = 0; i < ring.nodes(); ++i) {
    const Index next = (i + 1) % ring.nodes();
    CHECK_THAT(then(next) - then.mean(), WithinAbs(now(i) - now.mean(), 1e-9 * now.norm()));
    CHECK_THAT(gap(next), WithinAbs(gap_now(i), 1e-9 * gap_now.norm()));
    CHECK(later.phase[next] == state.phase[i]);
  }
  CHECK(motion.count().events > 4 * ring.nodes());
}

TEST_CASE("The response starts from any place of the neutral drift", "[ring]") {
  RingMotion motion(build_ring(small_rods()), 2.3, 0.03);
  const SettledMotion settled = shoot(motion, motion.at_rest());
  REQUIRE(settled.settled);
  const Vector drift = neutral_drifts(motion).col(0);
  RingState moved = settled.state;
  moved.position += drift.head(moved.position.size());
  moved.memory += drift.tail(moved.memory.size());
  CHECK(state_distance(motion, next_state(motion, moved), moved) < 1e-10);
  CHECK(state_distance(motion, moved, settled.state) < 1e-13);
  const Matrix derivative = next_derivative(motion, settled.state).derivative;
  CHECK((derivative * drift - drift).norm() < 1e-11);
}
