// Disturbances of every wave round the ring, against the ring of all nodes in time.

#include "arcslip/time/ring_disturbances.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "arcslip/problems/response/floquet_response.hpp"
#include "arcslip/problems/response/limit_cycle.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "arcslip/time/ring_stability.hpp"
#include "case_runs.hpp"
#include "catch.hpp"
#include "paper_sectors.hpp"
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

/// The branch that a case file asks for.
struct Traced {
  explicit Traced(const std::string& text) : Traced(TemporaryFolder(), text) {}
  Traced(const TemporaryFolder& folder, const std::string& text)
      : input(read_case(folder.write("case.toml", text))),
        traced(std::move(trace(input.branches.front()).front())) {}

  double value_of(const BranchPoint& point, const std::string& name) const {
    return value(traced, point, name);
  }

  Case input;
  TracedBranch traced;
};

std::string driven_case(Index wave_number, Index elements, int highest, const std::string& branch) {
  return fmt::format(
      "[system]\nmodel = \"rods\"\nwave_number = {}\nelements = {}\nmass_ratio = 3.0\nfrequency_ratio = 1.5\n"
      "interface_stiffness = 400.0\ndamping = {{ base = -2e-3, damper = 0.1 }}\nforce = 1.0\npreload = 0.3\n"
      "harmonics = {}\n[branch]\nstability = true\nparameter = \"eta\"\n{}",
      wave_number, elements, highest, branch);
}

/// The multipliers of all nodes at a point.
RingStability in_time(const TracedBranch& traced, const BranchPoint& point) {
  const auto& problem = dynamic_cast<const FloquetResponse&>(*traced.base.disturbed);
  const auto harmonics =
      problems::ring_harmonics(problem, {point.unknowns, point.parameters, point.regime, {}});
  RingMotion motion(build_ring(traced.request->problem.system), point.parameters(0), point.parameters(1));
  const SettledMotion settled = shoot(motion, motion.travelling(harmonics));
  REQUIRE(settled.settled);
  return floquet_stability(motion, settled.state);
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

TEST_CASE("Each crossing is one point, with as many exponents beyond it as the ring in time has",
          "[stability]") {
  const Traced run(
      driven_case(2, 6, 9, "from = 3.0\nto = 3.7\n[continuation]\nstop_at = [3.3, 3.47, 3.5, 3.6]\n"));
  const auto crossings = points(run.traced, PointType::neimark_sacker);
  // Of waves 1, 3 and 5 alone where the others are stable: two before 3.35, one at 3.4407 and one at 3.5899.
  REQUIRE(crossings.size() == 12);
  for (std::size_t i = 1; i < crossings.size(); ++i)
    CHECK(crossings[i].parameters(0) - crossings[i - 1].parameters(0) > 1e-5);
  for (const BranchPoint& point : points(run.traced, PointType::user)) {
    const RingStability ring = in_time(run.traced, point);
    CAPTURE(point.parameters(0));
    CHECK(point.unstable == ring.unstable());
    CHECK(std::abs(run.value_of(point, "growth") - ring.growth()) < run.value_of(point, "growth_error"));
    CHECK(run.value_of(point, "stable") == (point.unstable == 0 ? 1 : 0));
  }
  for (const std::size_t i : {0U, 1U, 2U, 11U}) {
    CHECK_THAT(run.value_of(crossings[i], "growth"), WithinAbs(1, 1e-9));
    CHECK(std::isnan(run.value_of(crossings[i], "stable")));
    CHECK(static_cast<int>(run.value_of(crossings[i], "worst_wave")) % 2 == 1);
  }
}

TEST_CASE("Where n and N have no common factor waves of n, 2n, ... lengths are all", "[stability]") {
  const Traced run(
      driven_case(2, 5, 41, "from = 3.0\nto = 3.7\n[continuation]\nstop_at = [3.2, 3.44, 3.6, 3.65]\n"));
  const auto at = points(run.traced, PointType::user);
  REQUIRE(at.size() == 4);
  // Monodromy of all nodes.
  for (const auto& [i, growth] : {std::pair{0, .876866}, {1, .933757}, {2, 1.024187}, {3, 1.004372}})
    CHECK_THAT(run.value_of(at[static_cast<std::size_t>(i)], "growth"), WithinAbs(growth, 1e-6));
  CHECK_THAT(points(run.traced, PointType::neimark_sacker).at(0).parameters(0), WithinAbs(3.5584, 5e-5));
}

TEST_CASE("A point at which stability changes says how far more harmonics move it", "[stability]") {
  const Traced run(driven_case(2, 6, 9, "from = 3.3\nto = 3.45\n"));
  const auto& problem = dynamic_cast<const FloquetResponse&>(*run.traced.base.disturbed);
  const BranchPoint last = points(run.traced, PointType::neimark_sacker).back();
  const auto moved = problem.moved_by({last.unknowns, last.parameters, last.regime, {}}, 0);
  REQUIRE(moved);
  const Traced fine(driven_case(2, 6, 41, "from = 3.3\nto = 3.45\n"));
  const double right = points(fine.traced, PointType::neimark_sacker).back().parameters(0);
  CHECK(std::abs(right - last.parameters(0)) > 1e-4);
  CHECK_THAT(last.parameters(0) + *moved, WithinAbs(right, 1e-5));
}

TEST_CASE("A symmetry breaks where a real multiplier of the ring leaves the unit circle", "[stability]") {
  const Traced run(
      "[system]\nmodel = \"rods\"\nwave_number = 1\nelements = 7\nmass_ratio = 1.6\nfrequency_ratio = 3.2\n"
      "interface_stiffness = 590.0\ndamping = { base = -8.7e-4, damper = 0.012 }\nforce = 1.0\npreload = "
      "0.88\n"
      "harmonics = 29\n[branch]\nstability = true\nparameter = \"eta\"\nfrom = 2.9\nto = 3.15\n");
  std::vector<BranchPoint> special;
  for (const BranchPoint& point : run.traced.branch.points) {
    if (point.type != PointType::regular) special.push_back(point);
  }
  REQUIRE(special.size() == 4);  // each once, although a rigid motion has the same multiplier there
  CHECK(special[1].type == PointType::symmetry_breaking);
  CHECK(special[2].type == PointType::symmetry_breaking);
  for (const std::size_t i : {1U, 2U}) {
    const RingStability ring = in_time(run.traced, special[i]);
    CHECK(ring.turned(0).imag() == 0);
    CHECK_THAT(ring.growth(), WithinAbs(1, 1e-4));  // 29 harmonics
  }
  for (const BranchPoint& point : run.traced.branch.points) {
    const double eta = point.parameters(0);
    const bool between = eta > special[1].parameters(0) && eta < special[2].parameters(0);
    if (point.type == PointType::regular) CHECK(point.unstable == (between ? 1 : 0));
  }
}

TEST_CASE("A limit cycle that its own wave leaves alone may lose it to the others", "[stability]") {
  // Of 12 nodes: damping that is negative in proportion to stiffness gains most in wave 6.
  const auto [zeta, growth, wave] =
      GENERATE(table<double, double, Index>({{-1e-3, 1.30359, 6}, {-2e-3, 1.70184, 6}, {-1e-4, 1.02699, 6}}));
  SystemParameters s;
  s.model = StructureModel::rods;
  s.elements = 12;
  s.mass_ratio = 5;
  s.frequency_ratio = 4;
  s.interface_stiffness = 100;
  s.fixed_damper = true;
  s.base_damping = zeta;
  const problems::LimitCycle cycle(build_system(s));
  const continuation::Guess at = cycle.guess(zeta, 1, problems::LimitCycle::Size::small);
  Vector values;
  cycle.observe(at.unknowns, at.parameters, 0, values);
  const double eta = values(problems::LimitCycle::frequency);
  const std::vector<int> orders = {1};
  HarmonicVector motion(1);
  motion(0) = values(problems::LimitCycle::R);
  const std::vector<StickPattern> sticks = {
      stick_pattern(orders, motion, values(problems::LimitCycle::S), true)};
  const RingWaves waves = ring_waves(s, 2);
  const auto worst = [&](int first) {  // of waves first, first + 2, ...
    std::vector<TurnedFlow::Wave> all;
    for (int f = first; f <= 6; f += 2) all.push_back({f, f, waves.at(f)});
    const TurnedFlow flow(TurnedFlow::Kind::self_conjugate, 6, all, Vector::Constant(1, 100.0 / 12));
    const std::vector<Complex> found = flow.exponents(eta, sticks);
    std::map<Index, double> of_waves;
    for (const Complex& sigma : found)
      of_waves.try_emplace(flow.wave_of(sigma, eta, sticks, 12),
                           std::exp(2 * std::numbers::pi / eta * sigma.real()));
    return of_waves;
  };
  const auto even = worst(0);
  const auto odd = worst(1);
  CHECK_THAT(even.at(wave), WithinAbs(growth, 5e-6));
  CHECK_THAT(odd.at(1), WithinAbs(1, 2e-4));  // its phase; of one harmonic
  if (zeta != -1e-3) return;
  CHECK_THAT(eta, WithinRel(4.10954867, 1e-8));
  CHECK_THAT(odd.at(5), WithinAbs(1.2409, 5e-5));
  CHECK_THAT(even.at(8), WithinAbs(1.1428, 5e-5));  // wave 4, against the cycle's own
  CHECK_THAT(odd.at(3), WithinAbs(1.0620, 5e-5));
}

TEST_CASE("Points of a branch grow as those that are verified in time", "[stability]") {
  const bool beams = GENERATE(false, true);
  const Traced run(
      (beams ? std::string(
                   "[system]\nmodel = \"beams\"\nwave_number = 2\nelements = 6\nmass_ratio = 5.0\n"
                   "frequency_ratio = 4.0\ninterface_stiffness = 2000.0\n"
                   "damping = { base = 0.02, damper = 0.05 }\nforce = 1.0\npreload = 0.03\nharmonics = 15\n"
                   "[branch]\nstability = true\nparameter = \"eta\"\nfrom = 14.5\nto = 16.0\n")
             : driven_case(2, 6, 15, "from = 3.3\nto = 3.45\n")));
  const auto verified = problems::verify(run.input.branches.front().problem.system, odd_up_to(15),
                                         run.traced.branch, {.samples = 0});
  int compared = 0;
  for (const problems::Verification& one : verified) {
    if (std::isnan(one.growth)) continue;
    ++compared;
    const BranchPoint& point = run.traced.branch.points[one.point];
    CAPTURE(point.parameters(0));
    const double error = run.value_of(point, "growth_error");
    CHECK(error < 1e-3);
    CHECK(std::abs(run.value_of(point, "growth") - one.growth) <= error + 1e-9);
  }
  CHECK(compared >= 2);
}

TEST_CASE("Negative damping in proportion to stiffness is worst in the shortest waves", "[stability]") {
  // More waves than five harmonics hold: those beside them are looked at in cells of few.
  const Traced run(
      driven_case(1, 16, 5, "from = 1.3\nto = 2.0\n[continuation]\nstop_at = [1.45, 1.7, 1.9]\n"));
  const auto at = points(run.traced, PointType::user);
  REQUIRE(at.size() == 3);
  for (const BranchPoint& point : at) {
    const RingStability ring = in_time(run.traced, point);
    CAPTURE(point.parameters(0), ring.unstable());
    CHECK(run.value_of(point, "worst_wave") == 8);
    CHECK_THAT(run.value_of(point, "growth"), WithinAbs(ring.growth(), run.value_of(point, "growth_error")));
    CHECK_THAT(run.value_of(point, "growth"), WithinRel(ring.growth(), 0.03));
    CHECK(run.value_of(point, "stable") == 0);
  }
}

TEST_CASE("What grows without bounds takes no digits from the rest", "[stability]") {
  SystemParameters s = driven_rods(1, 1'000'000, 1);
  const FloquetResponse problem = response(s);
  const continuation::Guess at = problem.guess(1.7, s.preload);
  const auto all = problem.disturbances(at.unknowns, at.parameters, at.regime);
  double most = 0;
  for (const auto& one : all) {
    REQUIRE(std::isfinite(one.exponent.real()));
    most = std::max(most, one.exponent.real());
  }
  const auto shortest = ring_waves(s, 2).at(s.elements / 2);
  double own = 0;  // of oscillators by themselves, overdamped
  for (const Oscillator& mode : shortest)
    own = std::max(own, -0.5 * mode.damping + std::sqrt(std::max(0.0, 0.25 * mode.damping * mode.damping -
                                                                          mode.frequency * mode.frequency)));
  CHECK_THAT(most, WithinRel(own, 1e-9));
}

TEST_CASE("Disturbances on the full path of a sector are those on the reduced one", "[stability]") {
  const TemporaryFolder folder;
  const std::string branch = "[branch]\nstability = true\nparameter = \"eta\"\nfrom = 3.4\nto = 3.5\n";
  std::string text = paper_system(folder, false, 5);
  const Traced reduced(folder, text + branch);
  text.insert(text.find("wave_number"), "path = \"full\"\n");
  const Traced full(folder, text + branch);
  for (const bool last : {false, true}) {
    for (const char* name : {"growth", "worst_wave", "stable"}) {
      const auto value = [&](const Traced& of) {
        return of.value_of(last ? of.traced.branch.points.back() : of.traced.branch.points.front(), name);
      };
      CHECK_THAT(value(full), WithinRel(value(reduced), 1e-8));
    }
  }
}

TEST_CASE("Sectors of several elements and contacts grow as the rods that they are", "[stability][numbers]") {
  const TemporaryFolder folder;
  const std::string branch = "[branch]\nstability = true\nparameter = \"eta\"\nfrom = 3.4\nto = 3.5\n";
  // Of 6 and 3 sectors; waves that are their own conjugates have modes of equal frequencies.
  const int count = GENERATE(5, 10);
  std::string contacts = "contact = [1";
  for (int node = 2; node <= count; ++node) contacts += ", " + std::to_string(node);
  std::string text = paper_system(folder, false, count);
  for (const std::string one = "contact = [1]"; text.find(one) != std::string::npos;)
    text.replace(text.find(one), one.size(), contacts + "]");
  text.insert(text.find("wave_number"), "harmonics = 15\n");
  const Traced sectors(folder, text + branch);
  const Traced rods(
      "[system]\nmodel = \"rods\"\nwave_number = 1\nelements = 30\nmass_ratio = 5.0\nfrequency_ratio = 4.0\n"
      "interface_stiffness = 1000.0\nharmonics = 15\nforce = 1.0\npreload = 1.0\n" +
      branch);
  for (const bool last : {false, true}) {
    const auto point = [&](const Traced& of) {
      return last ? of.traced.branch.points.back() : of.traced.branch.points.front();
    };
    CHECK_THAT(sectors.value_of(point(sectors), "growth"),
               WithinRel(rods.value_of(point(rods), "growth"), 1e-8));
  }
}
