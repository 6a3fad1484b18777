#include "cases/ring_amplification.hpp"

#include <algorithm>

#include "arcslip/assembly/whole_ring.hpp"
#include "arcslip/cases/runs.hpp"

namespace arcslip {
namespace {

const WholeRing* ring_of(const CaseBranch& branch) {
  return branch.problem.model != nullptr ? nullptr : structures_of(branch.problem.system).whole();
}

}  // namespace

bool tells_amplification(const CaseBranch& branch) {
  const WholeRing* ring = ring_of(branch);
  return ring != nullptr && ring->make().equal_peak.has_value();
}

std::shared_ptr<const CaseBranch> with_equal_peak(const CaseBranch& branch,
                                                  const continuation::TimeBudget& time) {
  const WholeRing& ring = *ring_of(branch);
  ProblemRequest equal = branch.problem;
  equal.system = ring.equal(equal.system);
  continuation::TraceOptions options = unwatched(time.rest());
  options.extrema_of = {"Y_max"};
  options.stop_at.clear();
  const Subject subject = build(equal, options.parameter, options.from, options);
  auto told = std::make_shared<CaseBranch>(branch);
  if (!subject.failure.empty()) return told;
  const continuation::Problem& problem = *subject.built.problem;
  const continuation::Branch traced = continuation::trace(problem, subject.guess, options);
  if (!traced.complete()) return told;
  const Index place = continuation::index_of(continuation::observable_names(problem), "Y_max");
  double highest = 0;
  Vector values;
  for (const continuation::BranchPoint& point : traced.points) {
    problem.observe(point.unknowns, point.parameters, point.regime, values);
    highest = std::max(highest, values(place));
  }
  told->problem.system = ring.told_over(told->problem.system, highest);
  return told;
}

}  // namespace arcslip
