// Preload studies in which special points coincide: the stuck resonance is the peak, its corner and where a
// ridge in slip meets the border all in one, as wherever R and Y peak together; ranges and windows that end
// on it.

#include <cmath>
#include <numbers>

#include "arcslip/cases/study_case.hpp"
#include "arcslip/problems/ridges/response_slopes.hpp"
#include "catch.hpp"
#include "optimum_judge.hpp"
#include "random_systems.hpp"
#include "sector_files.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::PreloadStudy;

namespace {

/// A held damper, so that R = Y, or one with dampings far apart.
StudyRun draw_run(RandomSystems& draw, double& resonance, double& border) {
  StudyRun run;
  SystemParameters& s = run.system;
  s = draw.ring(3, 60);
  s.mass_ratio = draw.log_uniform(0.5, 50);
  s.frequency_ratio = draw.log_uniform(0.7, 6);
  s.interface_stiffness = draw.log_uniform(10, 1e5);
  s.base_damping = draw.log_uniform(1e-6, 0.05);
  s.damper_damping = draw.log_uniform(1e-6, 0.05);
  s.fixed_damper = draw.integer(0, 3) != 0;
  if (draw.integer(0, 1) == 0) s.base_damping_kind = DampingKind::structural;
  const FrictionSystem system = build_system(s);
  resonance = joined_frequencies({&system.base, &system.damper}, system.contact_stiffness).front();
  border = problems::ResponseSlopes::on_border(system, resonance).preload();
  run.range = {border * draw.log_uniform(1e-4, 0.5),
               border * draw.log_uniform(2, 30),
               0.5 * resonance,
               1.5 * resonance,
               {}};
  return run;
}

/// What is wrong with the heights of the highest peak, and with all peaks at these preloads.
std::vector<std::string> complaints(const StudyRun& run, const std::vector<double>& preloads) {
  StudyJudge judge(run);
  const std::vector<problems::Peak> rows = judge.global_rows();
  for (std::size_t i = 0; i < rows.size(); i += rows.size() / 4 + 1) judge.judge_global(rows[i]);
  for (const double preload : preloads) judge.judge_at(preload);
  return judge.complaints();
}

}  // namespace

TEST_CASE("Studies of resonances on the corner hold all peaks that the dense scan finds", "[numbers]") {
  RandomSystems draw(11);
  double resonance = 0;
  double border = 0;
  for (int i = 0; i < 20; ++i) {
    StudyRun run = draw_run(draw, resonance, border);
    run.range.stop_at = {border * (1 - 1e-4), border, border * (1 + 1e-4)};
    CAPTURE(i, describe(run));
    CHECK(complaints(run, run.range.stop_at) == no_complaints);
    run.range.stop_at.clear();
    run.range.from = border;
    CHECK(complaints(run, {border}) == no_complaints);
    run.range.from = 0.1 * border;
    run.range.to = border;
    CHECK(complaints(run, {border}) == no_complaints);
  }
}

TEST_CASE("Studies of windows that end on a resonance hold the highest peak that the dense scan finds") {
  RandomSystems draw(12);
  double resonance = 0;
  double border = 0;
  for (int i = 0; i < 20; ++i) {
    StudyRun run = draw_run(draw, resonance, border);
    run.range.eta_low = resonance;
    CAPTURE(i, describe(run));
    CHECK(complaints(run, {}) == no_complaints);
    run.range.eta_low = 0.5 * resonance;
    run.range.eta_high = resonance;
    CHECK(complaints(run, {}) == no_complaints);
  }
}

TEST_CASE("A ridge is known at preloads between points of equal eta, and right beside its end") {
  StudyRun turning;
  SystemParameters& rods = turning.system;
  rods.model = StructureModel::rods;
  rods.wave_number = 2;
  rods.elements = 57;
  rods.mass_ratio = 2.3628470716123697;
  rods.frequency_ratio = 2.1748558424350133;
  rods.interface_stiffness = 734.76919623678407;
  rods.base_damping = 0.0018286854146032337;
  rods.damper_damping = 0.0018147905254830518;
  rods.base_damping_kind = DampingKind::structural;
  turning.range = {0.089330621448623651, 317.51699654787967, 1.0596549814458507, 7.9332949676802524, {}};
  CHECK(complaints(turning, {}) == no_complaints);

  StudyRun ending;
  SystemParameters& beams = ending.system;
  beams.model = StructureModel::beams;
  beams.wave_number = 2;
  beams.elements = 10;
  beams.mass_ratio = 3.6106268190373174;
  beams.frequency_ratio = 1.2207954510847923;
  beams.interface_stiffness = 7911.6477523916556;
  beams.base_damping = 0.0004785309699702092;
  beams.damper_damping = 7.2388620369622506e-05;
  beams.base_damping_kind = DampingKind::structural;
  beams.fixed_damper = true;
  const double end = 61.599346034807176;
  ending.range = {10.768805510602878, 1802.4853970415195, 1.5101564734778503, 131.45809477815575, {end}};
  CHECK(complaints(ending, {end}) == no_complaints);
}

// R = Y of one mass is highest where m w*^2 = K + k Re f(R/S), 2 zeta K + k Im f = F/R. Im f is largest at R
// = 2 S, 1/pi, where Re f = 1/2. What sticks is highest at its undamped resonance exactly.
TEST_CASE("One mass with structural damping has its best preload in closed form, whatever the contact") {
  const double zeta = GENERATE(1e-2, 1e-5);
  const TemporaryFolder folder;
  FiniteSector mass;
  mass.mass = sparse(Matrix(Eigen::Vector2d(1, 0).asDiagonal()));
  mass.stiffness = sparse((Matrix(2, 2) << 1500, -500, -500, 500).finished());
  mass.left = {0};
  mass.right = {1};
  mass.contacts = {0};
  mass.load = ComplexVector::Unit(2, 0);
  const StudyCase study = read_study(folder.write(
      "case.toml", fmt::format("[system]\nmodel = \"sector\"\nwave_number = 4\nsectors = 24\n"
                               "contact_stiffness = 1.0\ndamping = {{ base = {} }}\n",
                               zeta) +
                       write_sector(folder, "base", mass, "damping_kind = \"structural\"") +
                       "[study]\nparameter = \"P\"\nfrom = 0.01\nto = 10.0\neta = [2.0, 20.0]\n"
                       "for_each.contact_stiffness = { from = 100.0, to = 5000.0, count = 40 }\n"));
  REQUIRE(study.count == 40);
  constexpr double K = 1500;  // 1000 + 500 (2 - 2 cos(2 pi 4/24))
  for (std::size_t i = 0; i < study.count; ++i) {
    const SystemParameters system = study.design(i).system;
    const double k = system.contacts.front().stiffness;
    CAPTURE(zeta, k);
    const PreloadStudy found = problems::study_preload(system, study.range);
    REQUIRE(found.optimum);
    const double Y = 1 / (2 * zeta * K + k / pi);
    CHECK(found.optimum->kind == problems::OptimumKind::smooth);
    CHECK_THAT(found.optimum->peak.Y, WithinRel(Y, 1e-12));
    CHECK_THAT(found.optimum->peak.preload, WithinRel(k * Y / 2, 1e-9));  // flat to the root of rounding
    CHECK_THAT(found.optimum->peak.eta, WithinRel(std::sqrt(K + k / 2) / (2 * pi), 1e-9));
  }
}

TEST_CASE("Where base and damper are tuned alike the optimum is flat, in the middle of what sticks",
          "[numbers]") {
  RandomSystems draw(13);
  int flat = 0;
  for (int i = 0; i < 60; ++i) {
    StudyRun run;
    SystemParameters& s = run.system;
    s = draw.ring(3, 60);
    s.mass_ratio = draw.log_uniform(0.5, 50);
    s.frequency_ratio = 1;
    s.interface_stiffness = draw.log_uniform(10, 1e5);
    s.base_damping = s.damper_damping = draw.log_uniform(1e-5, 1e-2);
    const FrictionSystem system = build_system(s);
    const double resonance =
        joined_frequencies({&system.base, &system.damper}, system.contact_stiffness).front();
    const double border = problems::ResponseSlopes::on_border(system, resonance).preload();
    run.range = {border * draw.log_uniform(1e-3, 0.5),
                 border * draw.log_uniform(2, 1e3),
                 0.5 * resonance,
                 1.2 * resonance,
                 {}};
    CAPTURE(i, describe(run));
    const PreloadStudy study = problems::study_preload(run.system, run.range);
    REQUIRE(study.optimum);
    if (i < 6) CHECK(OptimumJudge(run, study, {}).complaints() == no_complaints);
    const double Y = study.optimum->peak.Y;
    const auto last =
        std::find_if(study.branches.begin(), study.branches.end(),
                     [](const problems::PeakBranch& branch) { return branch.back().is_global; });
    REQUIRE(last != study.branches.end());
    const bool is_flat = study.optimum->kind == problems::OptimumKind::flat;
    CHECK(is_flat == (last->back().Y <= Y * (1 + 1e-9)));
    if (is_flat) ++flat;
  }
  CHECK(flat > 40);
}
