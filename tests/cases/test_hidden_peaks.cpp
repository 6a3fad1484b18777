// Curves of peaks where rounding hides how they run: on folds, right beside corners, and on the border of
// stick.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "arcslip/cases/runs.hpp"
#include "branches.hpp"
#include "case_runs.hpp"
#include "case_texts.hpp"
#include "catch.hpp"
#include "peak_curves.hpp"
#include "places.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::PointType;

TEST_CASE("Y turns once where a ridge turns over the preload, though rounding hides how", "[cases]") {
  // There dY = (dY/dP) dP, so that both turn at one place, and slopes beside it are rounding.
  for (const std::array<double, 3>& setting :
       {std::array{2.131228021269089, 12.063452697019208, 3.052027154277806e-05},
        std::array{0.6862948623672506, 1.236160013680685, 0.0006051745585799982},
        std::array{2.50432710844117, 2.552638041346876, 7.465653879842023e-05},
        std::array{5.798640078252716, 5.115365308196671, 9.005653568863891e-05},
        std::array{3.716397083493467, 1.7334878103251132, 0.0033778375683849375},
        std::array{5.0, 4.0, 0.00012338007011604166}}) {
    for (const double longest : {0.1, 0.031}) {
      CAPTURE(setting, longest);
      const Case input = read_case(source_folder() + "/problems/ridge.toml",
                                   {fmt::format("system.mass_ratio={}", setting[0]),
                                    fmt::format("system.frequency_ratio={}", setting[1]),
                                    fmt::format("system.damping.base={}", setting[2]),
                                    fmt::format("continuation.max_step={}", longest)});
      int folds = 0;
      for (const TracedBranch& curve : trace(input.branches.front())) {
        const std::vector<BranchPoint> extrema = extrema_along(curve.branch);
        for (std::size_t i = 1; i < extrema.size(); ++i)
          CHECK(std::abs(extrema[i].arclength - extrema[i - 1].arclength) > 1e-7);
        for (const BranchPoint& fold : of_type(curve.branch, PointType::fold)) {
          ++folds;
          const auto is_there = [&](const BranchPoint& extremum) {
            return std::abs(extremum.arclength - fold.arclength) < 1e-9;
          };
          CHECK(std::count_if(extrema.begin(), extrema.end(), is_there) == 1);
        }
      }
      CHECK(folds > 0);
    }
  }
}

TEST_CASE("A curve of peaks goes on where a trough right beside its peak vanishes with it on a corner",
          "[cases]") {
  // The slope goes with the root of the way from the corner and through zero 1e-12 beside it: there the peak,
  // and what hides it, are told by a jump of the slope alone.
  struct Hidden {
    std::vector<std::string> settings;
    double preload;            // at which the curve is met three times
    double low, high;          // eta there
    std::size_t corner_folds;  // on the curve
  };
  const auto hidden =
      GENERATE(Hidden{{"system.mass_ratio=0.8878229187107564", "system.frequency_ratio=5.9250664686373",
                       "system.damping.base=0.00013166826601308524"},
                      0.26,
                      2.576,
                      2.577,
                      2},
               Hidden{{"system.mass_ratio=1.3575910411768064", "system.frequency_ratio=6.319428031159586",
                       "system.damping.base=0.0009654791892595209"},
                      0.135,
                      2.614,
                      2.615,
                      2},
               Hidden{{"system.mass_ratio=3.4260815668767317", "system.frequency_ratio=2.8217823347855058",
                       "system.damping.base=0.0003275310371330198"},
                      1.9,
                      2.4219,
                      2.4221,
                      3});
  std::vector<std::string> settings = hidden.settings;
  settings.push_back("system.harmonics=3");
  settings.push_back(fmt::format("continuation.stop_at=[{}]", hidden.preload));
  const Case input = read_case(source_folder() + "/problems/ridge.toml", settings);
  const TracedBranch traced = trace(input.branches.front()).front();
  const Branch& curve = traced.branch;
  CHECK(curve.complete());
  CHECK(of_type(curve, PointType::corner_fold).size() == hidden.corner_folds);
  CHECK(curve.points.front().parameters(0) + curve.points.back().parameters(0) == 100.1);  // from 0.1 to 100

  CaseBranch response = seed_branch(input.branches.front());
  response.problem.system.preload = hidden.preload;
  response.options.from = hidden.low - 0.02;
  response.options.to = hidden.high + 0.02;
  const std::vector<BranchPoint> extrema = extrema_along(trace(response).front().branch);
  std::vector<double> met;
  for (const BranchPoint& point : of_type(curve, PointType::user)) {
    const double eta = traced.curve->split(point.unknowns, point.parameters, point.regime).parameters(0);
    if (eta > hidden.low && eta < hidden.high) met.push_back(eta);
  }
  std::sort(met.begin(), met.end());
  REQUIRE(extrema.size() == 3);
  REQUIRE(met.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) CHECK_THAT(met[i], WithinRel(extrema[i].parameters(0), 1e-9));
}

TEST_CASE("A peak goes on where its response all but touches the border of stick", "[cases]") {
  // Y and R have their greatest values at nearly one eta, and in slip the slope goes with the root of R/S
  // - 1.
  struct Touch {
    std::vector<std::string> settings;
    std::vector<double> preloads;  // on both sides of where it goes through the border
  };
  const auto touch = GENERATE(
      Touch{{"system.interface_stiffness=0.49453671263963633", "system.mass_ratio=1.2328327405583779",
             "system.frequency_ratio=9.76761453763895", "system.damping.base=0.00015564539024409856"},
            {0.33, 0.3415, 0.3416, 0.36}},
      Touch{{"system.interface_stiffness=5.730507961319129", "system.mass_ratio=0.5717144776704769",
             "system.frequency_ratio=12.063131775092062", "system.damping.base=0.00016281026805490506"},
            {5.0, 5.349, 5.35, 6.0}},
      Touch{{"system.interface_stiffness=1.757639165721114", "system.mass_ratio=0.30224317541347906",
             "system.frequency_ratio=10.816648843875363", "system.damping.base=2.1680721825216223e-05"},
            {25.0, 28.97, 28.98, 29.0}},
      Touch{{"system.interface_stiffness=2.285932646635479", "system.mass_ratio=6.0970281249752185",
             "system.frequency_ratio=6.940639029139354", "system.damping.base=5.212334878824391e-05",
             "system.harmonics=3"},
            {1.8, 1.8898, 1.8899, 2.0}});
  std::vector<std::string> settings = touch.settings;
  settings.push_back(fmt::format("continuation.stop_at=[{}]", fmt::join(touch.preloads, ", ")));
  const Case input = case_texts::read_text(R"([system]
model = "rods"
wave_number = 1
elements = 30
damping = { damper = 1e-4 }
force = 1.0
preload = 1.0
[branch]
curve = "peak"
parameters = ["eta", "P"]
window = [0.3, 60.0]
from = 0.1
to = 30.0
)",
                                           settings);
  CHECK(check_peaks_met(input.branches.front(), trace(input.branches.front())) == touch.preloads.size());
}
