// Best preloads beside elements that are not odd: against whole responses at other preloads, and what
// scatters against the systems of the samples.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "arcslip/problems/response/harmonic_response.hpp"
#include "case_texts.hpp"
#include "cases/design_study.hpp"
#include "catch.hpp"
#include "random_systems.hpp"
#include "ring_of_rows.hpp"
#include "small_structures.hpp"
#include "temporary_folder.hpp"
#include "traced_height.hpp"

using namespace arcslip;
using namespace arcslip::problems;
using namespace arcslip::testing;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// Three masses, the first of which rubs as the second one presses it, and lifts off.
std::string even_study(const SmallStructure& s, const std::string& harmonics, const std::string& range) {
  return small_system_text(s, harmonics) +
         "\n[[element]]\nkind = \"friction\"\nat = \"base\"\ncontact = 1\nnormal = 2\n"
         "tangential_stiffness = 0.9\nnormal_stiffness = 0.7\nmu = 0.4\nnormal_per_preload = 1.0\n\n"
         "[study]\nparameter = \"P\"\n" +
         range;
}

/// The highest Y of a response that is traced by itself.
double highest_response(SystemParameters system, double preload, const PreloadRange& range) {
  system.preload = preload;
  return traced_height(HarmonicResponse(build_harmonic_system(system)), range, preload);
}

/// A study of one design, whose best preload is as high as a response traced by itself.
struct Studied {
  Studied(const TemporaryFolder& folder, const std::string& text)
      : study(read_study(folder.write("case.toml", text))),
        design(study.design(0)),
        result(study_preload(study, design)) {
    INFO(result.failure);
    REQUIRE(result.optimum);
    CHECK_THAT(highest_response(design.system, best().preload, design.range), WithinRel(best().Y, 1e-9));
  }

  const Peak& best() const { return result.optimum->peak; }

  StudyCase study;
  StudyDesign design;
  PreloadStudy result;
};

}  // namespace

TEST_CASE("The best preload of what lifts off has lower peaks than all others", "[even]") {
  RandomSystems draw(3);
  const TemporaryFolder folder;
  for (const char* harmonics : {"1", "2"}) {
    const SmallStructure s = random_structure(draw);
    write_matrices(s, folder);
    const Studied studied(folder, even_study(s, harmonics, "from = 0.1\nto = 10.0\neta = [0.1, 0.3]\n"));
    const auto& [study, design, result] = studied;
    const Peak& best = studied.best();
    for (const double factor : {0.1, 0.5, 0.9, 0.99, 1.01, 1.1, 2.0, 10.0}) {
      const double preload = std::clamp(factor * best.preload, 0.1, 10.0);
      CHECK(highest_response(design.system, preload, design.range) >= best.Y * (1 - 1e-9));
    }
    CHECK(std::isnan(best.sensitivity.friction));
    CHECK(result.optimum->energy > 0);
    // Slopes of peaks, at corners as well, are those of responses beside them.
    for (const PeakBranch& branch : result.branches) {
      const Peak& peak = branch[branch.size() / 2];
      if (!peak.is_global) continue;
      constexpr double step = 1e-4;
      const double above = highest_response(design.system, peak.preload * (1 + step), design.range);
      const double below = highest_response(design.system, peak.preload * (1 - step), design.range);
      CHECK_THAT(std::log(above / below) / std::log((1 + step) / (1 - step)),
                 WithinAbs(peak.sensitivity.preload, 1e-4));
    }
  }
}

TEST_CASE("A best preload is found although low preloads have responses that come back to the window's edge",
          "[even]") {
  // At low preloads and low eta several motions are in balance; the one that leads on is met from the other
  // edge.
  const TemporaryFolder folder;
  write_row(folder, "base", {1.88, 3.98, 6.76}, {3.51, 3.71, 7.23}, {4.23, 2.83, 4.79});
  write_row(folder, "damper", {0.881, 0.87, 0.944}, {0.766, 1.37, 5.79}, {0.0839, 0.149, 0.0987});
  const std::string text = ring_of_rows(
      "[1, 2]",
      "wave_number = 1\ncontact_stiffness = 0.647\npreload = 0.3\ndamping = { base = 0.00486, damper = "
      "0.0033 }\n"
      "[[element]]\nkind = \"friction\"\nat = \"contact\"\nnormal = 2\n"
      "tangential_stiffness = 1.25\nnormal_stiffness = 2.09\nmu = 0.348\nnormal_per_preload = 0.647\n");
  const Studied studied(folder,
                        text + "[study]\nparameter = \"P\"\nfrom = 0.03\nto = 10.0\neta = [0.1, 0.6]\n");
  const auto& [study, design, result] = studied;
  PreloadRange backwards = design.range;
  std::swap(backwards.eta_low, backwards.eta_high);
  int came_back = 0;
  for (const double preload : {0.03, 0.06, 0.0688, 0.07, 0.08, 0.1, 0.3, 0.5, 0.6, 1.0, 10.0}) {
    CAPTURE(preload);
    SystemParameters system = design.system;
    system.preload = preload;
    const auto branch =
        traced_response(HarmonicResponse(build_harmonic_system(system)), design.range, preload);
    came_back += static_cast<int>(branch.stop == continuation::Stop::left_range);
    CHECK(highest_response(design.system, preload, backwards) >= studied.best().Y * (1 - 1e-9));
  }
  CHECK(came_back > 0);
}

TEST_CASE("A mu that elements have of their own scatters with that of the contacts", "[even][uncertainty]") {
  RandomSystems draw(5);
  SmallStructure s = random_structure(draw);
  s.contact_stiffness[1] = 0.5;
  const TemporaryFolder folder;
  write_matrices(s, folder);
  StudyCase study =
      read_study(folder.write("case.toml", even_study(s, "1", "from = 1.0\nto = 1.2\neta = [0.15, 0.25]\n")));
  Uncertainty uncertainty;
  uncertainty.friction = {Scatter::Kind::uniform, 0, 0.7, 1.3};
  uncertainty.samples = 3;
  uncertainty.quantiles = {0.1, 0.5, 0.9};
  study.uncertain = uncertainty;
  const StudyDesign design = study.design(0);
  const PreloadStudy nominal = study_preload(study, design);
  REQUIRE(nominal.failure.empty());
  const UncertainPeaks peaks = study_uncertainty(study, design, nominal);
  INFO(peaks.failure);
  REQUIRE(peaks.failure.empty());
  const std::vector<DesignFactors> factors = PeakDistribution(uncertainty, {false, false, true}).factors();
  const QuantileRow& row = peaks.rows[peaks.rows.size() / 2];
  std::vector<double> all;
  for (const DesignFactors& sample : factors) {
    SystemParameters one = design.system;
    const double mu = std::exp(sample.log_friction);
    one.contacts[1].slip_per_preload *= mu;  // the one that rubs
    one.others[0].settings[2] *= mu;
    all.push_back(highest_response(one, row.preload, design.range));
  }
  std::sort(all.begin(), all.end());
  CHECK(all.back() > 1.01 * all.front());
  for (std::size_t q = 0; q < all.size(); ++q)
    CHECK_THAT(row.Y[q], WithinRel(all[q], std::max(1e-5, 2 * peaks.error)));
}

TEST_CASE("Harmonics are added as a best preload of what lifts off asks for", "[even]") {
  RandomSystems draw(3);
  const TemporaryFolder folder;
  const SmallStructure s = random_structure(draw);
  write_matrices(s, folder);
  const StudyCase study =
      read_study(folder.write("case.toml", even_study(s, "\"auto\"\nharmonics_tolerance = 1e-2",
                                                      "from = 1.0\nto = 3.0\neta = [0.15, 0.25]\n")));
  const PreloadStudy result = study_preload(study, study.design(0));
  INFO(result.failure);
  REQUIRE(result.optimum);
  REQUIRE(result.harmonics.size() >= 6);
  CHECK(result.harmonics[0] == 1);
  CHECK(result.harmonics[1] == 0);
  CHECK(std::is_sorted(result.harmonics.begin() + 1, result.harmonics.end()));
}

TEST_CASE("A study holds beside a corner to which the response bends sharply", "[study][even]") {
  const TemporaryFolder folder;
  const auto best = [&](const std::string& range) {
    return Studied(folder,
                   "[system]\nmodel = \"spring_mass\"\n"
                   "base = { mass = [1.0, 1.0], stiffness = [1.0, 1.0], contact = 2, load = [0.0, 1.0] }\n"
                   "damper = { mass = [0.2], stiffness = [4.0] }\ncontact_stiffness = 2\n"
                   "damping = { base = 0.01, damper = 0.01 }\nforce = 1.0\nharmonics = 5\n"
                   "[study]\nparameter = \"P\"\neta = [0.2, 4]\n" +
                       range)
        .best()
        .preload;
  };
  CHECK_THAT(best("from = 0.05\nto = 10.0\n"), WithinRel(best("from = 0.5\nto = 3.0\n"), 1e-7));
}
