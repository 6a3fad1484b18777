#include "arcslip/time/disturbance_flow.hpp"

#include <cmath>
#include <numbers>

#include "arcslip/problems/response/floquet_response.hpp"
#include "arcslip/time/ring_stability.hpp"
#include "case_runs.hpp"
#include "catch.hpp"
#include "mistakes.hpp"
#include "program.hpp"
#include "ring_cases.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::FloquetResponse;

namespace {

FloquetResponse response(SystemParameters system, int highest) {
  system.harmonics = odd_up_to(highest);
  return {build_harmonic_system(system), ring_waves(system, highest + 1)};
}

std::vector<RingDisturbances::Disturbance> exponents(const RingCase& c, int highest) {
  const FloquetResponse problem = response(c.system, highest);
  const continuation::Guess at = problem.guess(c.eta, c.preload);
  return problem.disturbances(at.unknowns, at.parameters, at.regime);
}

RingStability in_time(const RingCase& c) {
  RingMotion motion(build_ring(c.system), c.eta, c.preload);
  const SettledMotion settled = shoot(motion, motion.travelling({one_harmonic(c.system, c.eta, c.preload)}));
  REQUIRE(settled.settled);
  return floquet_stability(motion, settled.state);
}

/// The multipliers nu of the ring in time, of these exponents.
ComplexVector turned(const RingCase& c, const std::vector<RingDisturbances::Disturbance>& found) {
  const auto nodes = static_cast<double>(c.system.elements);
  const double part = 2 * std::numbers::pi / nodes;
  ComplexVector nu(std::ssize(found));
  for (std::size_t i = 0; i < found.size(); ++i) {
    nu(static_cast<Index>(i)) =
        std::exp(found[i].exponent * (part * static_cast<double>(c.system.wave_number) / c.eta) -
                 Complex(0, part * static_cast<double>(found[i].wave)));
  }
  return nu;
}

/// The largest distance of a multiplier nu of the ring, above `modulus`, from the nearest of the exponents'.
double worst(const RingCase& c, const RingStability& ring, int highest, double modulus) {
  const ComplexVector nu = turned(c, exponents(c, highest));
  double most = 0;
  for (const Complex& wanted : ring.turned) {
    if (std::abs(wanted) > modulus) most = std::max(most, (nu.array() - wanted).abs().minCoeff());
  }
  return most;
}

ComplexVector sigma_of(const std::vector<RingDisturbances::Disturbance>& found) {
  ComplexVector sigma(std::ssize(found));
  std::transform(found.begin(), found.end(), sigma.begin(), [](const auto& one) { return one.exponent; });
  return sigma;
}

double growth(const RingCase& c, const ComplexVector& sigma) {
  return std::exp(2 * std::numbers::pi / c.eta * sigma.real().maxCoeff());
}

int unstable(const ComplexVector& sigma) { return static_cast<int>((sigma.real().array() > 0).count()); }

}  // namespace

TEST_CASE("Exponents of disturbances tend to the multipliers of the ring in time", "[stability]") {
  struct Tendency {
    RingCase at;
    double three, nine;
  };
  // What a truncated balance leaves out falls as 1/h^3 in the motion, and with it the multipliers' error.
  const auto t = GENERATE(
      Tendency{{small_beams(4), 3.7, 0.03}, 2e-4, 1e-5}, Tendency{{small_beams(6), 3.7, 0.03}, 2e-4, 1e-5},
      Tendency{{small_rods(5), 2.3, 0.03}, 0.1, 1e-2}, Tendency{{held(small_rods(5)), 2.3, 0.1}, 0.1, 1e-2},
      Tendency{{driven(small_rods(5), -0.002), 2.3, 0.03}, 0.1, 1e-2});
  const RingStability ring = in_time(t.at);
  const double nine = worst(t.at, ring, 9, 0.3);
  CHECK(nine < t.nine);
  CHECK(worst(t.at, ring, 3, 0.3) < t.three);
  CHECK(worst(t.at, ring, 3, 0.3) > 3 * nine);
}

TEST_CASE("Without slip the exponents are those of the ring to rounding", "[stability]") {
  const RingCase c =
      GENERATE(RingCase{small_beams(5), 3.7, 10.0}, RingCase{small_beams(4), 3.7, 10.0},
               RingCase{small_rods(7), 2.3, 10.0}, RingCase{driven(small_rods(5), -0.1), 1.1, 10.0});
  CHECK(worst(c, in_time(c), 7, 0) < 1e-9);
}

TEST_CASE("Disturbances grow as in the ring in time, and are as many", "[stability]") {
  SystemParameters rods = driven(small_rods(5), -0.002);
  rods.wave_number = 1;
  rods.frequency_ratio = 1.5;
  const auto [eta, expected] =
      GENERATE(table<double, int>({{1.4, 4}, {1.7, 8}, {1.9, 4}, {2.2, 0}, {3.0, 0}}));
  const RingCase c{rods, eta, 0.03};
  const ComplexVector sigma = sigma_of(exponents(c, 1));
  const RingStability ring = in_time(c);
  CAPTURE(eta);
  CHECK(ring.unstable() == expected);
  CHECK(unstable(sigma) == expected);
  CHECK_THAT(growth(c, sigma), WithinRel(ring.growth(), 2e-3));  // one harmonic
}

TEST_CASE("A passive response is stable however many harmonics are kept", "[stability]") {
  const RingCase c = GENERATE(RingCase{small_beams(), 3.7, 0.03}, RingCase{small_beams(), 3.7, 1e-3},
                              RingCase{small_rods(6), 1.4, 0.01}, RingCase{small_rods(), 2.3, 0.03},
                              RingCase{held(small_rods()), 2.3, 0.3});
  CHECK(unstable(sigma_of(exponents(c, GENERATE(1, 5)))) == 0);
}

TEST_CASE("The cost of exponents and their values do not depend on the number of nodes",
          "[stability][numbers]") {
  SystemParameters s = small_beams(1000);
  const ComplexVector thousand = sigma_of(exponents({s, 3.7, 0.03}, 3));
  s.elements = 1'000'000;
  const ComplexVector million = sigma_of(exponents({s, 3.7, 0.03}, 3));
  CHECK(million.size() <= thousand.size());
  CHECK_THAT(million.real().maxCoeff(),
             WithinRel(thousand.real().maxCoeff(), 1e-4));  // (h n/N)^2 of elements
}

TEST_CASE("A contact that is cut in two has the exponents of the whole", "[stability]") {
  const RingCase c{small_rods(5), 2.3, 0.03};
  SystemParameters s = c.system;
  const int highest = GENERATE(1, 3);  // of more waves than these hold, and of fewer
  s.harmonics = odd_up_to(highest);
  const auto cut_structure = [](const ContactModes& one) {
    std::vector<ContactMode> modes;
    for (const ContactMode& mode : one.modes())
      modes.push_back({mode.frequency, ContactVector::Constant(2, mode.shape(0)), mode.load});
    return ContactModes(2, std::move(modes), one.loss());
  };
  HarmonicSystem system = build_harmonic_system(s);
  for (auto* structures : {&system.base, &system.damper}) {
    for (ContactModes& one : *structures) one = cut_structure(one);
  }
  system.contacts.front().stiffness /= 2;
  system.contacts.push_back(system.contacts.front());
  const RingWaves whole = ring_waves(s, highest + 1);
  const RingWaves waves(s.wave_number, s.elements, [&](Index wave) {
    const RingWaves::Structures under = whole.structures(wave);
    return RingWaves::Structures{cut_structure(under.base), cut_structure(under.damper)};
  });
  const FloquetResponse problem(system, waves);
  const continuation::Guess at = problem.guess(c.eta, c.preload);
  const ComplexVector cut = turned(c, problem.disturbances(at.unknowns, at.parameters, at.regime));
  const auto found = exponents(c, highest);
  const ComplexVector nu = turned(c, found);
  for (Index i = 0; i < nu.size(); ++i) {
    if (found[static_cast<std::size_t>(i)].exponent.real() < -0.3 * c.eta)
      continue;  // of sliders, which the points on an arc resolve less well
    CHECK((cut.array() - nu(i)).abs().minCoeff() < 1e-7);
  }
}

TEST_CASE("An exponent vanishes at each fold that the engine finds", "[stability][numbers]") {
  const Run run("negative_damping", {"branch.stability=true", "system.elements=5"});
  const continuation::Branch& branch = run.traced.front().branch;
  int folds = 0;
  for (std::size_t i = 1; i + 1 < branch.points.size(); ++i) {
    const BranchPoint& point = branch.points[i];
    if (point.type != PointType::fold) continue;
    ++folds;
    CHECK(point.eigenvalues.cwiseAbs().minCoeff() < 1e-7);  // rounding over the slope of the exponent
    const auto real = [](const BranchPoint& at) {
      return (at.eigenvalues.real().array() > 0 && at.eigenvalues.imag().array() == 0).count();
    };
    CHECK(std::abs(real(branch.points[i + 1]) - real(branch.points[i - 1])) == 1);
  }
  CHECK(folds == 4);
}

TEST_CASE("The case of a response that friction holds loses its stability where the file says", "[cases]") {
  const Run run("stability");
  const std::vector<BranchPoint> left = points(run.traced[0], PointType::neimark_sacker);
  REQUIRE(left.size() == 10);
  for (const auto& [i, eta] : {std::pair{0, 1.55880087}, {7, 1.64131661}, {8, 1.74318812}, {9, 2.05305663}})
    CHECK_THAT(left[static_cast<std::size_t>(i)].parameters(0), WithinRel(eta, 1e-8));
  for (const BranchPoint& point : run.traced[0].branch.points) {
    const double eta = point.parameters(0);
    const bool inside = (eta > 1.5589 && eta < 1.6413) || (eta > 1.7432 && eta < 2.053);
    const bool outside = eta < 1.5588 || (eta > 1.6414 && eta < 1.7431) || eta > 2.0531;
    if (inside) CHECK(point.unstable > 0);
    if (outside) CHECK(point.unstable == 0);
  }
  const BranchPoint peak = points(run.traced[0], PointType::peak).at(0);
  const RingCase c{run.input.branches.front().problem.system, peak.parameters(0), 0.3};
  CHECK_THAT(growth(c, peak.eigenvalues), WithinAbs(1.066, 5e-4));
  CHECK_THAT(in_time(c).growth(), WithinAbs(1.066, 5e-4));
}

TEST_CASE("Stability of what has no exponents is refused in one line", "[stability]") {
  const TemporaryFolder folder;
  const std::string text =
      "[system]\nmodel = \"rods\"\nwave_number = 1\nelements = 6\nmass_ratio = 5.0\nfrequency_ratio = 2.0\n"
      "interface_stiffness = 40.0\ndamping = { base = 0.01, damper = 0.01 }\nforce = 1.0\npreload = 0.6\n"
      "[branch]\nstability = true\nparameter = \"eta\"\nfrom = 1.4\nto = 2.4\n";
  const auto mistake = GENERATE(values<Mistake>({
      {"true", "1", ":12:13", "branch.stability", "true or false", "1"},
      {"base = 0.01", "kind = \"structural\", base = 0.01", ":12:13", "branch.stability", "viscous", ""},
      {"to = 2.4", "to = 2.4\nresponse = \"one_way\"", ":12:13", "branch.stability", "one-way responses", ""},
  }));
  CHECK_NOTHROW(read_case(folder.write("case.toml", text)));
  const std::string path = folder.write("case.toml", replaced(text, mistake.from, mistake.to));
  check_message(error_of([&] { read_case(path); }), mistake);
  const SystemParameters damped = [] {
    SystemParameters s = small_rods();
    s.base_damping_kind = DampingKind::structural;
    return s;
  }();
  CHECK_THROWS_WITH(response(damped, 1), ContainsSubstring("structural") || ContainsSubstring("viscous"));
}
