// One passive contact in one harmonic has one response at each (eta, P), whatever its slip threshold is.

#include <fmt/format.h>

#include "catch.hpp"
#include "paper_cases.hpp"
#include "random_systems.hpp"

using namespace arcslip;
using namespace arcslip::testing;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::PointType;
using problems::ForcedResponse;

namespace {

/// Passive, with a preload that grows with the speed: at the base's resonance by a factor from 1 to 1e3.
SystemParameters passive(RandomSystems& draw) {
  SystemParameters s = draw.system();
  s.preload = draw.log_uniform(1e-4, 1);  // around what sticks and slips under a force of 1
  const double base = resonance_range(s).second / 5;
  s.preload_growth = s.preload * draw.log_uniform(1e-2, 1e3) / (base * base);
  s.base_damping_kind = draw.integer(0, 1) == 0 ? DampingKind::viscous : DampingKind::structural;
  s.fixed_damper = draw.integer(0, 4) == 0;
  return s;
}

/// What the branch has and a unique response has not.
std::vector<std::string> folds_of(const Branch& branch) {
  std::vector<std::string> found;
  if (!branch.complete()) found.push_back(branch.explanation);
  for (const BranchPoint& point : branch.points) {
    if (point.type != PointType::fold && point.type != PointType::corner_fold) continue;
    found.push_back(fmt::format("{} at eta = {:.15g}, P = {:.15g}", to_string(point.type),
                                point.parameters(0), point.parameters(1)));
  }
  return found;
}

}  // namespace

TEST_CASE("No branch of a passive contact folds, over eta or P, also with a preload that grows with eta",
          "[random]") {
  RandomSystems draw(1960);
  int switches = 0;
  for (int i = 0; i < 200; ++i) {
    const SystemParameters s = passive(draw);
    const ForcedResponse problem(build_system(s));
    const auto [from, to] = resonance_range(s);
    const double eta = draw.log_uniform(from, to);
    CAPTURE(i, s.preload, s.preload_growth, eta);
    const Branch branch = trace_over_eta(problem, s.preload, from, to);
    CHECK(folds_of(branch) == std::vector<std::string>{});
    switches += static_cast<int>(of_type(branch, PointType::regime_switch).size());
    continuation::TraceOptions over_preload;
    over_preload.parameter = "P";
    over_preload.from = 1e-6;
    over_preload.to = 1e6;
    CHECK(folds_of(continuation::trace(problem, problem.guess(eta, 1e-6), over_preload)) ==
          std::vector<std::string>{});
  }
  CHECK(switches > 300);  // more than one for each system: the threshold matters
}

TEST_CASE("A preload that grows with the speed sticks and slips anew, at the thresholds of its own") {
  SystemParameters parameters = figure_8(0.2);
  parameters.preload_growth = 0.1;
  const ForcedResponse problem(build_system(parameters));
  const auto switches = of_type(trace_over_eta(problem, 0.2, 0.5, 120), PointType::regime_switch);
  REQUIRE(switches.size() == 4);
  for (const BranchPoint& point : switches) {
    // The same motion as of a constant preload with this eta's value.
    const double eta = point.parameters(0);
    const double effective = 0.2 + 0.1 * eta * eta;
    const ForcedResponse constant(build_system(figure_8(effective)));
    const continuation::Guess guess = constant.guess(eta, effective);
    CHECK_THAT(guess.unknowns(0), WithinAbs(point.unknowns(0), 1e-7));  // steep near the peak
    CHECK_THAT(quantity(problem, point, ForcedResponse::S),
               WithinRel(effective * constant.system().slip_per_preload, 1e-14));
    CHECK_THAT(quantity(problem, point, ForcedResponse::R_over_S), WithinRel(1, 1e-9));
  }
}
