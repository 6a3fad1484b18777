// Curves of peaks over the preload, across the border of stick and corners within slip.

#include <cmath>
#include <map>

#include "arcslip/assembly/system.hpp"
#include "arcslip/cases/runs.hpp"
#include "arcslip/problems/ridges/response_slopes.hpp"
#include "arcslip/zero_between.hpp"
#include "branches.hpp"
#include "case_runs.hpp"
#include "case_texts.hpp"
#include "catch.hpp"
#include "peak_curves.hpp"
#include "places.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::BasePoint;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::PointType;

namespace {

const std::string rods_peaks = case_texts::rods_under_force + R"([branch]
curve = "peak"
parameters = ["eta", "P"]
window = [0.5, 5.0]
from = 0.3
to = 3.0
)";

}  // namespace

TEST_CASE("The peak of the rods comes to the border of stick where the slope in slip vanishes", "[cases]") {
  const Case input = case_texts::read_text(rods_peaks);
  const std::vector<TracedBranch> curves = trace(input.branches.front());
  REQUIRE(curves.size() == 2);
  for (const TracedBranch& curve : curves) CHECK(curve.branch.complete());
  const auto switches = of_type(curves[0].branch, PointType::regime_switch);
  REQUIRE(switches.size() == 1);

  // By closed slopes on the border.
  const FrictionSystem system = build_system(input.branches.front().problem.system);
  const auto slope = [&](double eta) {
    return problems::ResponseSlopes::on_border(system, eta).slipping().by_eta().log_Y;
  };
  const double eta = zero_between(slope, 1.27, 1.285, slope(1.27), slope(1.285));
  CHECK_THAT(switches[0].unknowns(1), WithinRel(eta, 1e-10));
  const double preload = problems::ResponseSlopes::on_border(system, eta).preload();
  CHECK_THAT(switches[0].parameters(0), WithinRel(preload, 1e-10));
  // From there it is a corner: R = S, and Y falls on both sides.
  for (const BranchPoint& point : curves[0].branch.points) {
    if (!(point.parameters(0) > preload * (1 + 1e-9))) continue;
    const auto border = problems::ResponseSlopes::on_border(system, point.unknowns(1));
    CHECK_THAT(border.preload(), WithinRel(point.parameters(0), 1e-9));
    CHECK(border.slipping().by_eta().log_Y * border.by_eta().log_Y < 0);
  }
}

TEST_CASE("Peaks of every contact's border are peaks of the responses", "[cases]") {
  for (const std::string settings : {"system.harmonics=1", "system.harmonics=5"}) {
    const Case input =
        case_texts::read_text(rods_peaks, {settings, "continuation.stop_at=[0.5, 1.9917, 2.5]"});
    const std::vector<TracedBranch> curves = trace(input.branches.front());
    REQUIRE(curves.size() == 2);
    REQUIRE(check_peaks_met(input.branches.front(), curves) == 3);
  }
}

TEST_CASE("A peak of three harmonics vanishes on a corner within slip and goes back as a trough", "[cases]") {
  const Case input = read_case(source_folder() + "/problems/ridge.toml",
                               {"system.harmonics=3", "system.preload=0.14", "branch.from=0.125",
                                "branch.to=0.14", "branch.window=[2.0, 3.0]"});
  const std::vector<TracedBranch> curves = trace(input.branches.front());
  REQUIRE(!curves.empty());
  std::vector<double> folds;
  for (const TracedBranch& curve : curves) {
    CHECK(curve.branch.complete());
    for (const BranchPoint& point : of_type(curve.branch, PointType::corner_fold))
      folds.push_back(point.parameters(0));
  }
  REQUIRE(folds.size() == 1);
  CHECK_THAT(folds[0], WithinRel(0.1300119914, 1e-8));  // where bisection on responses loses the peak
}

TEST_CASE("A peak that meets a trough turns once, though rounding hides how", "[cases]") {
  // The contact is so stiff that R runs through decades where Y all but stands still.
  const Case input = case_texts::read_text(R"([system]
model = "beams"
wave_number = 1
elements = 18
mass_ratio = 0.7908866647309086
frequency_ratio = 1.0
interface_stiffness = 43055794.98737376
damping = { base = 0.0014459122400466678, damper = 0.00039471375582047694 }
force = 1.0
preload = 0.1580924169812655
harmonics = 3
[branch]
curve = "peak"
parameters = ["eta", "P"]
window = [0.43135619248171664, 2.4761439223649298]
from = 0.0052697472327088496
to = 4.742772509437965
[continuation]
max_points = 130
)");
  const std::vector<TracedBranch> curves = trace(input.branches.front());
  REQUIRE(!curves.empty());
  const Branch& curve = curves[0].branch;
  std::vector<std::size_t> turns;
  for (std::size_t i = 0; i < curve.points.size(); ++i)
    if (curve.points[i].type == PointType::fold) turns.push_back(i);
  REQUIRE(turns.size() == 1);
  // Responses at 0.2158 have both, those at 0.2159 neither.
  CHECK_THAT(curve.points[turns[0]].parameters(0), WithinAbs(0.21585, 5e-5));
  CHECK(curve.points.back().parameters(0) < 0.2158);
}

TEST_CASE("An extremum is followed from response to response in long steps and back", "[cases]") {
  const Case input = case_texts::read_text(R"([system]
model = "rods"
wave_number = 5
elements = 32
mass_ratio = 0.2446331943812558
frequency_ratio = 0.4486144502268379
interface_stiffness = 35.32141466827884
damping = { base = 0.0009680411362445967, damper = 0.007223640282732534 }
force = 1.0
preload = 11.49700270681494
harmonics = 3
[branch]
curve = "peak"
parameters = ["eta", "P"]
window = [0.57, 4.0]
from = 0.39
to = 12.0
[continuation]
stop_at = [1.4]
)");
  const std::vector<TracedBranch> curves = trace(input.branches.front());
  REQUIRE(!curves.empty());
  CHECK(curves[0].branch.points.size() < 1000);
  // Where it meets a peak it goes back as that one, down to the first value.
  CHECK(curves[0].branch.complete());
  CHECK(curves[0].branch.points.front().parameters(0) == 0.39);
  CaseBranch response = seed_branch(input.branches.front());
  response.problem.system.preload = 1.4;
  const Branch at_value = trace(response).front().branch;
  const auto users = of_type(curves[0].branch, PointType::user);
  CHECK(users.size() == 3);  // a peak, the trough that it meets, and the peak that this one meets
  for (const PointType type : {PointType::peak, PointType::trough}) {
    const auto extrema = of_type(at_value, type);
    const auto is_passed = [&](const BranchPoint& user) {
      const double eta = curves[0].curve->split(user.unknowns, user.parameters, user.regime).parameters(0);
      return std::any_of(extrema.begin(), extrema.end(), [&](const BranchPoint& extremum) {
        return std::abs(eta / extremum.parameters(0) - 1) < 1e-8;
      });
    };
    CHECK(std::any_of(users.begin(), users.end(), is_passed));
  }
}

TEST_CASE("A peak passes the border of stick where its own amplitude tells it", "[cases]") {
  // To ground Y is R: the peak comes to R = S from the middle of slip, and nothing beside it on the border.
  const std::string settings = GENERATE("system.harmonics=1", "system.harmonics=5");
  const bool from_stick = GENERATE(false, true);
  const std::string ends = from_stick ? "branch.from=300" : "branch.from=0.2";
  const std::string other = from_stick ? "branch.to=0.2" : "branch.to=300";
  const Case input = case_texts::read_text(rods_peaks, {"system.fixed_damper=true", settings, ends, other,
                                                        "system.preload=1", "continuation.stop_at=[2, 60]"});
  const std::vector<TracedBranch> curves = trace(input.branches.front());
  std::size_t passing = 0;
  for (const TracedBranch& curve : curves) {
    CHECK(curve.branch.complete());
    const auto users = of_type(curve.branch, PointType::user);
    const auto switches = of_type(curve.branch, PointType::regime_switch);
    if (switches.empty()) continue;
    ++passing;
    // In stick neither eta nor height change with the preload, and S there is the height on the border.
    const BranchPoint& border = switches.back();
    const BranchPoint& stuck = from_stick ? curve.branch.points.front() : curve.branch.points.back();
    const BasePoint at_border = curve.curve->split(border.unknowns, border.parameters, border.regime);
    const BasePoint in_stick = curve.curve->split(stuck.unknowns, stuck.parameters, stuck.regime);
    CHECK_THAT(in_stick.parameters(0), WithinRel(at_border.parameters(0), 1e-8));
    CHECK_THAT(value(curve, stuck, "Y"), WithinRel(value(curve, border, "Y"), 1e-9));
    CHECK_THAT(value(curve, border, "R_over_S"), WithinRel(1, 1e-9));
    REQUIRE(users.size() == 2);
  }
  CHECK(passing >= 1);
}

TEST_CASE("Curves of peaks and folds pass those of responses in which the parts come apart", "[cases]") {
  const std::string type = GENERATE("peak", "fold");
  const std::string problems = source_folder() + "/problems/";
  std::string text = read(problems + "lift_off.toml");
  text.resize(text.find("[branch]"));
  for (const std::string matrix : {"mass", "stiffness", "damping"})
    text = replaced(text, "lift_off/" + matrix, problems + "lift_off/" + matrix);
  if (type == "fold")
    text += "[[element]]\nkind = \"cubic\"\nat = \"base\"\ncontact = 1\ncoefficient = 0.002\n";
  text += "[branch]\ncurve = \"" + type + "\"\nparameters = [\"eta\", \"P\"]\nwindow = [0.1, 0.3]\n";
  const Case input =
      case_texts::read_text(text + "from = 0.2\nto = 4\n[continuation]\nstop_at = [0.3, 0.4, 2.0]\n",
                            {"system.harmonics=3", "system.preload=0.5"});
  const std::vector<TracedBranch> curves = trace(input.branches.front());
  std::map<double, std::vector<double>> passed = etas_met(curves);
  std::size_t cusps = 0;
  for (const TracedBranch& curve : curves) cusps += of_type(curve.branch, PointType::cusp).size();
  CHECK(cusps == (type == "fold" ? 1 : 0));
  for (const double preload : {0.3, 0.4, 2.0}) {
    CaseBranch response = seed_branch(input.branches.front());
    response.problem.system.preload = preload;
    const PointType wanted = type == "fold" ? PointType::fold : PointType::peak;
    for (const BranchPoint& point : of_type(trace(response).front().branch, wanted)) {
      CAPTURE(type, preload, point.parameters(0));
      CHECK(std::any_of(passed[preload].begin(), passed[preload].end(),
                        [&](double eta) { return std::abs(eta / point.parameters(0) - 1) < 1e-9; }));
    }
  }
}
