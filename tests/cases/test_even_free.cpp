// Limit cycles and nonlinear modes with the mean and even harmonics: against those in odd ones where nothing
// calls for more, against a motion in time, and their derivatives.

#include <fmt/format.h>

#include <string>

#include "arcslip/continuation/problem/derivative_check.hpp"
#include "case_runs.hpp"
#include "case_texts.hpp"
#include "temporary_folder.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// Three masses, of which the first and the last are joined a little.
class Masses {
 public:
  Masses() {
    const std::string head = "%%MatrixMarket matrix array real symmetric\n3 3\n";
    folder_.write("m.mtx", head + "1\n0\n0\n1\n0\n1\n");
    folder_.write("k.mtx", head + "1\n0\n0.2\n2\n0\n1.5\n");
  }

  /// C = zeta_B/(pi eta_0) K, eta_0 = 1/(2 pi).
  TracedBranch traced(const std::string& contact_stiffness, const std::string& harmonics,
                      const std::string& elements, const std::string& branch) const {
    const std::string text = fmt::format(
        "[system]\nmodel = \"sector\"\ncontact_stiffness = [{}, 0, 0]\npreload = 1.0\ndamping.base = 1e-2\n"
        "harmonics = {}\nreduction_window = [0.01, 3.0]\n[system.base]\nmass = \"m.mtx\"\n"
        "stiffness = \"k.mtx\"\ncontact = [1, 2, 3]\ndamping_kind = \"viscous\"\n"
        "reference_frequency = 0.15915494309189535\nload = {{ dof = [1], value = [1.0] }}\n{}[branch]\n{}",
        contact_stiffness, harmonics, elements, branch);
    const Case input = read_case(folder_.write("case.toml", text));
    std::vector<TracedBranch> all = trace(input.branches[0]);
    INFO(all.front().branch.explanation);
    REQUIRE(all.front().branch.complete());
    return std::move(all.front());
  }

 private:
  TemporaryFolder folder_;
};

const std::string over_zeta =
    "response = \"limit_cycle\"\nparameter = \"zeta_B\"\nstart = -2e-2\nfrom = -1.5e-2\nto = -3e-2\n";
const std::string over_R =
    "response = \"nonlinear_mode\"\nparameter = \"R\"\nfrom = 1e-3\nto = 5.0\neta = 0.2\n";

/// The first mass rubs as the last one presses it, and lifts off.
const std::string that_lifts_off =
    "[[element]]\nkind = \"friction\"\nat = \"base\"\ncontact = 1\nnormal = 3\ntangential_stiffness = 0.6\n"
    "normal_stiffness = 0.8\nmu = 0.5\nnormal_per_preload = 1.0\n";
const std::string one_stop =
    "[[element]]\nkind = \"unilateral\"\nat = \"base\"\ncontact = 3\nstiffness = 1.0\ngap = ";

}  // namespace

TEST_CASE("Cycles and modes beside a stop that is never met are those in odd harmonics", "[even]") {
  const Masses masses;
  for (const auto& [branch, place] : {std::pair(over_zeta, -0.025), std::pair(over_R, 3.0)}) {
    const std::string text = branch + fmt::format("[continuation]\nstop_at = [{}]\n", place);
    const TracedBranch odd = masses.traced("0.6", "[1, 3]", "", text);
    const TracedBranch even = masses.traced("0.6", "3", one_stop + "1e3\n", text);
    const auto expected = points(odd, PointType::user);
    const auto found = points(even, PointType::user);
    REQUIRE(expected.size() == 1);
    REQUIRE(found.size() == 1);
    for (const char* name : {"eta", "Y", "R_over_S", "dissipated", "R_h3"})
      CHECK_THAT(value(even, found[0], name), WithinRel(value(odd, expected[0], name), 1e-8));
    CHECK_THAT(value(even, found[0], "R_h0"), WithinAbs(0, 1e-12));
    if (branch == over_R)
      CHECK_THAT(value(even, found[0], "zeta"), WithinRel(value(odd, expected[0], "zeta"), 1e-8));
  }
}

TEST_CASE("Cycles and modes that lift off have exact derivatives", "[even]") {
  const Masses masses;
  for (const std::string& branch : {over_zeta, over_R}) {
    const TracedBranch traced = masses.traced("0", "3", that_lifts_off + one_stop + "0.2\n", branch);
    const continuation::Problem& problem = traced.problem();
    const std::vector<BranchPoint>& all = traced.branch.points;
    int near = 0;
    for (const BranchPoint& point : {all[all.size() / 2], all[all.size() - 2]}) {
      CHECK(point.residual < 1e-9);
      const auto report =
          continuation::check_derivatives(problem, point.unknowns, point.parameters, point.regime);
      if (report.worst > 1e-6) ++near;  // beside a transition
    }
    CHECK(near <= 1);
  }
}

TEST_CASE("A mode of friction in a plane of which one direction never moves is one of friction in one",
          "[even][plane]") {
  const Masses masses;
  const std::string plane = replaced(that_lifts_off, "\"friction\"\n", "\"friction_2d\"\nsecond = 2\n");
  const std::string text = over_R + "[continuation]\nstop_at = [2.0]\n";
  const TracedBranch expected = masses.traced("0", "3", that_lifts_off, text);
  const TracedBranch found = masses.traced("0", "3", plane, text);
  for (const char* name : {"eta", "zeta", "Y", "R_h0", "R_h2"})
    CHECK_THAT(value(found, points(found, PointType::user)[0], name),
               WithinRel(value(expected, points(expected, PointType::user)[0], name), 1e-8));
}
