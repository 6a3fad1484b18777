// What a flow does to all nodes in time: waves that it feeds, cycles that stay and cycles that leave.

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "arcslip/dense.hpp"
#include "arcslip/problems/response/floquet_response.hpp"
#include "arcslip/structure/spectrum.hpp"
#include "catch.hpp"
#include "draws.hpp"
#include "flutter_cases.hpp"
#include "monodromy.hpp"
#include "timed_cycle.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Guess;

namespace {

FloquetCycle cycle_in_flow(const SystemParameters& system) {
  return {build_harmonic_system(system), ring_waves(system, system.harmonics.back() + 1)};
}

/// Amplitudes of the waves 0 .. N - 1 that run with the node numbers, of a motion of frequency eta.
Vector wave_amplitudes(const RingMotion& motion, const RingState& state) {
  const Index N = motion.ring().nodes();
  const Vector x = motion.ring().base * state.position;
  const Vector v = motion.ring().base * state.velocity / motion.frequency();
  Vector all(N);
  for (Index l = 0; l < N; ++l) {
    Complex sum = 0;
    for (Index i = 0; i < N; ++i)
      sum += Complex(x(i), -v(i)) *
             std::polar(1.0, two_pi * static_cast<double>(l * i) / static_cast<double>(N));
    all(l) = std::abs(sum) / static_cast<double>(N);
  }
  return all;
}

Index greatest_wave(const Vector& amplitudes) {
  Index found = 0;
  amplitudes.maxCoeff(&found);
  return found;
}

/// The amplitudes some periods after all places and velocities were moved by this part of the amplitude.
Vector disturbed(TimedCycle& time, double part, int periods) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> draw(-1, 1);
  RingState state = time.state;
  const double size = part * state.position.norm() / std::sqrt(static_cast<double>(state.position.size()));
  for (double& one : state.position) one += size * draw(engine);
  for (double& one : state.velocity) one += size * time.motion.frequency() * draw(engine);
  time.motion.advance(state, periods * time.motion.period());
  return wave_amplitudes(time.motion, state);
}

/// Rods whose waves a flow feeds, on a ring that moves.
SystemParameters rods_in_flow(Index wave, Index nodes, double g) {
  SystemParameters s;
  s.model = StructureModel::rods;
  s.wave_number = wave;
  s.elements = nodes;
  s.mass_ratio = 5;
  s.frequency_ratio = 4;
  s.interface_stiffness = 100;
  s.base_damping = 1e-3;
  s.damper_damping = 0.05;
  s.preload = 0.2;
  s.harmonics = odd_up_to(61);
  s.influence = std::make_shared<const Influence>(Influence{{{-1, g}, {1, -g}}, {}, {}});
  return s;
}

SystemParameters of_nodes(Index wave, Index nodes, int highest, const std::string& flutter) {
  return flutter_system(
      0.01, wave, highest,
      {fmt::format("system.sectors={}", nodes), "flutter.coefficients=[[0, 0.0]]", flutter});
}

}  // namespace

TEST_CASE("A ring that sticks in a flow moves as its masses and the forces of neighbours do",
          "[flutter][time]") {
  const auto [nodes, coefficients] = GENERATE(
      table<Index, std::vector<Influence::Coefficient>>({{12, {{-1, 0.01}, {1, -0.01}}},
                                                         {5, {{0, 0.1}, {1, -0.2}, {2, 0.07}, {-2, -0.03}}},
                                                         {4, {{1, 0.2}, {2, -0.1}}},
                                                         {2, {{1, 0.3}}},
                                                         {1, {{0, 0.3}}}}));
  std::string rows;
  for (const auto& [k, value] : coefficients)
    rows += fmt::format("{}[{}, {:.17g}]", rows.empty() ? "" : ", ", k, value.real());
  const SystemParameters system = of_nodes(nodes / 3, nodes, 1, "flutter.coefficients=[" + rows + "]");
  const RingMotion motion(build_ring(system), 0.15, 1e9);
  const RingState state = motion.at_rest();
  RingMotion moving = motion;
  // G of ring_response.hpp: the state after n periods over N, turned; T periods are N/n of them.
  const Matrix turned = next_derivative(moving, state).derivative.topLeftCorner(2 * nodes, 2 * nodes);
  Matrix rates = Matrix::Zero(2 * nodes, 2 * nodes);
  rates.topRightCorner(nodes, nodes).setIdentity();
  rates.bottomLeftCorner(nodes, nodes) = -nodes_in_flow(nodes, coefficients);
  rates.bottomLeftCorner(nodes, nodes).diagonal().array() -= 0.2;
  rates.bottomRightCorner(nodes, nodes).diagonal().setConstant(-0.005);
  const Matrix dense = exponential(Matrix(rates * (motion.period() * motion.ring().periods_of_turn())));
  // Node i takes the place of the one before it, as in time one is behind the other.
  Matrix shifted(2 * nodes, 2 * nodes);
  for (Index i = 0; i < nodes; ++i) {
    const Index next = system.wave_number == 0 ? i : (i + 1) % nodes;
    shifted.row(i) = dense.row(next);
    shifted.row(nodes + i) = dense.row(nodes + next);
  }
  CHECK(worst_match(spectrum(shifted), spectrum(turned)) < 1e-9);
}

TEST_CASE("Multipliers of cycles in a flow are those of all nodes in time", "[flutter][stability][cycle]") {
  const auto system = GENERATE(values<SystemParameters>({
      flutter_system(0.01, 3, 61, {"system.sectors=12"}),
      of_nodes(1, 5, 61, "flutter.coefficients=[[-1, 0.02], [1, -0.01], [2, -0.01]]"),
      of_nodes(2, 8, 61, "flutter.damping=[[2, -0.01], [-2, 0.005], [3, -0.002]]"),
      of_nodes(3, 6, 61, "flutter.damping=[[3, -0.01]]"),
      of_nodes(2, 6, 61, "flutter.coefficients=[[-1, 0.02], [1, -0.01], [3, 0.01]]"),
      rods_in_flow(1, 5, 4),
      rods_in_flow(2, 6, 16),
  }));
  CAPTURE(system.wave_number, system.elements);
  const FloquetCycle problem = cycle_in_flow(system);
  const Guess at = problem.guess(system.base_damping, 0.2);
  TimedCycle time(system, at);
  const ComplexVector expected = spectrum(monodromy(time.motion, time.state));
  std::vector<Complex> kept;
  for (const Complex& mu : expected) {
    if (std::abs(mu) > 1e-2) kept.push_back(mu);
  }
  const ComplexVector found = multipliers(problem, at);
  REQUIRE(found.size() > 2);
  CHECK(worst_match(found, ComplexVector::Map(kept.data(), std::ssize(kept))) < 1e-4);
}

TEST_CASE("Disturbed cycles of waves 3, 4 and 5 come back, and that of wave 1 leaves", "[flutter][time]") {
  const Index wave = GENERATE(1, 3, 4, 5);
  CAPTURE(wave);
  const SystemParameters system = flutter_system(0.016, wave, 13);
  const FloquetCycle problem = cycle_in_flow(system);
  const Guess at = problem.guess(0, 0.2);
  TimedCycle time(system, at);
  const double before = wave_amplitudes(time.motion, time.state)(wave);
  const Vector after = disturbed(time, 5e-2, 1500);
  if (wave == 1) {  // to a modulated wave, mostly of 2 nodal diameters
    CHECK(after(1) < 0.5 * before);
    CHECK(greatest_wave(after) == 2);
  } else {
    CHECK(greatest_wave(after) == wave);
    CHECK_THAT(after(wave), WithinRel(before, 1e-2));  // its phase within the period is another one
    Vector others = after;
    others(wave) = 0;
    CHECK(others.maxCoeff() < 1e-2 * after(wave));
  }
}

TEST_CASE("Random starts of a ring in a flow end in cycles that stay", "[flutter][time]") {
  const SystemParameters system = flutter_system(0.016, 1, 1);
  const FloquetCycle problem = cycle_in_flow(system);
  const double eta = problem.guess(0, 0.2).unknowns(FloquetCycle::eta);
  RingMotion motion(TimedCycle::unloaded(system), eta, 0.2);
  for (int seed = 1; seed <= draws(4); ++seed) {
    std::mt19937 engine(static_cast<unsigned>(seed));
    std::uniform_real_distribution<double> draw(-1, 1);
    RingState state = motion.at_rest();
    for (double& one : state.position) one = draw(engine);
    motion.advance(state, 2500 * motion.period());
    const Vector after = wave_amplitudes(motion, state);
    CAPTURE(seed, after);
    CHECK(std::set<Index>{3, 4, 5}.count(greatest_wave(after)) == 1);
    CHECK(after.sum() < 1.2 * after.maxCoeff());
  }
}

TEST_CASE("Where damping is negative in wave 1 only its cycle stays", "[flutter][stability][time]") {
  // Damping of -1e-3 in proportion to stiffness loses that of rods to waves 3 to 6.
  SystemParameters system;
  system.model = StructureModel::rods;
  system.wave_number = 1;
  system.elements = 12;
  system.mass_ratio = 5;
  system.frequency_ratio = 4;
  system.interface_stiffness = 100;
  system.fixed_damper = true;
  system.base_damping = 1e-12;
  system.harmonics = odd_up_to(21);
  system.influence = std::make_shared<const Influence>(Influence{{}, {{1, -1e-3}}, {}});
  const FloquetCycle problem = cycle_in_flow(system);
  const Guess at = problem.guess(system.base_damping, 1);
  const auto worst = problem.worst(at.unknowns, at.parameters, at.regime);
  CHECK(worst.growth < 1);
  TimedCycle time(system, at);
  CHECK_THAT(time.growth(200, 300), WithinRel(worst.growth, 1e-2));
  const Vector after = disturbed(time, 5e-2, 1000);
  CHECK(greatest_wave(after) == 1);
}
