#include "arcslip/continuation/cycles/cycle_branch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "arcslip/continuation/cycles/end_of_kind.hpp"
#include "arcslip/continuation/cycles/growth_watch.hpp"
#include "arcslip/continuation/cycles/mesh_watch.hpp"
#include "arcslip/continuation/cycles/orbit_mark.hpp"
#include "arcslip/continuation/path/watch.hpp"
#include "arcslip/continuation/points/branch_point_problem.hpp"
#include "arcslip/continuation/points/normal_form.hpp"

namespace arcslip::continuation {
namespace {

/// Refuses a mesh on which what leaves branch points is not held as well as the orbits themselves are.
void require_departures(const OrbitProblem& problem, const Branch& branch, const TraceOptions& options,
                        const OrbitOptions& orbits) {
  if (!problem.may_rest() || !may_be_finer(problem, orbits)) return;
  BranchPointProblem conditions(problem, index_of(problem.parameter_names(), options.parameter));
  for (const BranchPoint& point : branch.points) {
    if (point.type != PointType::branch_point) continue;
    if (!conditions.adapt({point.unknowns, point.parameters, point.regime, Vector::Zero(1)})) continue;
    const OrbitFrame& frame = problem.frame(point.regime);
    const Matrix ways = conditions.null_space();
    for (Index j = 0; j < ways.cols(); ++j) {
      const Matrix change = problem.orbit(ways.col(j));
      if (frame.mesh.errors(change, ranges(change, frame.scale)).maxCoeff() > orbits.tolerance)
        throw TooCoarse{};
    }
  }
}

/// Whether two branch points may lie near a point: of orbits at rest, where nothing bends and steps grow
/// beyond what lies between two, and of those with a multiplier near 1.
bool may_meet_two(const OrbitProblem& problem, const BranchPoint& point) {
  constexpr double near = 2;  // of ln(mu)
  if (problem.field().sparse()) return false;
  if (problem.may_rest()) {
    const Matrix orbit = problem.orbit(point.unknowns);
    return orbit.rowwise().maxCoeff() == orbit.rowwise().minCoeff();
  }
  const ComplexVector logs = problem.log_multipliers(point.unknowns, point.parameters, point.regime);
  return (logs.array().abs() < near).any();
}

/// One way; `begin` traces up to where the observer says no. Of a branch that leaves a branch point, which
/// cannot be corrected on the meshes that follow, the mark of this tells where it comes back.
template <class Begin>
Branch one_way(const OrbitProblem& problem, TraceOptions options, const OrbitOptions& orbits,
               const Observer& observer, const std::optional<OrbitMark>& left, const Begin& begin) {
  options.journal = nullptr;  // which has no meshes: the same work is done anew
  const bool is_told_of_pairs = options.branch_point_pairs.has_value();
  if (!is_told_of_pairs) options.branch_point_pairs = false;
  end_with_kind(problem, options);
  MeshWatch meshes(problem, orbits);
  GrowthWatch growth(problem, options.parameter, orbits.tolerance);
  bool worn = false;
  bool told = false;
  bool grows = false;
  bool turns = false;  // to look for pairs of branch points, or no longer to
  bool closes = false;
  const TimeBudget time(options);
  const Observer watching = [&](const BranchPoint& point) {
    told = observer && !observer(point);
    worn = !meshes.serves(point);
    grows =
        !growth.goes_on({point.unknowns, point.parameters, point.regime, {}}, point.type == PointType::fold);
    turns = !is_told_of_pairs && may_meet_two(problem, point) != *options.branch_point_pairs;
    closes = left && point.type == PointType::branch_point &&
             is_same(*left, mark_of(problem, point, index_of(problem.parameter_names(), options.parameter)));
    return !told && !worn && !grows && !turns && !closes;
  };
  Branch branch = begin(options, watching);
  while (branch.stop == Stop::interrupted && (worn || turns) && !told && !grows && !closes) {
    if (std::exchange(turns, false)) options.branch_point_pairs = !*options.branch_point_pairs;
    if (std::exchange(worn, false) && !meshes.renew(branch, options)) {
      meshes.give_up(branch, options.parameter);
      return branch;
    }
    TraceOptions rest = options;
    rest.max_seconds = time.rest().max_seconds;
    branch = go_on_with(problem, std::move(branch), rest, watching);
  }
  if (branch.stop == Stop::interrupted && closes && !told) {
    branch.points.back().type = PointType::end;
    branch.stop = Stop::closed_loop;
    branch.explanation = "the branch came back to its start";
    branch.checkpoint.reset();
  }
  require_departures(problem, branch, options, orbits);
  tell_end_of_kind(problem, problem, options.parameter, branch);
  if (branch.stop == Stop::interrupted && grows && !told) growth.end(branch);
  return branch;
}

OrbitBranch on_these_intervals(const OrbitStart& start, const TraceOptions& options,
                               const OrbitOptions& orbits, const Observer& observer) {
  const OrbitProblem& problem = *start.problem;
  std::optional<OrbitMark> left;
  if (start.both_ways && start.guess.direction.size() > 0)
    left = mark_of(problem, start.guess, index_of(problem.parameter_names(), options.parameter));
  const auto part = [&](bool towards_to) {
    return one_way(problem, options, orbits, observer, left,
                   [&](const TraceOptions& watched, const Observer& watching) {
                     return trace_one_way(problem, start.guess, towards_to, watched, watching);
                   });
  };
  if (!start.both_ways) return {start.problem, part(true)};
  return {start.problem, trace_parts([&] { return part(true); }, [&] { return part(false); }, start.guess)};
}

/// On a finer mesh, where a branch point that a branch leaves lies elsewhere, be it by 1e-8: beside it there
/// is nothing but the branch that it is known from.
OrbitStart on_finer_mesh(const OrbitStart& start, Index resolution, const std::string& parameter) {
  constexpr double near = 1e-3;
  OrbitStart finer = refined(start, resolution);
  if (!finer.both_ways || finer.guess.direction.size() == 0) return finer;
  const OrbitProblem& problem = *finer.problem;
  const Guess& at = finer.guess;
  BranchPointProblem conditions(problem, index_of(problem.parameter_names(), parameter));
  const auto located = locate(conditions, {at.unknowns, at.parameters, at.regime, Vector::Zero(1)});
  if (!located) return finer;
  Vector scale(problem.size());
  Vector parameter_scale(at.parameters.size());
  problem.scale(at.unknowns, at.parameters, scale, parameter_scale);
  const BasePoint& found = located->point;
  const bool is_there =
      (found.unknowns - at.unknowns).cwiseQuotient(scale).lpNorm<Eigen::Infinity>() < near &&
      (found.parameters - at.parameters).cwiseQuotient(parameter_scale).lpNorm<Eigen::Infinity>() < near;
  if (is_there) {
    finer.guess.unknowns = found.unknowns;
    finer.guess.parameters = found.parameters;
  }
  return finer;
}

}  // namespace

OrbitStart start_from(std::shared_ptr<const OrbitProblem> problem, const Matrix& orbit, double duration,
                      const Vector& p) {
  OrbitStart start{std::move(problem), {}};
  start.guess.unknowns.resize(start.problem->size());
  start.guess.unknowns.head(orbit.size()) = orbit.reshaped();
  if (start.problem->has_duration()) start.guess.unknowns.tail(1).setConstant(duration);
  start.guess.parameters = p;
  return start;
}

OrbitBranch trace_orbits(const OrbitStart& start, const TraceOptions& options, const OrbitOptions& orbits,
                         const Observer& observer) {
  const TimeBudget time(options);
  OrbitStart at = start;
  while (true) {
    try {
      return on_these_intervals(at, time.rest(), orbits, observer);
    } catch (const TooCoarse&) {
      at = on_finer_mesh(start, 2 * at.problem->resolution(), options.parameter);
    }
  }
}

CycleBranch cycle_branch(OrbitBranch branch) {
  return {std::dynamic_pointer_cast<const CycleProblem>(branch.problem), std::move(branch.branch)};
}

CycleBranch trace_cycles(const CycleStart& start, const TraceOptions& options, const CycleOptions& cycles,
                         const Observer& observer) {
  return cycle_branch(trace_orbits({start.problem, start.guess, start.both_ways}, options, cycles, observer));
}

}  // namespace arcslip::continuation
