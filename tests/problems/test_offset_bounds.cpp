// How far a response depends on where sliders rest that stick for ever: against the same masses in time,
// begun with the sliders there, where they stay.

#include <fmt/format.h>

#include <cmath>

#include "arcslip/problems/tasks/offset_bounds.hpp"
#include "timed_cases.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::HeldResponse;
using problems::offset_bounds;
using problems::OffsetBounds;
using problems::QuantityBounds;

namespace {

/// Two masses of which the outer one rubs on ground, beside what else acts on it.
std::string masses_beside(const std::string& harmonics, double preload, const std::string& elements) {
  return fmt::format(
             "[system]\nmodel = \"spring_mass\"\nbase = {{ mass = [1.0, 0.6], stiffness = [1.0, 0.8], output "
             "= [1] }}\ncontact_stiffness = 0.7\npreload = {:.17g}\ndamping_kind = \"viscous\"\n"
             "damping = {{ base = 0.05, damper = 0.01 }}\nharmonics = {}\n",
             preload, harmonics) +
         elements + "\n[branch]\nparameter = \"eta\"\nfrom = 0.3\nto = 1.0\n";
}

const std::string stop_text =
    "[[element]]\nkind = \"unilateral\"\nat = \"base\"\ncloses = \"forwards\"\nstiffness = 0.9\ngap = 0.2\n";
const std::string cubic_text = "[[element]]\nkind = \"cubic\"\nat = \"base\"\ncoefficient = 0.3\n";

const QuantityBounds& bounds_of(const OffsetBounds& bounds, const std::string& name) {
  const auto found = std::find_if(bounds.quantities.begin(), bounds.quantities.end(),
                                  [&](const QuantityBounds& one) { return one.name == name; });
  REQUIRE(found != bounds.quantities.end());
  return *found;
}

double held_harmonic(const HeldResponse& held) {
  Vector values;
  held.problem.observe(held.at.unknowns, held.at.parameters, held.at.regime, values);
  return values(HarmonicResponse::Y);
}

/// The motion in time that begins as a response does, settled: |y_1|, and whether the slider is where it was.
double timed_from(const SystemParameters& system, double eta, const HeldResponse& held) {
  RingMotion motion(build_ring(system), eta, system.preload);
  const RingState start = motion.travelling(problems::ring_harmonics(held.problem, held.at));
  RingState state = start;
  for (int period = 0; period < 150; ++period) state = next_state(motion, state);  // damped by e^-20 or more
  HarmonicRecord record(motion, {1}, true);
  next_state(motion, state, &record);
  CHECK((state.memory - start.memory).norm() < 0.02 * start.memory.norm());
  return std::abs(record.base()(0));
}

}  // namespace

TEST_CASE("What depends on where sliders rest is bounded by motions that stay in time", "[offsets]") {
  const auto [elements, harmonics, even] = GENERATE(
      table<std::string, std::string, std::string>({{stop_text, "21", "21"}, {cubic_text, "9", "9"}}));
  CAPTURE(elements);
  constexpr double eta = 0.55;
  const Case input = case_of(masses_beside(harmonics, 1.5, elements));
  const SystemParameters system = input.branches.front().problem.system;
  const HarmonicResponse problem(build_harmonic_system(system));
  const continuation::Guess at = problem.guess(eta, system.preload);
  REQUIRE(at.regime[0] == 0);
  const auto bounds = offset_bounds(system, problem, at);
  REQUIRE(bounds);
  INFO(bounds->reason);
  REQUIRE(bounds->reason.empty());
  const QuantityBounds& Y = bounds_of(*bounds, "Y");
  CHECK(Y.greatest - Y.least > 0.02 * Y.value);
  CHECK(Y.least <= Y.value);
  CHECK(Y.value <= Y.greatest);
  CHECK(bounds_of(*bounds, "Y_1").greatest > bounds_of(*bounds, "Y_1").least);
  CHECK(bounds_of(*bounds, "Y_h0").least < bounds_of(*bounds, "Y_h0").greatest);

  // the same in time, from both ends
  SystemParameters with_mean = system;
  with_mean.harmonics = all_up_to(highest_order(system.harmonics));
  const HarmonicResponse whole(build_harmonic_system(with_mean));
  const auto start = problems::solved_in(whole, problem, at);
  REQUIRE(start);
  int corners = 0;
  double least = Y.value;
  double greatest = Y.value;
  const auto take = [&](const HeldResponse& held, bool is_corner) {
    least = std::min(least, held_harmonic(held));
    greatest = std::max(greatest, held_harmonic(held));
    if (!is_corner) return;
    ++corners;
    CHECK_THAT(timed_from(with_mean, eta, held), WithinRel(held_harmonic(held), 2e-3));
  };
  CHECK(problems::follow_offsets(whole, *start, take).empty());
  CHECK(corners == 2);
  CHECK_THAT(least, WithinRel(Y.least, 1e-9));
  CHECK_THAT(greatest, WithinRel(Y.greatest, 1e-9));
}

TEST_CASE("At the ends of what a slider may be it is at its limit", "[offsets]") {
  const Case input = case_of(masses_beside("9", 1.5, stop_text));
  const SystemParameters& system = input.branches.front().problem.system;
  const HarmonicResponse problem(build_harmonic_system(system));
  const continuation::Guess at = problem.guess(0.55, system.preload);
  const Index mean = place_of_mean(problem.system().orders);
  std::vector<double> ends;
  const auto take = [&](const HeldResponse& held, bool is_corner) {
    if (!is_corner) return;
    const HarmonicVector r = held.problem.motion(held.at.unknowns, 0);
    HarmonicVector force = 0.7 * r;
    force(mean) = held.problem.element_force(0, held.at.unknowns, held.at.parameters, held.at.regime)(mean);
    const Swing swing = Swing::of(problem.system().orders, force);
    ends.push_back(std::max(swing.greatest.value, -swing.least.value));
    // the equations of both masses at rest, by hand: k_1 y_1 + k_2 (y_1 - y_2) = 0
    const double y_2 = -r(mean).real();
    const double stopped =
        held.problem.element_force(1, held.at.unknowns, held.at.parameters, held.at.regime)(mean).real();
    const double y_1 = 0.8 / 1.8 * y_2;
    CHECK_THAT(0.8 * (y_2 - y_1) - force(mean).real() + stopped, WithinAbs(0, 1e-9));
  };
  CHECK(problems::follow_offsets(problem, at, take).empty());
  REQUIRE(ends.size() == 2);
  for (const double end : ends) CHECK_THAT(end, WithinRel(1.5, 1e-9));  // L P
}

TEST_CASE("Beside what is linear or forgets the mean offsets change nothing", "[offsets]") {
  for (const double preload : {0.05, 50.0}) {
    const Case input = case_of(sectors(1, 5, 3, ""));
    SystemParameters system = input.branches.front().problem.system;
    const HarmonicResponse problem(build_harmonic_system(system));
    const continuation::Guess at = problem.guess(0.22, preload);
    const auto bounds = offset_bounds(system, problem, at);
    const bool sticks = at.regime[0] == 0 || at.regime[1] == 0;
    REQUIRE(bounds.has_value() == sticks);
    if (!bounds) continue;
    CHECK(bounds->reason.empty());
    CHECK(bounds->quantities.size() > 6);
    for (const QuantityBounds& one : bounds->quantities) CHECK(one.least == one.greatest);
  }
  const Case linear = case_of(masses_beside("3", 50, ""));
  const SystemParameters& system = linear.branches.front().problem.system;
  const HarmonicResponse problem(build_harmonic_system(system));
  const auto bounds = offset_bounds(system, problem, problem.guess(0.6, 50));
  REQUIRE(bounds);
  CHECK(bounds_of(*bounds, "Y").least == bounds_of(*bounds, "Y").greatest);
}

TEST_CASE("Two contacts that stick are held at all four corners", "[offsets]") {
  const std::string both =
      "[[element]]\nkind = \"friction\"\nat = \"contact\"\nnormal = 2\n"
      "tangential_stiffness = 1.0\nnormal_stiffness = 1.5\nmu = 0.5\n"
      "normal_per_preload = 2.0\n[[element]]\nkind = \"cubic\"\nat = \"base\"\n"
      "coefficient = 0.5\n";
  const Case input = case_of(sectors(1, 5, 3, "") + "\n" + both);
  const SystemParameters& system = input.branches.front().problem.system;
  const HarmonicResponse problem(build_harmonic_system(system));
  const continuation::Guess at = problem.guess(0.15, 20);
  Index sticking = 0;
  for (Index e = 0; e < problem.switch_count(); ++e) sticking += at.regime[e] == 0 ? 1 : 0;
  REQUIRE(sticking == 3);
  int corners = 0;
  const std::string reason =
      problems::follow_offsets(problem, at, [&](const HeldResponse&, bool last) { corners += last; });
  INFO(reason);
  CHECK(corners + (reason.empty() ? 0 : 8) >= 8);
}

TEST_CASE("What is not known of offsets is said", "[offsets]") {
  const Case input =
      case_of(rods(3, "kind = \"unilateral\"\ncloses = \"forwards\"\nstiffness = 3.0\ngap = -0.1\n"));
  const SystemParameters& system = input.branches.front().problem.system;
  const HarmonicResponse problem(build_harmonic_system(system));
  const auto bounds = offset_bounds(system, problem, problem.guess(0.7, 300));
  REQUIRE(bounds);
  CHECK_FALSE(bounds->reason.empty());
  for (const QuantityBounds& one : bounds->quantities) CHECK(std::isnan(one.least));
}
