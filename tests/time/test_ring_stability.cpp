#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "arcslip/sectors/dynamic_stiffness.hpp"
#include "arcslip/structure/sector.hpp"
#include "arcslip/structure/spectrum.hpp"
#include "arcslip/time/ring_stability.hpp"
#include "catch.hpp"
#include "monodromy.hpp"
#include "ring_cases.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

RingState settled_state(RingMotion& motion, const RingCase& c) {
  const SettledMotion settled = shoot(motion, motion.travelling({one_harmonic(c.system, c.eta, c.preload)}));
  REQUIRE(settled.settled);
  return settled.state;
}

/// Central differences of the marched flow over one period. Steps of velocities are w* as long.
Matrix brute_monodromy(RingMotion& motion, const RingState& start) {
  const Index coordinates = start.position.size();
  const Index size = 2 * coordinates + start.memory.size();
  const double step = 1e-5 * slip_threshold(motion);
  const auto end = [&](Index column, double sign) {
    RingState state = start;
    if (column < coordinates) state.position(column) += sign * step;
    if (column >= coordinates && column < 2 * coordinates) {
      state.velocity(column - coordinates) += sign * step * motion.frequency();
    }
    if (column >= 2 * coordinates) state.memory(column - 2 * coordinates) += sign * step;
    motion.advance(state, motion.period());
    return stacked(state);
  };
  Matrix derivative(size, size);
  for (Index column = 0; column < size; ++column) {
    derivative.col(column) = (end(column, 1) - end(column, -1)) / (2 * step);
  }
  derivative.middleRows(coordinates, coordinates) /= motion.frequency();
  return derivative;
}

ComplexVector beyond(const ComplexVector& values, double modulus) {
  ComplexVector kept(values.size());
  Index count = 0;
  for (const Complex& value : values) {
    if (std::abs(value) > modulus) kept(count++) = value;
  }
  return kept.head(count);
}

/// nu of the ring whose contacts all stick, from the elements reduced under waves of l = 0..N-1 lengths.
ComplexVector sticking_multipliers(const SystemParameters& s, double eta) {
  const auto make = s.model == StructureModel::rods ? rod_element : beam_element;
  const auto nodes = static_cast<double>(s.elements);
  std::vector<Complex> all;
  for (Index l = 0; l < s.elements; ++l) {
    const DynamicStiffness base =
        dynamic_stiffness(reduce(make(s.mass_ratio, s.stiffness_ratio(), l, s.elements), l, s.elements),
                          base_damping_factor(s));
    const DynamicStiffness damper =
        dynamic_stiffness(reduce(make(1, 1, l, s.elements), l, s.elements), damper_damping_factor(s));
    const Index j = base.mass.rows();
    const auto joined = [&](const ComplexMatrix& one, const ComplexMatrix& other) {
      ComplexMatrix both = ComplexMatrix::Zero(2 * j, 2 * j);
      both << one, ComplexMatrix::Zero(j, j), ComplexMatrix::Zero(j, j), other;
      return both;
    };
    ComplexMatrix stiffness = joined(base.stiffness, damper.stiffness);
    ComplexVector across = ComplexVector::Zero(2 * j);
    across(0) = -1;
    across(j) = 1;
    stiffness += s.interface_stiffness / nodes * across * across.adjoint();
    const ComplexMatrix inverse = joined(base.mass.inverse(), damper.mass.inverse());
    ComplexMatrix flow = ComplexMatrix::Zero(4 * j, 4 * j);
    flow.topRightCorner(2 * j, 2 * j).setIdentity();
    flow.bottomLeftCorner(2 * j, 2 * j) = -inverse * stiffness;
    flow.bottomRightCorner(2 * j, 2 * j) = -inverse * joined(base.damping, damper.damping);
    const Complex turn = std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(l) / nodes);
    for (const Complex& lambda : spectrum(flow)) {
      if (l == 0 && std::abs(lambda) < 1e-3) continue;  // base and damper together as one rigid body
      all.push_back(turn * std::exp(lambda * static_cast<double>(s.wave_number) / (nodes * eta)));
    }
  }
  return ComplexVector::Map(all.data(), static_cast<Index>(all.size()));
}

}  // namespace

TEST_CASE("Multipliers of the turned flow are those of a brute-force monodromy", "[ring]") {
  const RingCase c = GENERATE(RingCase{small_beams(4), 3.7, 0.03},                 //
                              RingCase{small_rods(5), 2.3, 0.03},                  // two lengths of the wave
                              RingCase{held(small_rods(5)), 2.3, 0.1},             //
                              RingCase{driven(small_rods(5), -0.002), 2.3, 0.03},  // friction holds it
                              RingCase{driven(small_rods(5), -0.02), 2.3, 0.03});  // it does not
  RingMotion motion(build_ring(c.system), c.eta, c.preload);
  const RingState state = settled_state(motion, c);
  const RingStability stability = floquet_stability(motion, state);
  CHECK(stability.slips);
  const Matrix brute = brute_monodromy(motion, state);
  const auto n = static_cast<int>(c.system.wave_number);
  const ComplexVector periods = spectrum(brute).array().pow(n);  // over n periods
  ComplexVector turned(stability.turned.size() + 1);
  turned << stability.turned.array().pow(static_cast<int>(c.system.elements)), Complex(1, 0);  // 1: the drift
  // What is nearly forgotten in n periods is known no better than the root of rounding over the step.
  const double largest = std::abs(turned(0));
  CHECK(worst_match(beyond(turned, 0.02), periods) < 1e-6 * std::max(1.0, largest));
  CHECK(worst_match(beyond(periods, 0.02), turned) < 1e-6 * std::max(1.0, largest));
  CHECK(beyond(turned, 0.02).size() > 6);
  CHECK((stability.unstable() > 0) == (c.system.base_damping == -0.02));
}

TEST_CASE("The derivative over a period is that of finite differences", "[ring]") {
  const RingCase c{small_rods(5), 2.3, 0.03};
  RingMotion motion(build_ring(c.system), c.eta, c.preload);
  const RingState state = settled_state(motion, c);
  const Index coordinates = motion.ring().coordinates();
  Matrix exact = monodromy(motion, state);
  exact.middleRows(coordinates, coordinates) /= motion.frequency();
  exact.middleCols(coordinates, coordinates) *= motion.frequency();
  const Matrix brute = brute_monodromy(motion, state);
  CHECK((exact.leftCols(2 * coordinates) - brute.leftCols(2 * coordinates)).norm() < 1e-7 * exact.norm());
}

TEST_CASE("Without slip the multipliers are those of the linear modes", "[ring]") {
  const RingCase c = GENERATE(RingCase{small_beams(5), 3.7, 10.0}, RingCase{small_rods(7), 2.3, 10.0},
                              RingCase{driven(small_rods(6), -0.1), 1.1, 10.0});
  RingMotion motion(build_ring(c.system), c.eta, c.preload);
  const RingStability stability = floquet_stability(motion, settled_state(motion, c));
  CHECK_FALSE(stability.slips);
  const ComplexVector linear = sticking_multipliers(c.system, c.eta);
  REQUIRE(stability.turned.size() == linear.size());
  CHECK(worst_match(stability.turned, linear) < 1e-10);
  // Base against damper as rigid bodies on the springs of the contacts: nothing damps it.
  const bool passive = c.system.base_damping > 0;
  if (passive) CHECK_THAT(stability.growth(), WithinAbs(1, 1e-10));
  CHECK((stability.unstable(1e-10) > 0) == !passive);
}

TEST_CASE("A passive ring that slips is stable", "[ring]") {
  const RingCase c =
      GENERATE(RingCase{small_beams(), 3.7, 0.03}, RingCase{small_beams(), 3.7, 1e-3},
               RingCase{small_beams(5), 1.2, 1e-3}, RingCase{small_beams(5), 12.0, 1e-3},
               RingCase{small_rods(), 2.3, 0.03}, RingCase{small_rods(6), 1.4, 0.01},
               RingCase{held(small_beams()), 3.7, 0.01}, RingCase{held(small_rods()), 2.3, 0.3});
  RingMotion motion(build_ring(c.system), c.eta, c.preload);
  const RingStability stability = floquet_stability(motion, settled_state(motion, c));
  CHECK(stability.slips);
  CHECK(stability.growth() < 0.9999);
  CHECK(stability.unstable() == 0);
}

TEST_CASE("A disturbance dies as fast as the largest multiplier says", "[ring]") {
  const RingCase c{held(small_rods()), 2.3, 0.1};
  RingMotion motion(build_ring(c.system), c.eta, c.preload);
  const RingState state = settled_state(motion, c);
  const RingStability stability = floquet_stability(motion, state);
  RingState disturbed = state;
  disturbed.position.tail(3) *= 1 + 1e-5;
  std::vector<double> distance;
  for (int period = 0; period < 40; ++period) {
    motion.advance(disturbed, motion.period());
    distance.push_back(state_distance(motion, disturbed, state));
  }
  // Over 24 periods, in which the fading of the other waves and the beat of the pair leave a few percent.
  CHECK_THAT(std::log(distance[39] / distance[15]) / 24, WithinAbs(std::log(stability.growth()), 5e-3));
}
