// Best preloads of responses in several harmonics and contacts, with cubic springs, and with preloads that
// grow with the speed: from whole responses.

#include "arcslip/problems/ridges/response_study.hpp"

#include <array>
#include <cmath>
#include <memory>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/problems/response/cubic_response.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "catch.hpp"
#include "random_systems.hpp"
#include "traced_height.hpp"

using namespace arcslip;
using namespace arcslip::problems;
using arcslip::testing::RandomSystems;
using arcslip::testing::traced_height;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

SystemParameters beams(int highest) {
  SystemParameters system;
  system.mass_ratio = 5;
  system.frequency_ratio = 4;
  system.interface_stiffness = shear_interface_stiffness(33.3, 0.3);
  system.harmonics = odd_up_to(highest);
  return system;
}

SystemParameters rods(int highest) {
  SystemParameters system = beams(highest);
  system.model = StructureModel::rods;
  system.interface_stiffness = 1000;
  return system;
}

PreloadRange range_with(double low = 0.5, double high = 6, double from = 0.1, double to = 100) {
  return {from, to, low, high, {}};
}

ResponsePeaks peaks_of(std::shared_ptr<const HarmonicResponse> problem, const PreloadRange& range) {
  continuation::Guess start = problem->guess(range.eta_low, range.to);
  return ResponsePeaks(
      {std::move(problem), "eta", "P", range.eta_low, range.eta_high, "Y", std::move(start), {}});
}

PreloadStudy response_study_of(const SystemParameters& system, const PreloadRange& range) {
  const HarmonicSystem built = build_harmonic_system(system);
  const StudiedContacts contacts{built.contacts, static_cast<double>(system.elements), system.preload_growth,
                                 true};
  ResponsePeaks peaks = peaks_of(std::make_shared<HarmonicResponse>(built), range);
  PreloadStudy study = study_response(peaks, range, contacts);
  INFO(study.failure);
  REQUIRE(study.optimum);
  return study;
}

}  // namespace

// Of an own solver with loops that are exact to their events, to all the digits that are given.
TEST_CASE("Figure 8 has its best preload in three and five harmonics where an exact solver finds it") {
  struct Known {
    int highest;
    double P, Y, eta;
  };
  for (const Known& known :
       {Known{1, 1.04129171, 0.00715396993, 3.82092304}, Known{3, 1.04149643, 0.00887593047, 3.85595876},
        Known{5, 1.03409240, 0.00852582609, 3.84997249}}) {
    INFO("harmonics up to " << known.highest);
    const Optimum optimum = *response_study_of(beams(known.highest), range_with()).optimum;
    CHECK(optimum.kind == OptimumKind::smooth);
    CHECK_THAT(optimum.peak.preload, WithinRel(known.P, 1e-8));  // the digits given
    CHECK_THAT(optimum.peak.Y, WithinRel(known.Y, 1e-9));
    CHECK_THAT(optimum.peak.eta, WithinRel(known.eta, 3e-9));
    CHECK_THAT(optimum.peak.sensitivity.preload, WithinAbs(0, 1e-8));
  }
}

TEST_CASE("In one harmonic whole responses have the best preloads that closed slopes have", "[random]") {
  for (const int seed : {5, 11, 14, 200, 201, 202, 203, 204}) {
    INFO("system " << seed);
    RandomSystems random(static_cast<std::uint64_t>(seed));
    const SystemParameters system = random.system();
    const auto [low, high] = testing::resonance_range(system);
    const PreloadRange range = range_with(low, high, 0.01, 100);
    const Optimum closed = *study_preload(system, range).optimum;
    const Optimum whole = *response_study_of(system, range).optimum;
    CHECK(whole.kind == closed.kind);
    CHECK_THAT(whole.peak.preload, WithinRel(closed.peak.preload, 1e-6));
    CHECK_THAT(whole.peak.Y, WithinRel(closed.peak.Y, 1e-8));
    CHECK_THAT(whole.low, WithinRel(closed.low, 1e-5));  // as precise as it is looked for
    CHECK_THAT(whole.high, WithinRel(closed.high, 1e-5));
    if (closed.peak.R_over_S > 1.01)  // nearer to the border the energy is a difference
      CHECK_THAT(whole.energy, WithinRel(closed.energy, 1e-5));
    CHECK(to_string(whole.peak.site) == to_string(closed.peak.site));
  }
}

TEST_CASE("The rods' best preload in nine harmonics is an exchange below which no dense scan comes",
          "[numbers]") {
  const PreloadRange range = range_with();
  const PreloadStudy study = response_study_of(rods(9), range);
  const Optimum& optimum = *study.optimum;
  CHECK(optimum.kind == OptimumKind::exchange);
  REQUIRE(optimum.other);
  CHECK(optimum.peak.sensitivity.preload < 0);
  CHECK(optimum.other->sensitivity.preload > 0);
  CHECK_THAT(optimum.peak.Y, WithinRel(optimum.other->Y, 1e-9));
  const HarmonicResponse problem(build_harmonic_system(rods(9)));
  CHECK_THAT(optimum.peak.Y, WithinRel(traced_height(problem, range, optimum.peak.preload), 1e-9));
  for (int i = -10; i <= 10; ++i) {
    const double preload = optimum.peak.preload * std::exp(0.02 * i + 1e-4);
    CHECK(traced_height(problem, range, preload) > optimum.peak.Y * (1 - 1e-9));
  }
  // Where one harmonic has its optimum the peak is 8.2 times as high as it says.
  CHECK_THAT(traced_height(problem, range, 0.81874072), WithinRel(1.0376, 1e-3));
}

TEST_CASE("Slopes of peaks over the preload are those of differences, on corners as well") {
  const PreloadRange range = range_with();
  ResponsePeaks peaks = peaks_of(std::make_shared<HarmonicResponse>(build_harmonic_system(rods(9))), range);
  int corners = 0;
  for (const double preload : {0.3, 0.66, 0.69783058, 0.80584219}) {
    constexpr double h = 1e-6;
    const std::vector<ResponsePeak> here = peaks.at(preload);
    const std::vector<ResponsePeak> above = peaks.at(preload * std::exp(h));
    const std::vector<ResponsePeak> below = peaks.at(preload * std::exp(-h));
    REQUIRE(above.size() == here.size());
    REQUIRE(below.size() == here.size());
    for (std::size_t k = 0; k < here.size(); ++k) {
      INFO("P = " << preload << ", eta = " << here[k].place);
      const bool corner = here[k].site == ResponsePeakSite::corner;
      corners += corner ? 1 : 0;
      // Heights are known to 1e-10, corners that no border tells of are met to 1e-9 on one side.
      CHECK_THAT(here[k].slope,
                 WithinRel((above[k].log_height - below[k].log_height) / (2 * h), corner ? 1e-2 : 1e-3));
    }
  }
  CHECK(corners >= 2);
}

TEST_CASE("A preload that grows with the speed has its best value where the load is that of a constant one") {
  SystemParameters system = beams(3);
  system.preload_growth = 0.05;
  const Optimum constant = *response_study_of(beams(3), range_with()).optimum;
  const Optimum grown = *response_study_of(system, range_with()).optimum;
  // At the peak dY/deta = dY/dS = 0, so that it stands where both loads are the same.
  CHECK_THAT(grown.peak.eta, WithinRel(constant.peak.eta, 1e-8));
  CHECK_THAT(grown.peak.Y, WithinRel(constant.peak.Y, 1e-9));
  CHECK_THAT(grown.peak.preload + 0.05 * std::pow(grown.peak.eta, 2), WithinRel(constant.peak.preload, 1e-7));
}

TEST_CASE("The best preload of a base with cubic springs is below what responses beside it reach") {
  SystemParameters system = beams(1);
  system.cubic_stiffness = 2e5;
  const FrictionSystem built = build_system(system);
  const auto problem = std::make_shared<CubicResponse>(built);
  const PreloadRange range = range_with();
  ResponsePeaks peaks(
      {problem, "eta", "P", range.eta_low, range.eta_high, "Y", problem->guess(range.eta_low, range.to), {}});
  const PreloadStudy study =
      study_response(peaks, range, {{{built.contact_stiffness, built.slip_per_preload}}, 30, 0, false});
  INFO(study.failure);
  REQUIRE(study.optimum);
  const double best = std::log(study.optimum->peak.Y);
  const Optimum linear = *study_preload(beams(1), range).optimum;
  CHECK(std::abs(study.optimum->peak.Y / linear.peak.Y - 1) > 1e-3);
  CHECK(std::isnan(study.optimum->peak.sensitivity.force));
  for (const double factor : {0.9, 0.99, 0.999, 1.001, 1.01, 1.1, 2.0}) {
    double highest = -1e300;
    for (const ResponsePeak& peak : peaks.at(study.optimum->peak.preload * factor))
      highest = std::max(highest, peak.log_height);
    CHECK(highest > best);
  }
}

TEST_CASE("Any quantity of a response but its phases can be an objective, and no other name") {
  const auto problem = std::make_shared<HarmonicResponse>(build_harmonic_system(beams(3)));
  const continuation::Guess start = problem->guess(0.5, 100);
  for (const continuation::Observable& one : problem->observables()) {
    CAPTURE(one.name);
    const bool is_phase = one.name == "beta" || one.name == "alpha" || one.name == "psi";
    CHECK(one.has_gradient);
    CHECK((one.period > 0) == is_phase);
    if (!is_phase) CHECK_NOTHROW(ResponsePeaks({problem, "eta", "P", 0.5, 6, one.name, start, {}}));
  }
  for (const char* other : {"beta", "W"})
    CHECK_THROWS_AS(ResponsePeaks({problem, "eta", "P", 0.5, 6, other, start, {}}), std::invalid_argument);
}

TEST_CASE("A response that is flat to rounding has its higher end as its peak") {
  SystemParameters system = beams(3);
  system.frequency_ratio = 4294967296;  // the window is far below all resonances of the base
  const PreloadRange range = range_with(0.5, 500);
  const auto problem = std::make_shared<HarmonicResponse>(build_harmonic_system(system));
  for (const double preload : {0.1, 1.0, 100.0}) {
    const std::vector<ResponsePeak> peaks = peaks_of(problem, range).at(preload);
    REQUIRE_FALSE(peaks.empty());
    Vector first(problem->observables().size());
    const continuation::Guess edge = problem->guess(range.eta_low, preload);
    problem->observe(edge.unknowns, edge.parameters, edge.regime, first);
    CHECK(peaks[highest_of(peaks)].log_height >= std::log(first(HarmonicResponse::Y)) - 1e-15);
  }
}
