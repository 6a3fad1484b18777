// Elements with a memory, sectors and structures without symmetry in time, against balances of harmonics,
// numbers found by other means and differences.

#include <cmath>
#include <functional>
#include <numbers>

#include "timed_cases.hpp"

using namespace arcslip;
using namespace arcslip::testing;

TEST_CASE("A mass that rubs and lifts off moves in time as integrated by other means", "[ring]") {
  const Case input = read_case(source_folder() + "/problems/lift_off.toml");
  Timed mass(input, 1.1 / (2 * std::numbers::pi));
  const SettledMotion found = shoot(mass.motion, mass.start);
  REQUIRE(found.settled);
  HarmonicRecord record(mass.motion, {0, 1, 2});
  RingState state = found.state;
  const long before = mass.motion.count().events;
  mass.motion.advance(state, mass.motion.period(), &record);
  CHECK(mass.motion.count().events - before == 4);  // apart, slip, stick, slip
  // The friction's own coordinates are behind those of two contacts where nothing rubs. The numbers are those
  // of a balance of 16 harmonics, whose error is some 5e-6.
  const ComplexVector x = record.motion(2);
  const ComplexVector y = record.motion(3);
  CHECK_THAT(x(0).real(), WithinAbs(.211893, 2e-5));
  CHECK_THAT(std::abs(x(1)), WithinAbs(4.305776, 2e-5));
  CHECK_THAT(std::abs(x(2)), WithinAbs(.086827, 2e-5));
  CHECK_THAT(y(0).real(), WithinAbs(-.021505, 2e-5));
  CHECK_THAT(std::abs(y(1)), WithinAbs(1.335933, 2e-5));
  CHECK_THAT(std::abs(y(2)), WithinAbs(.004833, 2e-5));
  CHECK_THAT(std::abs(record.base()(1)), WithinRel(std::abs(x(1)), 1e-13));
}

TEST_CASE("Derivatives of the flow are those of differences, whatever the elements", "[ring]") {
  const auto [text, eta] = GENERATE(
      table<std::string, double>({{sectors(1, 4, 3, lift_off), 0.23},
                                  {sectors(2, 4, 3), 0.32},
                                  {rods(3, iwan), 1.5},
                                  {rods(3, iwan_4), 1.5},
                                  {rods(3, "kind = \"clearance\"\nstiffness = 9\ngap = 0.1\n"), 1.5}}));
  CAPTURE(text);
  Timed ring(case_of(text), eta);
  ring.motion.advance(ring.start, 0.37 * ring.motion.period());  // no settled response: any state will do
  const long before = ring.motion.count().events;
  // Backbones have corners in their slope that differences see, which fall as the square of the step else.
  CHECK(derivative_error(ring.motion, ring.start, 0.6 * ring.motion.period()) < 1e-5);
  CHECK(ring.motion.count().events > before + 4);
}

TEST_CASE("The ring in time is what balances of more and more harmonics tend to", "[ring][numbers]") {
  struct Tendency {
    std::function<std::string(int)> text;
    double eta;
    double last;
  };
  const auto t =
      GENERATE(Tendency{[](int h) { return sectors(1, 6, h); }, 0.235, 1e-5},
               Tendency{[](int h) { return sectors(2, 6, h); }, 0.285, 1e-5},  // a factor in common
               Tendency{[](int h) { return sectors(3, 6, h); }, 0.318, 1e-5},  // a wave that stands
               Tendency{[](int h) { return sectors(1, 5, h, lift_off); }, 0.236, 1e-5},
               Tendency{[](int h) { return rods(h, iwan); }, 1.5, 1e-5},
               Tendency{[](int h) { return rods(h, iwan_4); }, 1.5, 1e-5});
  CAPTURE(t.text(1));
  const double one = Timed(case_of(t.text(1)), t.eta).difference();
  const double many = Timed(case_of(t.text(15)), t.eta).difference();
  CAPTURE(one, many);
  CHECK(one > 1e-6);
  CHECK(many < t.last);
  CHECK(many < 0.1 * one);
}

TEST_CASE("Microslip that stays elastic moves in time as the spring that it is", "[ring]") {
  Timed sliders(case_of(rods(5, "kind = \"iwan\"\nstiffness = 10.0\nfirst_limit = 1e3\nspread = 1.0\n")),
                1.5);
  Timed spring(case_of(rods(5, "kind = \"polynomial\"\nlinear = 10.0\n")), 1.5);
  const auto of = [](Timed& one) {
    const SettledMotion found = shoot(one.motion, one.start);
    REQUIRE(found.settled);
    HarmonicRecord record(one.motion, {1}, true);
    next_state(one.motion, found.state, &record);
    return std::pair(std::abs(record.base()(0)), floquet_stability(one.motion, found.state).growth());
  };
  const auto [y, growth] = of(sliders);
  const auto [wanted, wanted_growth] = of(spring);
  CHECK_THAT(y, WithinRel(wanted, 1e-10));
  CHECK_THAT(growth, WithinRel(wanted_growth, 1e-8));
}
