// Peaks under scatter where the response is not proportional to force and preload: against the system of
// each sample, traced by itself.

#include "arcslip/problems/response/cubic_response.hpp"
#include "arcslip/problems/response/forced_response.hpp"
#include "cases/design_study.hpp"
#include "catch.hpp"
#include "paper_cases.hpp"

using namespace arcslip;
using namespace arcslip::problems;
using namespace arcslip::testing;

namespace {

SystemParameters damped_rods() {
  SystemParameters system = testing::rods(1);
  system.elements = 12;
  system.mass_ratio = 3;
  system.frequency_ratio = 1.5;
  system.interface_stiffness = 40;
  system.base_damping = 1e-2;
  system.damper_damping = 2e-2;
  return system;
}

StudyCase study_of(const SystemParameters& system, const Uncertainty& uncertainty) {
  StudyCase study;
  study.range.from = 0.4;
  study.range.to = 2;
  study.range.eta_low = 0.5;
  study.range.eta_high = 3;
  study.options.from = study.range.from;
  study.options.to = study.range.to;
  study.uncertain = uncertainty;
  study.design = [system, range = study.range](std::size_t) {
    StudyDesign design;
    design.system = system;
    design.range = range;
    return design;
  };
  return study;
}

/// ln of the highest Y of a response over the window; on an edge as well.
template <class Problem>
double highest(const Problem& problem, double preload, const PreloadRange& range) {
  double most = 0;
  for (const auto& point : trace_over_eta(problem, preload, range.eta_low, range.eta_high).points)
    most = std::max(most, values_at(problem, point)(ForcedResponse::Y));
  return std::log(most);
}

double highest(const SystemParameters& system, const PreloadRange& range) {
  const FrictionSystem built = build_system(system);
  return system.cubic_stiffness != 0 ? highest(CubicResponse(built), system.preload, range)
                                     : highest(ForcedResponse(built), system.preload, range);
}

struct Example {
  double growth;
  double cubic;
  bool friction_scatters;
  bool force_scatters;
};

}  // namespace

TEST_CASE("Quantiles without homogeneity are those of the samples' systems solved one by one",
          "[uncertainty][numbers]") {
  const Example example = GENERATE(Example{0.05, 0, true, false}, Example{0.05, 0, false, true},
                                   Example{0, 0.5, true, true}, Example{0.05, 0.5, true, true});
  SystemParameters system = damped_rods();
  system.preload_growth = example.growth;
  system.cubic_stiffness = example.cubic;
  Uncertainty uncertainty;
  if (example.friction_scatters) uncertainty.friction = {Scatter::Kind::lognormal, 0.2, 1, 1};
  if (example.force_scatters) uncertainty.force = {Scatter::Kind::uniform, 0, 0.7, 1.4};
  const auto [samples, tolerance] = GENERATE(std::pair(5, 2e-5), std::pair(40, 1.2e-2));
  uncertainty.samples = static_cast<std::size_t>(samples);
  const StudyCase study = study_of(system, uncertainty);
  const StudyDesign design = study.design(0);
  const PreloadStudy nominal = study_preload(study, design);
  REQUIRE(nominal.failure.empty());
  const UncertainPeaks peaks = study_uncertainty(study, design, nominal);
  REQUIRE(peaks.failure.empty());
  // Of five each has its envelope; between those for 40 there is a part of what their sampling leaves open.
  CHECK(peaks.error < tolerance);

  // With neither kind of homogeneity these are the samples' own factors on mu and F.
  const std::vector<DesignFactors> factors = PeakDistribution(uncertainty, {true, true}).factors();
  for (const std::size_t r : {std::size_t{0}, peaks.rows.size() / 2, peaks.rows.size() - 1}) {
    const QuantileRow& row = peaks.rows[r];
    std::vector<double> all;
    for (const DesignFactors& sample : factors) {
      SystemParameters one = system;
      one.preload = row.preload * std::exp(sample.log_growth);  // mu, which P and P_2 are proportional to
      one.preload_growth *= std::exp(sample.log_growth);
      one.force *= std::exp(sample.log_force);
      all.push_back(highest(one, study.range));
    }
    std::sort(all.begin(), all.end());
    for (std::size_t q = 0; q < row.Y.size(); ++q) {
      const auto rank = static_cast<std::size_t>(std::ceil(uncertainty.quantiles[q] * samples));
      INFO("P = " << row.preload << ", quantile " << uncertainty.quantiles[q] << ", error " << peaks.error);
      CHECK_THAT(std::log(row.Y[q]), WithinAbs(all[rank - 1], tolerance));
    }
  }
}
