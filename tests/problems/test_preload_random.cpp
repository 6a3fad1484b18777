// Preload studies of random systems against the dense scan: no peak is missed, none is invented, none that
// overtakes for a while goes unseen.

#include <tuple>

#include "catch.hpp"
#include "optimum_judge.hpp"
#include "random_systems.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using problems::PreloadRange;
using problems::PreloadStudy;

namespace {

/// Decades of preload below the one at which everything sticks, and a window round the base's resonance or
/// round all of them.
class RandomStudies {
 public:
  explicit RandomStudies(std::uint64_t seed) : draw_(seed) {}

  StudyRun run() {
    StudyRun run;
    SystemParameters& s = run.system;
    s = draw_.ring(6, 200);
    s.mass_ratio = draw_.log_uniform(0.2, 200);
    s.frequency_ratio = draw_.log_uniform(0.5, 8);
    s.interface_stiffness = draw_.log_uniform(1e2, 1e8);
    s.base_damping = draw_.log_uniform(1e-5, 1e-2);
    s.damper_damping = draw_.log_uniform(1e-5, 1e-2);
    s.fixed_damper = draw_.integer(0, 9) == 0;
    if (draw_.integer(0, 9) == 0) s.base_damping_kind = DampingKind::structural;
    const bool grows = draw_.integer(0, 9) == 0;

    PreloadRange& range = run.range;
    std::tie(range.eta_low, range.eta_high) = window(s);
    const dense::Response response(dense_case(s));
    dense::Real stuck = 0;
    for (const dense::Real x : dense::columns_of(response, {range.eta_low, range.eta_high}))
      stuck = std::max(stuck, response.at_ratio(x, 0, true).preload);
    range.from = static_cast<double>(stuck) * draw_.log_uniform(1e-7, 0.3);
    range.to = range.from * draw_.log_uniform(2, 1e5);
    if (grows) s.preload_growth = range.from * draw_.log_uniform(1e-3, 10);
    for (int i = 0; i < 3; ++i) range.stop_at.push_back(draw_.log_uniform(range.from, range.to));
    return run;
  }

 private:
  std::pair<double, double> window(const SystemParameters& s) {
    const auto n = static_cast<double>(s.wave_number);
    const double base = s.frequency_ratio * (s.model == StructureModel::rods ? n : n * n);
    switch (draw_.integer(0, 2)) {
      case 0: return resonance_range(s);
      case 1: return {base * draw_.uniform(0.3, 0.98), base * draw_.uniform(1.02, 2)};
      default: {
        const double low = base * draw_.log_uniform(0.2, 3);
        return {low, low * (1 + draw_.log_uniform(0.02, 3))};
      }
    }
  }

  RandomSystems draw_;
};

/// What is wrong at `stop_at`, at the ends of the range and along the highest peak.
std::vector<std::string> complaints(const StudyRun& run, std::size_t rows) {
  StudyJudge judge(run);
  for (const double preload : run.range.stop_at) judge.judge_at(preload);
  judge.judge_at(run.range.from);
  judge.judge_at(run.range.to);
  const std::vector<problems::Peak> global = judge.global_rows();
  for (std::size_t i = 0; i < global.size(); i += global.size() / rows + 1) judge.judge_global(global[i]);
  return judge.complaints();
}

}  // namespace

TEST_CASE("Studies of random systems hold all peaks that the dense scan finds", "[random]") {
  RandomStudies draw(20240607);
  for (int i = 0; i < 30; ++i) {
    const StudyRun run = draw.run();
    CAPTURE(i, describe(run));
    CHECK(complaints(run, 2) == no_complaints);
  }
}

TEST_CASE("The best preloads of random systems are those of the dense scan", "[random]") {
  RandomStudies draw(327);
  for (int i = 0; i < 8; ++i) {
    const StudyRun run = draw.run();
    CAPTURE(i, describe(run));
    const PreloadStudy study = problems::study_preload(run.system, run.range);
    CHECK(OptimumJudge(run, study, run.range.stop_at).complaints() == no_complaints);
  }
}

TEST_CASE("The judge sees a branch that is missing, a height that is off, and an optimum beside the optimum",
          "[random]") {
  StudyRun run;
  run.system.mass_ratio = 5;
  run.system.frequency_ratio = 4;
  run.system.interface_stiffness = shear_interface_stiffness(33.3, 0.3);
  run.range = {0.1, 100, 0.5, 6, {1.5}};
  const PreloadStudy right = problems::study_preload(run.system, run.range);
  const auto judged = [&](const PreloadStudy& study) {
    StudyJudge judge(run, study);
    judge.judge_at(1.5);
    return judge.complaints().empty();
  };
  CHECK(judged(right));
  for (std::size_t branch = 0; branch < right.branches.size(); ++branch) {
    PreloadStudy wrong = right;
    wrong.branches.erase(wrong.branches.begin() + static_cast<std::ptrdiff_t>(branch));
    CHECK_FALSE(judged(wrong));
    wrong = right;
    for (problems::Peak& peak : wrong.branches[branch]) peak.Y *= 1 + 1e-8;
    CHECK_FALSE(judged(wrong));
  }
  REQUIRE(right.optimum);
  CHECK(OptimumJudge(run, right, {}).complaints() == no_complaints);
  PreloadStudy wrong = right;
  wrong.optimum->peak.preload *= 1 + 1e-7;
  CHECK_FALSE(OptimumJudge(run, wrong, {}).complaints().empty());
  wrong = right;
  wrong.optimum->high *= 1 + 1e-7;
  CHECK_FALSE(OptimumJudge(run, wrong, {}).complaints().empty());
}
