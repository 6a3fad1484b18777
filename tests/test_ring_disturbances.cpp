// Disturbances of every wave round the ring, against the ring of all nodes in time.

#include "arcslip/ring_disturbances.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

#include "arcslip/problems/floquet_response.hpp"
#include "arcslip/ring_stability.hpp"
#include "catch.hpp"
#include "ring_cases.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::FloquetResponse;

namespace {

/// Rods whose base its own motion excites.
SystemParameters driven_rods(Index wave_number, Index elements, int highest) {
  SystemParameters s;
  s.model = StructureModel::rods;
  s.wave_number = wave_number;
  s.elements = elements;
  s.mass_ratio = 3;
  s.frequency_ratio = 1.5;
  s.interface_stiffness = 400;
  s.base_damping = -2e-3;
  s.damper_damping = 0.1;
  s.preload = 0.3;
  s.harmonics = odd_up_to(highest);
  return s;
}

FloquetResponse response(const SystemParameters& system) {
  return {build_harmonic_system(system), ring_waves(system, system.harmonics.back() + 1)};
}

/// The largest |mu| of each class of waves modulo gcd(n, N).
std::map<Index, double> growth_of_classes(const SystemParameters& system, double eta) {
  const FloquetResponse problem = response(system);
  const continuation::Guess at = problem.guess(eta, system.preload);
  const auto found = problem.disturbances(at.unknowns, at.parameters, at.regime);
  const Index common = std::gcd(system.wave_number, system.elements);
  std::map<Index, double> growth;
  for (std::size_t i = 0; i < found.size(); ++i) {
    double& largest = growth[(found[i].wave % common + common) % common];
    largest = std::max(largest, std::exp(2 * std::numbers::pi / eta * found[i].exponent.real()));
  }
  return growth;
}

/// A ring that slips near a resonance of its base, half of them excited by their own motion.
struct RandomRing {
  SystemParameters system;
  double eta;
};

RandomRing random_ring(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto decades = [&](double low, double high) {
    return std::exp(between(std::log(low), std::log(high)));
  };
  SystemParameters s;
  s.model = random() % 3 == 0 ? StructureModel::beams : StructureModel::rods;
  s.wave_number = 1 + static_cast<Index>(random() % 4);
  s.elements = 2 * s.wave_number + 1 + static_cast<Index>(random() % 9);
  s.mass_ratio = decades(2, 20);
  s.frequency_ratio = between(1.3, 4);
  s.interface_stiffness = decades(50, 2000);
  s.base_damping = (random() % 2 == 0 ? 1 : -1) * decades(1e-3, 1e-2);
  s.damper_damping = decades(0.02, 0.2);
  s.preload = decades(0.03, 0.3);
  if (s.model == StructureModel::beams && s.base_damping < 0) s.base_damping /= 100;
  const auto n = static_cast<double>(s.wave_number);
  const double resonance = s.frequency_ratio * (s.model == StructureModel::rods ? n : n * n);
  return {s, resonance * between(0.8, 1.3)};
}

/// The largest |mu| by the exponents with this highest harmonic and by the ring of all nodes in time, which
/// begins with this response; NaN where there is none that slips.
struct Growth {
  double harmonics = std::nan("");
  double time = std::nan("");
  double error = std::nan("");
  bool unstable_agree = false;
};

Growth growth_of(const RandomRing& ring, int highest, bool in_time) {
  SystemParameters s = ring.system;
  s.harmonics = odd_up_to(highest);
  const auto problem = problems::build_floquet_response(s);
  continuation::Guess at;
  try {
    at = problem->guess(ring.eta, s.preload);
  } catch (const std::invalid_argument&) {
    return {};
  }
  if (at.regime == 0) return {};
  Growth found;
  Vector values;
  problem->observe(at.unknowns, at.parameters, at.regime, values);
  found.harmonics = values(values.size() - 3);
  found.error = values(values.size() - 2);
  if (!in_time) return found;
  const problems::HarmonicResponse::Friction friction =
      problem->friction(at.unknowns, at.parameters, at.regime);
  const HarmonicVector r = problem->motion(at.unknowns, 0);
  std::vector<ContactHarmonic> harmonics;
  for (std::size_t a = 0; a < s.harmonics.size(); ++a)
    harmonics.push_back({s.harmonics[a], r(static_cast<Index>(a)), friction.forces[a](0)});
  RingMotion motion(build_ring(s), ring.eta, s.preload);
  const SettledMotion settled = shoot(motion, motion.travelling(harmonics));
  if (!settled.settled) return found;
  const RingStability stability = floquet_stability(motion, settled.state);
  found.time = stability.growth();
  const auto all = problem->disturbances(at.unknowns, at.parameters, at.regime);
  const auto count =
      std::count_if(all.begin(), all.end(), [](const auto& one) { return one.exponent.real() > 0; });
  found.unstable_agree = count == stability.unstable();
  return found;
}

}  // namespace

TEST_CASE("Each class of waves grows as all nodes of the ring have it", "[stability]") {
  struct Row {
    Index wave_number, elements;
    int highest;
    double eta;
    std::map<Index, double> growth;
  };
  const auto row = GENERATE(values<Row>({
      // Monodromy of all nodes, of a response with 41 harmonics; where waves 1, 3, 5 rule, they alone tell.
      {2, 6, 41, 3.00, {{0, .743351}, {1, .908907}}},
      {2, 6, 41, 3.20, {{0, .850841}, {1, .961288}}},
      {2, 6, 41, 3.35, {{0, .932234}, {1, .940745}}},
      {2, 6, 41, 3.42, {{0, .976507}, {1, .980782}}},
      {2, 6, 41, 3.44, {{0, .989460}, {1, .999584}}},
      {2, 6, 41, 3.50, {{0, 1.023211}, {1, 1.050385}}},
      {2, 6, 41, 3.60, {{0, .985471}, {1, .992875}}},
      // Of one with 9.
      {2, 6, 9, 3.44, {{1, .999288}}},
      {4, 12, 9, 6.6, {{0, .901131}, {1, .940421}, {2, 1.053615}, {3, .940421}}},
      {2, 8, 9, 3.44, {{0, 1.060521}, {1, 1.011278}}},
      {3, 9, 9, 4.9, {{0, .880686}, {1, .920497}, {2, .920497}}},
  }));
  CAPTURE(row.wave_number, row.elements, row.eta);
  const auto found = growth_of_classes(driven_rods(row.wave_number, row.elements, row.highest), row.eta);
  CHECK(std::ssize(found) == std::gcd(row.wave_number, row.elements));
  for (const auto& [wave, growth] : row.growth) {
    CAPTURE(wave);
    CHECK_THAT(found.at(wave), WithinAbs(growth, 1e-6));
  }
}

TEST_CASE("The worst disturbance of random rings is that of all nodes in time as harmonics grow",
          "[.campaign]") {
  int found = 0, agree = 0, within = 0, folded = 0;
  double worst = 0;
  for (unsigned seed = 1; found < 200; ++seed) {
    const RandomRing ring = random_ring(seed);
    const Growth last = growth_of(ring, 59, true);
    if (std::isnan(last.time)) {
      if (!std::isnan(last.harmonics)) std::printf("%u unsettled\n", seed);
      continue;
    }
    ++found;
    const Growth nine = growth_of(ring, 9, false);
    const Growth nineteen = growth_of(ring, 19, false);
    const double e9 = nine.harmonics / last.time - 1, e19 = nineteen.harmonics / last.time - 1;
    const double e59 = last.harmonics / last.time - 1;
    std::printf("%u %s n=%ld N=%ld eta=%.4g growth=%.8g e9=%.2e (%.2e) e19=%.2e (%.2e) e59=%.2e (%.2e) %d\n",
                seed, ring.system.model == StructureModel::rods ? "rods" : "beams", ring.system.wave_number,
                ring.system.elements, ring.eta, last.time, e9, nine.error / last.time, e19,
                nineteen.error / last.time, e59, last.error / last.time, last.unstable_agree);
    std::fflush(stdout);
    agree += last.unstable_agree;
    within += std::abs(e9) <= nine.error / last.time;
    folded += std::gcd(ring.system.wave_number, ring.system.elements) > 1;
    worst = std::max(worst, std::abs(e59));
  }
  std::printf("%d agree %d within %d gcd %d worst %g\n", found, agree, within, folded, worst);
}
