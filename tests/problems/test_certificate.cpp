// Proofs of traced branches: right ones are certified, wrong ones refused where they are wrong.

#include "arcslip/problems/proof/certificate.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "arcslip/cases/certification.hpp"
#include "case_runs.hpp"
#include "catch.hpp"
#include "paper_cases.hpp"
#include "program.hpp"
#include "random_systems.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Branch;
using problems::Certificate;
using problems::ForcedResponse;

namespace {

/// Beams of figure 8 at P = 1, by default as they are; with zeta_B = -0.01 the branch has four folds.
struct Traced {
  explicit Traced(double base_damping = 1e-4, double to = 20)
      : problem([&] {
          SystemParameters s = figure_8(1);
          s.base_damping = base_damping;
          return build_system(s);
        }()),
        branch(trace_over_eta(problem, 1, 0.5, to)) {}

  Certificate certify(const problems::CertificateOptions& options = {}) const {
    return problems::certify(problem, branch, ForcedResponse::eta, options);
  }
  /// The first point beyond this eta.
  std::size_t beyond(double eta) const {
    std::size_t i = 0;
    while (branch.points[i].parameters(0) <= eta) ++i;
    return i;
  }
  auto at(std::size_t i) { return branch.points.begin() + static_cast<std::ptrdiff_t>(i); }

  ForcedResponse problem;
  Branch branch;
};

/// That the first segment that is not proven is this one, for a reason that has this text in it.
void check_gap(const Certificate& certificate, std::size_t point, const std::string& reason) {
  REQUIRE(certificate.gap);
  CHECK(certificate.gap->point == point);
  CHECK_THAT(certificate.gap->reason, ContainsSubstring(reason));
}

}  // namespace

TEST_CASE("The branches of figure 8, of the rods and over the preload are proven, in few boxes",
          "[certificate]") {
  const std::string name = GENERATE("figure_8", "rods", "preload_response");
  Run run(name);
  REQUIRE(run.traced.size() == 5);
  for (TracedBranch& traced : run.traced) {
    certify(traced);
    const Certificate& certificate = *traced.certificate;
    INFO(name << ": " << (certificate.gap ? certificate.gap->reason : ""));
    CHECK(certificate.proven());
    CHECK(certificate.single_valued);
    CHECK(certificate.turns.empty());
    CHECK(certificate.from == traced.request->options.from);
    CHECK(certificate.to == traced.request->options.to);
    CHECK(certificate.boxes >= std::ssize(traced.branch.points) - 2);  // a switch may be a peak too
    CHECK(certificate.boxes < 6 * std::ssize(traced.branch.points));
  }
}

TEST_CASE("Each fold under negative damping is proven to lie within a narrow range", "[certificate]") {
  const Traced traced(-1e-2);
  const Certificate certificate = traced.certify();
  CHECK(certificate.proven());
  CHECK_FALSE(certificate.single_valued);
  const auto folds = of_type(traced.branch, PointType::fold);
  REQUIRE(folds.size() == 4);
  REQUIRE(certificate.turns.size() == 4);
  for (std::size_t i = 0; i < folds.size(); ++i) {
    const problems::Turn& turn = certificate.turns[i];
    const double eta = folds[i].parameters(0);
    CHECK(turn.certain);
    CHECK(turn.low <= eta);
    CHECK(eta <= turn.high);
    CHECK(turn.high - turn.low < 1e-5 * eta);
  }
}

TEST_CASE("A corner at which the response turns back is named as not proven, one that it passes is proven",
          "[certificate]") {
  // Just beyond the negative damping at which slip begins to lose less than it takes
  // (test_friction_folds.cpp).
  SystemParameters s = rods(1);
  s.interface_stiffness = 100;
  s.base_damping = -1;
  s.base_damping_kind = DampingKind::structural;
  s.fixed_damper = true;
  const FrictionSystem unit = build_system(s);
  const Mode mode = unit.base.modes().at(0);
  const double threshold = -std::numbers::pi / 8 * std::norm(mode.load_residue / unit.slip_threshold(4, 1)) /
                           (unit.contact_stiffness * mode.residue * mode.frequency * mode.frequency);
  const bool turns = GENERATE(false, true);
  s.base_damping = (turns ? 1.1 : 0.9) * threshold;
  const ForcedResponse problem(build_system(s));
  const Branch branch = trace_over_eta(problem, 1, 2, 8);
  const Certificate certificate = problems::certify(problem, branch, ForcedResponse::eta);
  const auto corners = of_type(branch, PointType::corner_fold);
  REQUIRE(corners.size() == (turns ? 2 : 0));
  CHECK(certificate.proven() == !turns);
  if (!turns) return;
  REQUIRE(certificate.gap);
  const double end = branch.points[certificate.gap->point + 1].parameters(0);
  CHECK((end == corners[0].parameters(0) || end == corners[1].parameters(0)));
}

TEST_CASE("The branch of a sector with one contact is proven as that of the ring it is cut from",
          "[certificate]") {
  const TemporaryFolder folder;
  REQUIRE(arcslip_program("sector beams --wave-number 1 -o '" + folder.path("beams") + "'").status == 0);
  const Outcome outcome = arcslip_program("run '" + folder.path("beams/case.toml") + "' --certify -o '" +
                                          folder.path("out") + "'");
  INFO(outcome.out << outcome.err);
  CHECK(outcome.status == 0);
  const auto summary = nlohmann::json::parse(read(folder.path("out/summary.json")));
  CHECK(summary["branches"][0]["certificate"]["proven"] == true);
}

TEST_CASE("A point moved by 1e-6 is refused", "[certificate]") {
  Traced traced(GENERATE(1e-4, -1e-2));
  const std::size_t i = traced.beyond(3.8);
  SECTION("in R") {
    traced.branch.points[i].unknowns(0) += 1e-6;
    check_gap(traced.certify(), i - 1, "|g| =");
  }
  SECTION("in eta") {
    traced.branch.points[i].parameters(0) *= 1 + 1e-6;
    check_gap(traced.certify(), i - 1, "|g| =");
  }
}

TEST_CASE("Two points exchanged are refused", "[certificate]") {
  Traced traced(GENERATE(1e-4, -1e-2));
  const std::size_t i = traced.beyond(3.8);
  std::swap(traced.branch.points[i], traced.branch.points[i + 1]);
  check_gap(traced.certify(), i, "turns back without a fold");
}

TEST_CASE("A branch that lacks a stretch is refused", "[certificate]") {
  Traced traced;
  const std::size_t first = traced.beyond(3.5);
  traced.branch.points.erase(traced.at(first), traced.at(traced.beyond(3.8)));
  check_gap(traced.certify(), first - 1, "longer than a step");
}

TEST_CASE("A jump past two folds is refused, however long steps may be", "[certificate]") {
  Traced traced(-1e-2);
  const auto folds = of_type(traced.branch, PointType::fold);
  // From the piece before the first fold to that beyond the second, at about the same eta.
  const double eta = 0.5 * (folds[0].parameters(0) + folds[1].parameters(0));
  const std::size_t first = traced.beyond(eta);
  std::size_t last = traced.branch.points.size() - 1;
  while (traced.branch.points[last].parameters(0) > eta) --last;
  REQUIRE(last > first + 2);
  traced.branch.points.erase(traced.at(first), traced.at(last + 1));
  check_gap(traced.certify({.max_step = 100}), first - 1, "a fold within");
}

TEST_CASE("A branch of fewer than two points proves nothing", "[certificate]") {
  Traced traced;
  traced.branch.points.resize(1);
  check_gap(traced.certify(), 0, "no second point");
  traced.branch.points.clear();
  check_gap(traced.certify(), 0, "no point");
}

TEST_CASE("Branches of random passive systems are proven, stiff and soft, of any damping",
          "[certificate][random]") {
  RandomSystems draw(2024);
  long points = 0, boxes = 0;
  for (int i = 0; i < 40; ++i) {
    SystemParameters s = draw.system();
    s.preload = draw.log_uniform(1e-4, 1);
    s.preload_growth = draw.integer(0, 1) == 0 ? 0 : s.preload * draw.log_uniform(1e-3, 1);
    const ForcedResponse problem(build_system(s));
    const auto [from, to] = resonance_range(s);
    const Branch branch = trace_over_eta(problem, s.preload, from, to);
    const Certificate certificate = problems::certify(problem, branch, ForcedResponse::eta);
    INFO(i << ": " << (certificate.gap ? certificate.gap->reason : ""));
    CHECK(certificate.proven());
    CHECK(certificate.single_valued);
    points += std::ssize(branch.points);
    boxes += certificate.boxes;
  }
  CHECK(boxes < 10 * points);
}

TEST_CASE("arcslip run --certify tells what is proven, in its output and in summary.json", "[certificate]") {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& name, const std::string& options = "") {
    return arcslip_program("run '" + case_named(name) + "' --certify " + options + " -o '" +
                           folder.path("out") + "'");
  };
  const Outcome outcome = run("figure_8", "--set branch.for_each.preload=[1.0]");
  CHECK(outcome.status == 0);
  CHECK(outcome.err.empty());
  CHECK_THAT(outcome.out,
             ContainsSubstring("branch 0: certified: no fold, no jump between eta = 0.5 and 120 ("));
  CHECK_THAT(outcome.out, ContainsSubstring("no other solution"));
  const auto summary = nlohmann::json::parse(read(folder.path("out/summary.json")));
  const auto& certificate = summary["branches"][0]["certificate"];
  CHECK(certificate["proven"] == true);
  CHECK(certificate["single_valued"] == true);
  CHECK(certificate["boxes"] > 100);
  // Points that no enclosure shows to be as good as they are to be.
  const Outcome strict =
      run("figure_8", "--set branch.for_each.preload=[1.0] --set continuation.tolerance=1e-14");
  CHECK(strict.status == 3);
  CHECK_THAT(strict.err, ContainsSubstring("branch 0: not certified: the segment from point "));
}

TEST_CASE("What --certify does not cover is refused in one line before anything runs", "[certificate]") {
  const auto [name, settings, reason] = GENERATE(table<std::string, std::string, std::string>(
      {{"enz", "", "the model enz, whose"},
       {"ridge", "", "a curve of peak points, which"},
       {"limit_cycle", "", "limit cycles, whose"},
       {"one_way", "", "one-way responses, from which"},
       {"cubic_response", "", "cubic springs, which"},
       {"cubic_fold_curve", "", "a curve of fold points, which"},
       {"figure_8", " --set branch.stability=true", "with stability: exponents are"},
       {"figure_8", " --set system.harmonics=3", "several harmonics, each of which"},
       {"figure_8", " --set system.harmonics='\"auto\"'", "several harmonics, each of which"}}));
  INFO(name << settings);
  const TemporaryFolder folder;
  const Outcome outcome = arcslip_program("run '" + case_named(name) + "' --certify" + settings + " -o '" +
                                          folder.path("out") + "'");
  CHECK(outcome.status == 1);
  CHECK(is_one_line(outcome.err));
  CHECK_THAT(outcome.err, ContainsSubstring("--certify is for") && ContainsSubstring(reason));
  CHECK(names_in(folder.path("")).empty());
}
