// Disturbances of limit cycles in every wave round the ring, against the ring of all nodes in time.

#include <algorithm>
#include <cmath>
#include <map>

#include "arcslip/problems/response/floquet_response.hpp"
#include "arcslip/structure/spectrum.hpp"
#include "branches.hpp"
#include "catch.hpp"
#include "monodromy.hpp"
#include "timed_cycle.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Guess;

namespace {

/// Rods whose base its own motion excites on a ring that is held, or is not.
SystemParameters squealing_rods(Index wave_number, Index elements, int highest, double zeta) {
  SystemParameters s;
  s.model = StructureModel::rods;
  s.wave_number = wave_number;
  s.elements = elements;
  s.mass_ratio = 5;
  s.frequency_ratio = 4;
  s.interface_stiffness = 100;
  s.fixed_damper = true;
  s.base_damping = zeta;
  s.harmonics = odd_up_to(highest);
  return s;
}

SystemParameters on_free_ring(SystemParameters s) {
  s.fixed_damper = false;
  s.damper_damping = 0.05;
  return s;
}

FloquetCycle cycle(const SystemParameters& system) {
  return {build_harmonic_system(system), ring_waves(system, system.harmonics.back() + 1)};
}

}  // namespace

TEST_CASE("Other waves leave the limit cycle of one that viscous damping feeds",
          "[stability][cycle][numbers]") {
  struct Row {
    double zeta;
    std::map<Index, double> growth;  ///< largest |mu| of what mostly is a wave
  };
  const auto row = GENERATE(values<Row>({{-1e-3, {{6, 1.30359}, {5, 1.2409}, {4, 1.1428}, {3, 1.062}}},
                                         {-2e-3, {{6, 1.70184}}},
                                         {-1e-4, {{6, 1.02699}}}}));
  const SystemParameters system = squealing_rods(1, 12, 21, row.zeta);
  const FloquetCycle problem = cycle(system);
  const Guess at = problem.guess(row.zeta, 1);
  const auto worst = problem.worst(at.unknowns, at.parameters, at.regime);
  CHECK(worst.wave == 6);
  CHECK_THAT(worst.growth, WithinAbs(row.growth.at(6), 2e-5));
  for (const auto& [wave, growth] : row.growth) {
    const ComplexVector all = multipliers(problem, at);
    CAPTURE(row.zeta, wave);
    CHECK((all.cwiseAbs().array() - growth).abs().minCoeff() < 6e-4);
  }
}

TEST_CASE("A limit cycle's multipliers are those of all nodes in time, without that of its phase",
          "[stability][cycle]") {
  const auto system = GENERATE(values<SystemParameters>({
      squealing_rods(1, 3, 81, -1e-3),
      squealing_rods(1, 7, 81, -3e-3),
      squealing_rods(2, 6, 81, -5e-4),
      squealing_rods(2, 5, 81, -2e-4),
      on_free_ring(squealing_rods(1, 5, 81, -2e-3)),
      on_free_ring(squealing_rods(2, 5, 81, -2e-4)),
  }));
  CAPTURE(system.wave_number, system.elements, system.fixed_damper);
  const FloquetCycle problem = cycle(system);
  const Guess at = problem.guess(system.base_damping, 1);
  TimedCycle time(system, at);
  const ComplexVector expected = spectrum(monodromy(time.motion, time.state));
  std::vector<Complex> kept;
  for (const Complex& mu : expected) {
    if (std::abs(mu) > 1e-2) kept.push_back(mu);
  }
  const ComplexVector found = multipliers(problem, at);
  REQUIRE(found.size() > 2);
  // In time the phase, a drift of all, and what the state's own 81 harmonics leave out.
  CHECK(worst_match(found, ComplexVector::Map(kept.data(), std::ssize(kept))) < 4e-5);
}

TEST_CASE("A disturbed cycle comes back in time, or leaves, as its growth says", "[stability][cycle]") {
  const auto system = GENERATE(values<SystemParameters>(
      {squealing_rods(1, 3, 81, -1e-3), squealing_rods(1, 7, 81, -3e-3), squealing_rods(2, 5, 81, -2e-4)}));
  const FloquetCycle problem = cycle(system);
  const Guess at = problem.guess(system.base_damping, 1);
  const double growth = problem.worst(at.unknowns, at.parameters, at.regime).growth;
  TimedCycle time(system, at);
  CHECK_THAT(time.growth(10, 20), WithinRel(growth, 0.02));
}

TEST_CASE("At a fold of limit cycles one disturbance that travels with them changes sides",
          "[stability][cycle]") {
  // Exponents of the balance's own harmonics, and exact ones.
  const int highest = GENERATE(1, 21);
  const FloquetCycle problem = cycle(squealing_rods(1, 12, highest, -1e-3));
  continuation::TraceOptions options = over("zeta_B", -1e-3, -0.02);
  const continuation::Branch branch = continuation::trace(problem, problem.guess(-1e-3, 1), options);
  const auto folds = of_type(branch, continuation::PointType::fold);
  REQUIRE(folds.size() == 1);
  const double fold = folds.front().parameters(FloquetCycle::zeta);
  if (highest == 1) CHECK_THAT(fold, WithinRel(-0.00505695362, 1e-8));
  bool behind = false;
  std::size_t seen = 0;
  for (const continuation::BranchPoint& point : branch.points) {
    behind = behind || point.type == continuation::PointType::fold;
    if (std::abs(point.parameters(FloquetCycle::zeta) / fold - 1) < 1e-9) continue;
    Index own = 0;
    for (const auto& one : problem.disturbances(point.unknowns, point.parameters, point.regime))
      own += one.is_own && one.exponent.real() > 0 ? 1 : 0;
    CHECK(own == (behind ? 1 : 0));
    ++seen;
  }
  CHECK(seen > 10);
}

TEST_CASE("The velocity of a cycle is a disturbance that lasts, to rounding in its own harmonics",
          "[stability][cycle]") {
  const SystemParameters system = squealing_rods(1, 30, 5, -1e-3);  // in cells: own harmonics apart
  const FloquetCycle problem = cycle(system);
  const Guess at = problem.guess(-1e-3, 1);
  const auto found = problem.disturbances(at.unknowns, at.parameters, at.regime);
  for (const auto& one : found) CHECK(std::abs(one.exponent) > 1e-6);
}
