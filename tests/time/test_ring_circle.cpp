// Friction circles in time, against differences, balances of many harmonics and closed forms, and what their
// disturbances do.

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "arcslip/problems/response/floquet_response.hpp"
#include "draws.hpp"
#include "timed_cases.hpp"

using namespace arcslip;
using namespace arcslip::testing;

namespace {

Case plane(int highest) {
  return read_case(source_folder() + "/problems/friction_circle.toml",
                   {fmt::format("system.harmonics={}", highest)});
}

/// A mass on springs that are the same in both directions, under a load that goes round.
Case round_orbit() {
  const TemporaryFolder folder;
  const std::string head = "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n";
  folder.write("one.mtx", head + "1 1 1\n2 2 1\n");
  folder.write("c.mtx", head + "1 1 0.03\n2 2 0.03\n");
  return read_case(folder.write(
      "case.toml",
      "[system]\nmodel = \"sector\"\ncontact_stiffness = [0.0, 0.0]\npreload = 1.0\nharmonics = 1\n"
      "[system.base]\nmass = \"one.mtx\"\nstiffness = \"one.mtx\"\ndamping = \"c.mtx\"\ncontact = [1, 2]\n"
      "load = { dof = [1, 2], value = [1.0, 0.0], imaginary = [0.0, -1.0] }\n[[element]]\nkind = "
      "\"friction_2d\"\n"
      "at = \"base\"\ncontact = 1\nsecond = 2\ntangential_stiffness = 0.6\nmu = 0.5\nnormal_per_preload = "
      "1.0\n"
      "[branch]\nparameter = \"eta\"\nfrom = 0.02\nto = 0.2\n"));
}

Case ring(Index wave_number, Index nodes, int highest) {
  return case_of(sectors(wave_number, nodes, highest, circle));
}

/// Largest |mu| over a period by the balance.
double growth(const Timed& timed, double eta) {
  const auto problem = problems::build_floquet_response(timed.system);
  double largest = 0;
  for (const auto& one : problem->disturbances(timed.at.unknowns, timed.at.parameters, timed.at.regime))
    largest = std::max(largest, std::exp(two_pi / eta * one.exponent.real()));
  return largest;
}

}  // namespace

TEST_CASE("Derivatives of the flow of friction circles are those of differences", "[ring][circle]") {
  const auto [input, eta] =
      GENERATE(table<std::function<Case()>, double>({{[] { return case_of(sectors(1, 4, 3, circle)); }, 0.23},
                                                     {[] { return plane(3); }, 0.105},
                                                     {[] { return plane(3); }, 0.17}}));
  CAPTURE(eta);
  Timed ring(input(), eta);
  ring.motion.advance(ring.start, 0.37 * ring.motion.period());
  const long before = ring.motion.count().events;
  CHECK(derivative_error(ring.motion, ring.start, 0.6 * ring.motion.period()) < 1e-5);
  CAPTURE(ring.motion.count().events - before);
  CHECK(ring.motion.count().events > before + 4);
}

TEST_CASE("Friction circles in time are what balances of more and more harmonics tend to",
          "[ring][circle][numbers]") {
  struct Tendency {
    std::function<Case(int)> input;
    double eta;
    double last;
  };
  const auto t = GENERATE(Tendency{[](int h) { return case_of(sectors(1, 5, h, circle)); }, 0.236, 1e-5},
                          Tendency{[](int h) { return case_of(sectors(2, 6, h, circle)); }, 0.285, 1e-5},
                          Tendency{plane, 0.12, 1e-5}, Tendency{plane, 0.157, 1e-5});
  CAPTURE(t.eta);
  const double few = Timed(t.input(3), t.eta).difference();
  const double many = Timed(t.input(13), t.eta).difference();
  CAPTURE(few, many);
  CHECK(few > 1e-6);
  CHECK(many < t.last);
}

TEST_CASE("An orbit that slips for ever is the closed form in time", "[ring][circle][numbers]") {
  // One harmonic is exact: k_t (S/R)^2 and k_t S sqrt(R^2 - S^2)/R^2 act as a spring and as a dashpot.
  const Case input = round_orbit();
  Timed ring(input, 0.16);
  const SettledMotion found = shoot(ring.motion, ring.start, 1e-11);
  REQUIRE(found.settled);
  HarmonicRecord record(ring.motion, {1}, true);
  RingState state = found.state;
  const long before = ring.motion.count().events;
  ring.motion.advance(state, ring.motion.period(), &record);
  CHECK(ring.motion.count().events <= before + 1);  // that it slips
  const double R = std::abs(record.base()(0));
  const double S = 0.5 / 0.6;
  CHECK(R > 1.2 * S);
  const double w = 2 * std::numbers::pi * 0.16;
  const std::complex<double> friction(0.6 * S * S / (R * R), 0.6 * S * std::sqrt(R * R - S * S) / (R * R));
  const std::complex<double> stiffness = 1.0 - w * w + std::complex<double>(0, w * 0.03) + friction;
  CHECK_THAT(std::abs(record.base()(0)) * std::abs(stiffness), WithinRel(1.0, 1e-9));
}

TEST_CASE("Disturbances of friction circles grow as those of all nodes in time", "[stability][circle]") {
  struct Point {
    std::function<Case()> input;
    double eta;
    double as_near;
  };
  // It sticks, comes apart clearly; waves with and without a common factor; sticks and slips, comes apart
  // just so.
  constexpr std::size_t points = sanitized ? 3 : 6;
  const auto p = GENERATE(take(points, values<Point>({{[] { return plane(13); }, 0.05, 1e-9},
                                                      {[] { return plane(13); }, 0.158, 1e-3},
                                                      {[] { return ring(2, 6, 13); }, 0.285, 1e-4},
                                                      {[] { return ring(1, 5, 13); }, 0.236, 1e-4},
                                                      {[] { return plane(13); }, 0.12, 1e-4},
                                                      {[] { return plane(13); }, 0.1553, 1e-3}})));
  CAPTURE(p.eta);
  Timed timed(p.input(), p.eta);
  const SettledMotion found = shoot(timed.motion, timed.start, 1e-10);
  REQUIRE(found.settled);
  CHECK_THAT(growth(timed, p.eta),
             WithinAbs(floquet_stability(timed.motion, found.state).growth(), p.as_near));
}
