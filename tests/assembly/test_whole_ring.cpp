// All sectors of a ring together: alike they are one sector, and unlike what independent solutions tell.

#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/path/trace.hpp"
#include "catch.hpp"
#include "exact_response.hpp"
#include "paper_cases.hpp"
#include "whole_rings.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Guess;
using problems::HarmonicResponse;
using problems::sector_motions;
using problems::SectorMotions;
using Course = WholeLoad::Course;

namespace {

double observed(const HarmonicResponse& problem, const Guess& at, const std::string& name) {
  Vector values;
  problem.observe(at.unknowns, at.parameters, at.regime, values);
  const std::vector<continuation::Observable> all = problem.observables();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) return values(static_cast<Index>(i));
  }
  FAIL("no observable " << name);
  return 0;
}

/// The largest difference between the motions of all sectors and those of one under its wave, relative.
double difference(const HarmonicResponse& whole, const Guess& all, const HarmonicResponse& one,
                  const Guess& at, Index waves) {
  double worst = 0;
  for (Index order = 0; order < one.harmonics(); ++order) {
    const SectorMotions found = sector_motions(whole, all, order);
    const SectorMotions expected = sector_motions(one, at, order);
    const double size = std::max(sector_motions(one, at).base.norm(), expected.base.norm());
    const Index n = whole.system().sectors;
    const int h = one.system().orders[static_cast<std::size_t>(order)];
    for (Index i = 0; i < n; ++i) {
      const double angle = two_pi * static_cast<double>(h * waves * i % n) / static_cast<double>(n);
      const Complex turn = std::polar(1.0, -angle);
      for (const auto part : {&SectorMotions::relative, &SectorMotions::base, &SectorMotions::damper})
        worst = std::max(worst, ((found.*part).col(i) - turn * (expected.*part).col(0)).norm() / size);
      if (found.outputs.rows() == 0) continue;
      const double of_output = (found.outputs.col(i) - turn * expected.outputs.col(0)).norm();
      worst = std::max(worst, of_output / sector_motions(one, at).outputs.norm());
    }
  }
  return worst;
}

/// A system of one sector under half the preload at which its contact sticks, or under twice that, and all of
/// its sectors.
void check_alike(SystemParameters one, double eta, bool slips = true) {
  const HarmonicResponse stuck = response_of(one);
  const double holding = observed(stuck, stuck.guess(eta, 1e6), "R_over_S") * 1e6;
  one.preload = (slips ? .5 : 2) * holding;
  const HarmonicResponse sector = response_of(one);
  const HarmonicResponse whole = response_of(whole_of(one, ring_of(one, Course::travelling)));
  const Guess expected = sector.guess(eta, one.preload);
  const Guess found = whole.guess(eta, one.preload);
  CAPTURE(eta, one.preload, one.elements, one.wave_number);
  CHECK((expected.regime[0] == 1) == slips);
  CHECK(whole.describe(found.regime) == (slips ? "slip" : "stick"));
  CHECK(difference(whole, found, sector, expected, one.wave_number) < 1e-10);
}

}  // namespace

TEST_CASE("All sectors under a travelling wave do what one of them does", "[whole ring]") {
  SystemParameters rods = testing::rods(1);
  rods.elements = 10;
  rods.wave_number = 3;
  check_alike(rods, 4.1);
  rods.harmonics = {1, 3, 5};
  check_alike(rods, 4.1);
  check_alike(rods, 60, false);
  SystemParameters beams = figure_8(1);
  beams.elements = 9;
  beams.wave_number = 2;
  beams.harmonics = {1, 3};
  check_alike(beams, 3.8);
  check_alike(blisk(1), 552.8);
  SystemParameters harmonic = blisk(1, 12, 5);
  harmonic.harmonics = {1, 3, 5};
  check_alike(harmonic, 555);
  SystemParameters arcs = blisk(1, 8, 3);
  arcs.harmonics = {1, 3};
  arcs.excitation = {find_excitation_kind("arcs"), {.4}};
  check_alike(arcs, 553);
}

TEST_CASE("Elements beside the contacts act in every sector", "[whole ring]") {
  SystemParameters rods = testing::rods(1);
  rods.elements = 6;
  rods.wave_number = 2;
  rods.cubic_stiffness = .05;
  check_alike(rods, 4.1);
  rods.cubic_stiffness = 0;
  PlacedElement spring{"spring", find_element_kind("cubic"), PlacedElement::Place::damper, 0, {.1}};
  rods.others = {spring};
  check_alike(rods, 4.1);
  SystemParameters stops = blisk(1, 6, 1);
  stops.harmonics = {1, 0, 2, 3};
  stops.others = {{"stop", find_element_kind("unilateral"), PlacedElement::Place::base, 0, {1e5, 2e-7}}};
  check_alike(stops, 553);
}

namespace {

/// The greatest amplitude of any outer mass near the frequency at which a scan of .05 Hz has it.
void check_highest(const SystemParameters& whole, double eta, double expected, double tolerance,
                   bool is_scanned = false) {
  const HarmonicResponse problem = response_of(whole);
  const auto height = [&](double at) {
    return observed(problem, problem.guess(at, whole.preload), "Y_3_max");
  };
  CAPTURE(whole.preload, eta);
  const double found = height(eta);
  CHECK_THAT(found, WithinRel(expected, tolerance));
  if (!is_scanned) return;
  CHECK(height(eta - .05) < found);
  CHECK(height(eta + .05) < found);
}

struct Highest {
  double preload;
  double eta;
  double value;
};

/// z_i of numpy.random.default_rng(1).standard_normal(24).
const std::vector<double> deviations{
    0.34558419206478602,   0.82161814350115836,  0.33043707618338714,  -1.3031572316043609,
    0.90535586667311774,   0.44637457236401129,  -0.53695323536028516, 0.58111810419635312,
    0.36457239618607573,   0.29413249665552599,  0.028422241315796789, 0.54671298661244694,
    -0.73645408700166692,  -0.16290994799305278, -0.48211931267997826, 0.59884621263462756,
    0.03972210748165899,   -0.29245675096508861, -0.78190846235684208, -0.25719224061887069,
    0.0081421805183435076, -0.27560290529937043, 1.2940638143982073,   1.0067243153057943};

/// The spring between the first two masses of each blade, k (1 + part z_i).
std::vector<RingChange> mistuned(double part, Index sectors = 24) {
  std::vector<RingChange> changes;
  for (Index i = 0; i < sectors; ++i)
    changes.push_back(
        {true, {{{i, 0, 1}}}, Matrix::Constant(1, 1, 1e6 * part * deviations[static_cast<std::size_t>(i)])});
  return changes;
}
const Ports blade_spring{{{0, 1}, {1, -1}}};

/// The link of the ring between the last sector and the first.
RingChange missing_link(Index sectors = 24) {
  return {false, {{{sectors - 1, 0, -1}, {0, 0, 1}}}, Matrix::Constant(1, 1, -5e6)};
}

}  // namespace

// An independent solver of all 24 sectors, on a grid of .05 Hz.
TEST_CASE("Of a bladed disk with ring the highest amplitudes under travelling and standing loads are known",
          "[whole ring]") {
  for (const auto& [preload, eta, value] :
       {Highest{.1, 555.30, 1.359403e-5}, {1, 552.80, 8.693703e-6}, {10, 553.50, 1.464933e-5}}) {
    const SystemParameters one = blisk(preload);
    check_highest(whole_of(one, ring_of(one, Course::travelling)), eta, value, 1e-5, true);
  }
  for (const auto& [preload, eta, value] :
       {Highest{.1, 555.30, 1.291155e-5}, {1, 553.05, 1.037782e-5}, {10, 553.50, 1.464933e-5}}) {
    const SystemParameters one = blisk(preload);
    check_highest(whole_of(one, ring_of(one, Course::standing)), eta, value, 1e-5, true);
  }
}

// Where it takes the modes of the modified structure, whose modal damping is another one, to 1e-4.
TEST_CASE("Of a bladed disk that is mistuned, or whose ring is split, the highest amplitudes are known",
          "[whole ring]") {
  for (const auto& [preload, eta, value] :
       {Highest{.1, 555.30, 1.363355e-5}, {1, 553.25, 8.800321e-6}, {10, 553.50, 1.452601e-5}}) {
    const SystemParameters one = blisk(preload, 24, 2, DampingKind::modal, {}, {{{0, 1}}});
    RingMake ring = ring_of(one, Course::travelling);
    ring.damper_ports = 1;
    ring.changes = {missing_link()};
    check_highest(whole_of(one, ring), eta, value, 1e-4);
    if (preload < 10) continue;  // where the low-rank way was calculated as well
    const HarmonicResponse problem = response_of(whole_of(one, ring));
    CHECK_THAT(observed(problem, problem.guess(eta, preload), "Y_3_max"), WithinRel(1.452576e-5, 1e-6));
  }
  for (const auto& [preload, eta, value] :
       {Highest{.1, 555.30, 1.398039e-5}, {1, 552.80, 8.819081e-6}, {10, 553.50, 1.507864e-5}}) {
    const SystemParameters one = blisk(preload, 24, 2, DampingKind::modal, blade_spring);
    RingMake ring = ring_of(one, Course::travelling);
    ring.base_ports = 1;
    ring.changes = mistuned(.02);
    check_highest(whole_of(one, ring), eta, value, 1e-4);
  }
}

TEST_CASE("Where all contacts stick a standing wave is the mean of two travelling ones", "[whole ring]") {
  const SystemParameters one = blisk(50);
  RingMake back = ring_of(one, Course::given);
  for (Index i = 0; i < 24; ++i)
    back.load.sectors.push_back(std::polar(1.0, two_pi * 2 * static_cast<double>(i) / 24));
  const auto motions = [&](const RingMake& make) {
    const HarmonicResponse problem = response_of(whole_of(one, make));
    return sector_motions(problem, problem.guess(553.2, 50)).outputs;
  };
  const ComplexMatrix standing = motions(ring_of(one, Course::standing));
  const ComplexMatrix sum = (motions(ring_of(one, Course::travelling)) + motions(back)) / 2;
  CHECK((standing - sum).norm() < 1e-12 * sum.norm());
  SystemParameters rods = testing::rods(1e6);
  rods.elements = 8;
  const HarmonicResponse problem = response_of(whole_of(rods, ring_of(rods, Course::standing)));
  const ComplexMatrix of_rods = sector_motions(problem, problem.guess(4.1, 1e6)).base;
  for (Index i = 0; i < 8; ++i) {
    const double shape = std::cos(two_pi * static_cast<double>(i) / 8);
    CHECK(std::abs(of_rods(0, i) - shape * of_rods(0, 0)) < 1e-12 * of_rods.norm());
  }
}

namespace {

/// Unequal contacts, a split ring, mistuned blades and one contact that is missing, under a standing wave.
SystemParameters unlike(double preload, Index sectors, std::vector<int> harmonics = {1},
                        Course course = Course::standing) {
  SystemParameters one = blisk(preload, sectors, 2, DampingKind::viscous, blade_spring, {{{0, 1}}});
  one.harmonics = std::move(harmonics);
  RingMake ring = ring_of(one, course);
  ring.base_ports = ring.damper_ports = 1;
  ring.changes = mistuned(.01, sectors);
  ring.changes.push_back(missing_link(sectors));
  RingContacts contacts{{}, {}, std::vector<bool>(static_cast<std::size_t>(sectors), false)};
  for (std::size_t i = 0; i < contacts.missing.size(); ++i) {
    const double z = deviations[i];
    contacts.limit.push_back(std::exp(.2 * z));
    contacts.stiffness.push_back(std::exp(-.1 * z));
  }
  contacts.missing[6] = true;
  return whole_of(one, ring, contacts);
}

}  // namespace

TEST_CASE("All derivatives of unequal sectors are exact, and what goes in comes out", "[whole ring]") {
  for (const Course course : {Course::travelling, Course::standing, Course::point}) {
    for (const std::vector<int>& orders : {std::vector<int>{1}, {1, 3}}) {
      SystemParameters system = unlike(.01, 8, orders, course);
      if (orders.size() > 1) system.varied = "F";
      const HarmonicResponse problem = response_of(system);
      const Guess at = problem.guess(553.1, .01);
      CAPTURE(to_string(course), orders.size(), problem.describe(at.regime));
      check_exact(problem, at);
    }
  }
}

TEST_CASE("A split ring with unequal preloads under a standing wave is traced from end to end",
          "[whole ring]") {
  constexpr double preload = 1;
  const HarmonicResponse problem = response_of(unlike(preload, 24));
  continuation::TraceOptions options = over("eta", 540, 570);
  options.extrema_of = {"Y_3_max"};
  const continuation::Branch branch = continuation::trace(problem, problem.guess(540, preload), options);
  CAPTURE(preload, branch.explanation);
  CHECK(branch.complete());
  CHECK(branch.points.back().parameters(0) == 570);
  CHECK_FALSE(of_type(branch, continuation::PointType::peak).empty());
  for (const continuation::BranchPoint& point : branch.points)
    CHECK(problem.describe(point.regime).size() < 30);
}
