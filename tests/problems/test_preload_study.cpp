// Studies of the paper's systems against a second method, which shares no code with the library: the dense
// scan of dense_response.hpp, in extended precision.

#include "arcslip/problems/ridges/preload_study.hpp"

#include <limits>

#include "catch.hpp"
#include "optimum_judge.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::OptimumKind;
using problems::Peak;
using problems::PeakBranch;
using problems::PeakSite;
using problems::PeakType;
using problems::PreloadRange;
using problems::PreloadStudy;

namespace {

/// Beams with n = 1, N = 30, F = 1, zeta = 1e-4 and nu = 0.3 [paper, figures 8 to 12].
SystemParameters beams(double mass_ratio, double frequency_ratio, double slenderness) {
  SystemParameters parameters;
  parameters.mass_ratio = mass_ratio;
  parameters.frequency_ratio = frequency_ratio;
  parameters.interface_stiffness = shear_interface_stiffness(slenderness, 0.3);
  return parameters;
}

const PreloadRange whole{0.1, 100, 0.5, 6, {}};

/// What the scan finds for one of the paper's curves: minima by bisection of the slope, exchanges by that of
/// the lead, to 1e-12; a death is a fold of the ridge.
struct PaperCurve {
  double mass_ratio;
  double frequency_ratio;
  double slenderness;
  double best;  ///< P_opt, smooth
  double eta;
  double ratio;  ///< Y_opt/Y_nd_max
  double low;
  double high;
  double exchange;
  double death;
  double death_eta;
};

// clang-format off
const std::vector<PaperCurve> curves{
    {5, 4, 33.3, 1.04129171423718, 3.82092303547274, 0.002229960431414, 0.801701501030, 2.635864269275, 1.8347612692528, 1.99037978733125, 3.60002920416},
    {10, 4, 33.3, 1.06445409406481, 3.90719685384893, 0.004238152355188, 0.800492371815, 2.799088323490, 2.8908652886292, 3.19937258721475, 3.79803739227},
    {20, 4, 33.3, 1.07343838752004, 3.95273853977784, 0.008230547444856, 0.794997422238, 2.860692942594, 4.0794194387734, 4.53344409105517, 3.89968128721},
    {50, 4, 33.3, 1.06876295359637, 3.98088541523337, 0.020018085418880, 0.776008387143, 2.870573985854, 5.46664744606976, 6.00967904213839, 3.96026990127},
    {100, 4, 33.3, 1.05068302262603, 3.99040929919827, 0.039053468160640, 0.744434938235, 2.831875707297, 5.97324729848339, 6.45758871948543, 3.98024199047},
    {10, 1.5, 12.5, 1.04671817030096, 1.47887433344994, 0.006754671213863, 0.793405237878, 2.697657169340, 2.2623053825854, 2.50540242515786, 1.45425013813},
    {10, 2, 16.7, 1.05230877340354, 1.96216579694129, 0.005083389662067, 0.796903373881, 2.725790696137, 2.3889148669830, 2.64656516380522, 1.91782584647},
};
// clang-format on

std::vector<Peak> rows_of(const PreloadStudy& study, PeakType type) {
  std::vector<Peak> rows;
  for (const PeakBranch& branch : study.branches) {
    for (const Peak& peak : branch) {
      if (peak.type == type) rows.push_back(peak);
    }
  }
  return rows;
}

PreloadStudy study_of(const SystemParameters& system, PreloadRange range = whole) {
  const PreloadStudy study = problems::study_preload(system, range);
  REQUIRE(study.failure.empty());
  REQUIRE(study.optimum);
  return study;
}

/// The highest amplitude at a preload of `stop_at`.
double highest(const PreloadStudy& study, double preload) {
  double Y = 0;
  for (const PeakBranch& branch : study.branches) {
    for (const Peak& peak : branch) {
      if (peak.preload == preload && peak.is_global) Y = peak.Y;
    }
  }
  return Y;
}

}  // namespace

TEST_CASE("Studies of figures 11 and 12 hold all peaks that the dense scan finds") {
  const PaperCurve curve = GENERATE(from_range(curves));
  PreloadRange range = whole;
  range.stop_at = {0.31, 0.999 * curve.death, 1.001 * curve.death, 27.0};
  const StudyRun run{beams(curve.mass_ratio, curve.frequency_ratio, curve.slenderness), range};
  CAPTURE(describe(run));
  StudyJudge judge(run);
  for (const double preload : range.stop_at) judge.judge_at(preload);
  judge.judge_at(range.from);
  judge.judge_at(range.to);
  const std::vector<Peak> rows = judge.global_rows();
  for (std::size_t i = 1; i < rows.size(); i += rows.size() / 8) judge.judge_global(rows[i]);
  CHECK(judge.complaints() == no_complaints);
}

TEST_CASE("The best preloads of figures 11 and 12 are those of the dense scan", "[numbers]") {
  const PaperCurve curve = GENERATE(from_range(curves));
  const StudyRun run{beams(curve.mass_ratio, curve.frequency_ratio, curve.slenderness), whole};
  CAPTURE(describe(run));
  const PreloadStudy study = study_of(run.system);
  CHECK(study.optimum->kind == OptimumKind::smooth);
  CHECK_THAT(study.free_Y, WithinRel(3.208115189307, 1e-10));
  CHECK_THAT(study.optimum->peak.Y / study.free_Y, WithinRel(curve.ratio, 1e-10));
  // the slope of ln Y over ln P is known to 1e-10
  CHECK_THAT(study.optimum->peak.preload, WithinRel(curve.best, 1e-9));
  CHECK_THAT(study.optimum->peak.eta, WithinRel(curve.eta, 1e-9));
  CHECK_THAT(study.optimum->low, WithinRel(curve.low, 1e-9));
  CHECK_THAT(study.optimum->high, WithinRel(curve.high, 1e-9));
  CHECK(OptimumJudge(run, study, {}).complaints() == no_complaints);
}

TEST_CASE("Peaks of figures 11 and 12 change places and die where the scan says") {
  const PaperCurve curve = GENERATE(from_range(curves));
  const PreloadStudy study = study_of(beams(curve.mass_ratio, curve.frequency_ratio, curve.slenderness));
  const std::vector<Peak> exchanges = rows_of(study, PeakType::exchange);
  REQUIRE(exchanges.size() == 2);
  for (const Peak& peak : exchanges) {
    CHECK_THAT(peak.preload, WithinRel(curve.exchange, 1e-9));
    CHECK(peak.is_global);
  }
  CHECK_THAT(exchanges[0].Y, WithinRel(exchanges[1].Y, 1e-10));
  std::vector<Peak> deaths = rows_of(study, PeakType::death);
  std::erase_if(deaths,
                [](const Peak& peak) { return peak.eta >= 5; });  // of gamma = 1.5, at the window's end
  REQUIRE(deaths.size() == 1);
  CHECK_THAT(deaths[0].preload, WithinRel(curve.death, 1e-9));
  CHECK_THAT(deaths[0].eta, WithinRel(curve.death_eta, 1e-6));  // at a fold, P turns
  CHECK(rows_of(study, PeakType::birth).empty());
}

TEST_CASE("The amplitude ratios of figures 11 and 12 are those of the dense scan") {
  struct Row {
    double mass_ratio, frequency_ratio, slenderness, preload, ratio;
  };
  const Row row = GENERATE(values<Row>({{5, 4, 33.3, 0.5, 0.363378781165},
                                        {5, 4, 33.3, 1, 0.002240729287},
                                        {5, 4, 33.3, 50, 0.080312868147},
                                        {100, 4, 33.3, 10, 0.270571409091},
                                        {100, 4, 33.3, 30, 0.796064045583},
                                        {100, 4, 33.3, 45, 0.997112646136},
                                        {100, 4, 33.3, 50, 1.002167486927},
                                        {100, 4, 33.3, 99, 1.002167486927},
                                        {10, 1, 8.3, 10, 0.909090909154},
                                        {10, 1.5, 12.5, 10, 0.048984073237},
                                        {10, 2, 16.7, 10, 0.036516631921},
                                        {10, 4, 33.3, 10, 0.029684827907}}));
  PreloadRange range = whole;
  range.stop_at = {row.preload};
  const PreloadStudy study = study_of(beams(row.mass_ratio, row.frequency_ratio, row.slenderness), range);
  CAPTURE(row.mass_ratio, row.frequency_ratio);
  CHECK_THAT(highest(study, row.preload) / study.free_Y, WithinRel(row.ratio, 1e-9));
}

TEST_CASE("Peaks of figure 8 up to its second resonance are born and die at folds of the explicit map") {
  PreloadRange range{0.1, 50, 0.5, 120, {}};
  const PreloadStudy study = study_of(beams(5, 4, 33.3), range);
  const std::vector<Peak> births = rows_of(study, PeakType::birth);
  const std::vector<Peak> deaths = rows_of(study, PeakType::death);
  REQUIRE(births.size() == 1);
  REQUIRE(deaths.size() == 1);
  CHECK_THAT(births[0].preload, WithinRel(0.15019871515956, 1e-9));
  CHECK_THAT(births[0].eta, WithinRel(15.423783038, 1e-6));  // at a fold, P turns
  CHECK_THAT(deaths[0].preload, WithinRel(1.99037978733125, 1e-9));
  CHECK_THAT(deaths[0].eta, WithinRel(3.60002920416, 1e-6));
}

TEST_CASE("No ridge of the explicit map of figure 8 is above the highest peak known") {
  const PreloadRange range{1.7, 2.1, 3.3, 3.9, {}};
  StudyJudge judge({beams(5, 4, 33.3), range});
  const dense::History history(dense_case(beams(5, 4, 33.3)), {range.eta_low, range.eta_high},
                               {range.from, range.to});
  judge.judge_changes(history);
  CHECK(history.changes().size() == 1);
  CHECK(history.map().pieces().size() > 20);
  CHECK(judge.overtakings(history.map()).empty());
  CHECK(judge.complaints() == no_complaints);
}

TEST_CASE("A peak that sticks at every preload has a flat optimum halfway, on the scale of ln P") {
  const SystemParameters system = beams(10, 1, 8.3);  // R/S = 0.909 at P = 0.1
  const PreloadStudy study = study_of(system);
  CHECK(study.optimum->kind == OptimumKind::flat);
  CHECK_THAT(study.optimum->peak.preload, WithinRel(std::sqrt(10.0), 1e-12));
  CHECK(study.optimum->low == whole.from);
  CHECK(study.optimum->high == whole.to);
  CHECK(study.optimum->energy == 0);
  CHECK(OptimumJudge({system, whole}, study, {0.11, 90}).complaints() == no_complaints);
}

TEST_CASE("The peak of M* = 50 passes through the corner between slip and stick") {
  PreloadRange range = whole;
  range.stop_at = {92.4, 92.48944930, 92.49};
  StudyJudge judge({beams(50, 4, 33.3), range});
  for (const double preload : range.stop_at) judge.judge_at(preload);
  CHECK(judge.complaints() == no_complaints);
  const std::vector<Peak> corners = rows_of(judge.study(), PeakType::corner);
  REQUIRE(corners.size() == 2);
  CHECK_THAT(corners[0].preload, WithinRel(92.4894487099933, 1e-9));
  CHECK_THAT(corners[1].preload, WithinRel(92.4894498272382, 1e-9));
}

TEST_CASE("Sensitivities of peaks in slip, in stick and on the corner are those of the scan's differences") {
  const auto [mass_ratio, preload, count] =
      GENERATE(table<double, double, int>({{5, 1, 10}, {100, 46.60541835, 5}, {100, 60, 5}}));
  PreloadRange range = whole;
  range.stop_at = {preload};
  StudyJudge judge({beams(mass_ratio, 4, 33.3), range});
  judge.judge_sensitivities(preload);
  CHECK(judge.sensitivities() == count);
  CHECK(judge.complaints() == no_complaints);
}

TEST_CASE("Sensitivities to preload and force add up to 1, and vanish at a smooth optimum") {
  // Y is homogeneous: Y(l F, l P) = l Y(F, P)
  const PreloadStudy study = study_of(beams(20, 4, 33.3));
  for (const PeakBranch& branch : study.branches) {
    for (const Peak& peak : branch) {
      CHECK_THAT(peak.sensitivity.preload + peak.sensitivity.force, WithinAbs(1, 1e-9));
      CHECK_THAT(peak.sensitivity.friction, WithinAbs(peak.sensitivity.preload, 1e-11));
    }
  }
  CHECK_THAT(study.optimum->peak.sensitivity.preload, WithinAbs(0, 1e-9));
}

TEST_CASE("A study scales with the force") {
  const double factor = GENERATE(1e-3, 7.0, 1e5);
  const PreloadStudy study = study_of(beams(5, 4, 33.3));
  SystemParameters system = beams(5, 4, 33.3);
  system.force *= factor;
  const PreloadStudy scaled = study_of(system, {0.1 * factor, 100 * factor, 0.5, 6, {}});
  CHECK_THAT(scaled.free_Y, WithinRel(factor * study.free_Y, 1e-10));
  CHECK_THAT(scaled.optimum->peak.preload, WithinRel(factor * study.optimum->peak.preload, 1e-9));
  CHECK_THAT(scaled.optimum->peak.Y, WithinRel(factor * study.optimum->peak.Y, 1e-10));
  CHECK_THAT(scaled.optimum->low, WithinRel(factor * study.optimum->low, 1e-9));
  CHECK_THAT(scaled.optimum->high, WithinRel(factor * study.optimum->high, 1e-9));
  CHECK_THAT(scaled.optimum->damping, WithinRel(study.optimum->damping, 1e-9));
  CHECK_THAT(scaled.optimum->energy, WithinRel(factor * factor * study.optimum->energy, 1e-8));
}

TEST_CASE("Rods of n waves are n copies of rods of one") {
  // with n N elements, n^2 K_FD and zeta/n: at n eta the same equation for n^2 R
  SystemParameters one = beams(5, 4, 33.3);
  one.model = StructureModel::rods;
  one.interface_stiffness = 1000;
  SystemParameters three = one;
  three.wave_number = 3;
  three.elements *= 3;
  three.interface_stiffness *= 9;
  three.base_damping /= 3;
  three.damper_damping /= 3;
  const PreloadStudy study = study_of(one, {0.05, 40, 0.5, 7, {}});
  const PreloadStudy copies = study_of(three, {0.05, 40, 1.5, 21, {}});
  CHECK(copies.optimum->kind == study.optimum->kind);
  CHECK_THAT(copies.optimum->peak.preload, WithinRel(study.optimum->peak.preload, 1e-9));
  CHECK_THAT(copies.optimum->peak.eta, WithinRel(3 * study.optimum->peak.eta, 1e-9));
  CHECK_THAT(9 * copies.optimum->peak.Y, WithinRel(study.optimum->peak.Y, 1e-9));
  CHECK_THAT(copies.optimum->high, WithinRel(study.optimum->high, 1e-9));
  CHECK(rows_of(copies, PeakType::birth).size() == rows_of(study, PeakType::birth).size());
  CHECK(rows_of(copies, PeakType::death).size() == rows_of(study, PeakType::death).size());
}

TEST_CASE("The best preload converges as 1/N^2 with the number of elements") {
  const auto best = [](Index elements) {
    SystemParameters system = beams(5, 4, 33.3);
    system.model = StructureModel::rods;
    system.interface_stiffness = 1000;
    system.elements = elements;
    return study_of(system, {0.05, 40, 0.5, 7, {}}).optimum->peak.Y;
  };
  const double limit = best(1'000'000);
  CHECK_THAT((best(100) - limit) / (best(200) - limit), WithinRel(4.0, 0.01));
}

TEST_CASE("A study that cannot be traced says so") {
  continuation::TraceOptions options;
  options.max_points = 5;
  CHECK_FALSE(problems::study_preload(beams(5, 4, 33.3), whole, options).failure.empty());
}

TEST_CASE("Studies of empty ranges and of systems that are not passive are refused") {
  const SystemParameters good = beams(5, 4, 33.3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const PreloadRange& range : std::vector<PreloadRange>{{1, 1, 0.5, 6, {}},
                                                             {2, 1, 0.5, 6, {}},
                                                             {0, 1, 0.5, 6, {}},
                                                             {-1, 1, 0.5, 6, {}},
                                                             {nan, 1, 0.5, 6, {}},
                                                             {1, nan, 0.5, 6, {}},
                                                             {1, inf, 0.5, 6, {}},
                                                             {0.1, 1, 6, 6, {}},
                                                             {0.1, 1, 6, 5, {}},
                                                             {0.1, 1, 0, 6, {}},
                                                             {0.1, 1, 0.5, inf, {}},
                                                             {0.1, 1, 0.5, nan, {}},
                                                             {0.1, 1, 0.5, 6, {2}},
                                                             {0.1, 1, 0.5, 6, {nan}}}) {
    CAPTURE(range.from, range.to, range.eta_low, range.eta_high);
    CHECK_THROWS_AS(problems::study_preload(good, range), std::invalid_argument);
  }
  std::vector<SystemParameters> bad(5, good);
  bad[0].base_damping = -1e-4;
  bad[1].base_damping = 0;
  bad[2].damper_damping = 0;
  bad[3].cubic_stiffness = 1;
  bad[4].cubic_stiffness = -1;
  for (const SystemParameters& system : bad)
    CHECK_THROWS_AS(problems::study_preload(system, whole), std::invalid_argument);
}
