// Elements with a memory, sectors and structures without symmetry in time, against balances of harmonics,
// numbers found by other means and differences.

#include <cmath>
#include <functional>
#include <numbers>

#include "arcslip/problems/response/more_harmonics.hpp"
#include "arcslip/problems/tasks/verification.hpp"
#include "arcslip/time/ring_record.hpp"
#include "arcslip/time/ring_stability.hpp"
#include "case_runs.hpp"
#include "catch.hpp"
#include "ring_cases.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::HarmonicResponse;

namespace {

/// A case of its own files.
Case case_of(const std::string& text) {
  const TemporaryFolder folder;
  const std::string head = "%%MatrixMarket matrix coordinate real symmetric\n";
  folder.write("m.mtx", head + "3 3 2\n1 1 3\n2 2 2\n");
  folder.write("k.mtx", head + "3 3 5\n1 1 8\n2 1 -3\n2 2 12\n3 2 -5\n3 3 5\n");
  folder.write("n.mtx", head + "3 3 2\n1 1 1\n2 2 0.8\n");
  folder.write("l.mtx", head + "3 3 5\n1 1 2.2\n2 1 -1.5\n2 2 4\n3 2 -2.5\n3 3 2.5\n");
  return read_case(folder.write("case.toml", text));
}

std::string sectors(Index wave_number, Index count, int highest, const std::string& more = "") {
  const auto part = [](const std::string& name, const std::string& m, const std::string& k) {
    return fmt::format(
        "[system.{}]\nmass = \"{}.mtx\"\nstiffness = \"{}.mtx\"\nleft = [1]\nright = [3]\ncontact = [1, 2]\n"
        "damping_kind = \"viscous\"\nreference_frequency = 0.3\n",
        name, m, k);
  };
  return fmt::format(
             "[system]\nmodel = \"sector\"\nsectors = {}\nwave_number = {}\ncontact_stiffness = 2.0\n"
             "preload = 0.1\nforce = 1.0\ndamping = {{ base = 1e-2, damper = 2e-2 }}\n"
             "reduction_window = [0.05, 3.0]\nharmonics = {}\n{}",
             count, wave_number, highest, more) +
         part("base", "m", "k") + "load = { dof = [2], value = [1.0] }\n" + part("damper", "n", "l") +
         "[branch]\nparameter = \"eta\"\nfrom = 0.1\nto = 0.6\n";
}

std::string rods(int highest, const std::string& element) {
  return fmt::format(
      "[system]\nmodel = \"rods\"\nwave_number = 1\nelements = 5\nmass_ratio = 3.0\nfrequency_ratio = 1.5\n"
      "interface_stiffness = 40.0\ndamping = {{ base = 1e-2, damper = 2e-2 }}\nforce = 1.0\npreload = 0.3\n"
      "harmonics = {}\n[[element]]\nat = \"damper\"\n{}\n[branch]\nparameter = \"eta\"\nfrom = 0.5\nto = 3\n",
      highest, element);
}

const std::string lift_off =
    "[[element]]\nkind = \"friction\"\nat = \"contact\"\nnormal = 2\ntangential_stiffness = 1.0\n"
    "normal_stiffness = 1.5\nmu = 0.5\nnormal_per_preload = 0.5\n";
const std::string iwan = "kind = \"iwan\"\nstiffness = 10.0\nfirst_limit = 0.1\nspread = 3.0\n";
const std::string iwan_4 = "kind = \"iwan_4\"\nslip_force = 3.0\nstiffness = 20.0\nchi = -0.4\nbeta = 0.2\n";

/// A response in time with the balance that it was begun with.
struct Timed {
  Timed(const Case& input, double eta)
      : system(input.branches.front().problem.system),
        problem(build_harmonic_system(system)),
        at(problem.guess(eta, system.preload)),
        motion(build_ring(system), eta, system.preload),
        start(motion.travelling(problems::ring_harmonics(problem, at))) {}

  /// Amplitudes of the first coordinates, relative differences; the largest.
  double difference() {
    const SettledMotion found = shoot(motion, start, 1e-9);
    CAPTURE(found.error, found.rounds);
    REQUIRE(found.settled);
    HarmonicRecord record(motion, {1}, true);
    next_state(motion, found.state, &record);
    Vector values;
    problem.observe(at.unknowns, at.parameters, at.regime, values);
    return std::abs(std::abs(record.base()(0)) / values(HarmonicResponse::Y) - 1);
  }

  SystemParameters system;
  HarmonicResponse problem;
  continuation::Guess at;
  RingMotion motion;
  RingState start;
};

/// Central differences of the flow over a time, in free states alone.
double derivative_error(RingMotion& motion, const RingState& start, double duration) {
  RingTangent tangent(motion);
  RingState end = start;
  motion.advance(end, duration, &tangent);
  const Matrix exact = tangent.at(end);
  const Index coordinates = start.position.size();
  double worst = 0;
  for (Index column = 0; column < exact.cols(); ++column) {
    if (column >= 2 * coordinates && exact.col(column).isZero(0)) continue;
    const bool velocity = column >= coordinates && column < 2 * coordinates;
    const double step = 1e-6 * start.position.norm() * (velocity ? motion.frequency() : 1.0);
    const auto moved = [&](double by) {
      RingState state = start;
      if (column < coordinates) state.position(column) += by;
      if (velocity) state.velocity(column - coordinates) += by;
      if (column >= 2 * coordinates) state.memory(column - 2 * coordinates) += by;
      motion.advance(state, duration);
      CHECK(state.phase == end.phase);
      return stacked(state);
    };
    const Vector difference = (moved(step) - moved(-step)) / (2 * step);
    worst = std::max(worst, (difference - exact.col(column)).norm() / std::max(1.0, difference.norm()));
  }
  return worst;
}

}  // namespace

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
