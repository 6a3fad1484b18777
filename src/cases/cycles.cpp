#include "cases/cycles.hpp"

#include <algorithm>
#include <chrono>

#include "arcslip/continuation/cycles/settled_cycle.hpp"
#include "arcslip/continuation/cycles/torus_branch.hpp"
#include "cases/curves.hpp"

namespace arcslip {
namespace {

using continuation::Branch;
using continuation::CycleBranch;
using continuation::CycleProblem;
using continuation::CycleStart;
using continuation::EquilibriumField;
using continuation::Field;
using continuation::OrbitProblem;
using continuation::OrbitStart;
using continuation::TimeBudget;
using Clock = std::chrono::steady_clock;

std::shared_ptr<const Field> field_of(const std::shared_ptr<const continuation::Problem>& problem) {
  if (const auto cycles = std::dynamic_pointer_cast<const CycleProblem>(problem))
    return cycles->shared_field();
  return std::make_shared<EquilibriumField>(problem);
}

/// As results have them; the time that they took is shared.
template <class OneBranch>
std::vector<TracedBranch> told(const Request& request, std::vector<OneBranch> branches,
                               Clock::time_point begun) {
  const std::chrono::duration<double> seconds = Clock::now() - begun;
  std::vector<TracedBranch> traced;
  for (OneBranch& one : branches) {
    Built built;
    built.problem = one.problem;
    traced.push_back({request, std::move(built), nullptr, std::move(one.branch),
                      seconds.count() / static_cast<double>(branches.size())});
  }
  return traced;
}

/// The cycles and, where they are asked for, the tori that leave them.
std::vector<TracedBranch> with_tori(const Request& request, std::vector<CycleBranch> cycles,
                                    Clock::time_point begun, const TimeBudget& time,
                                    const continuation::Observer& observer) {
  std::vector<continuation::TorusBranch> tori;
  if (request->cycles.options.tori && request->switching)
    tori = trace_tori_leaving(cycles, time.rest(), request->cycles.options, observer);
  const Clock::time_point left = Clock::now();
  std::vector<TracedBranch> all = told(request, std::move(cycles), begun);
  for (TracedBranch& one : told(request, std::move(tori), left)) all.push_back(std::move(one));
  return all;
}

}  // namespace

const continuation::Torus* torus_of(const TracedBranch& traced) {
  return traced.curve ? nullptr : dynamic_cast<const continuation::Torus*>(traced.base.problem.get());
}

const continuation::PeriodicOrbit* cycles_of(const TracedBranch& traced) {
  return traced.curve ? nullptr : dynamic_cast<const continuation::PeriodicOrbit*>(traced.base.problem.get());
}

const OrbitProblem* orbits_of(const TracedBranch& traced) {
  return traced.curve ? nullptr : dynamic_cast<const OrbitProblem*>(traced.base.problem.get());
}

bool has_orbits_alone(const CaseBranch& request) {
  return request.problem.model != nullptr && request.problem.model->orbit;
}

bool asks_for_cycles(const CaseBranch& request) {
  return request.cycles.settle || (request.problem.model != nullptr && request.problem.model->is_driven);
}

bool may_leave_cycles(const continuation::Problem& problem) {
  return problem.is_equilibrium() && problem.switch_count() == 0 && problem.size() > 1;
}

std::vector<TracedBranch> cycles_leaving(const std::vector<TracedBranch>& traced, const TimeBudget& time,
                                         const continuation::Observer& observer) {
  if (traced.empty() || is_unfinished(traced.back().branch.stop)) return {};
  const Clock::time_point begun = Clock::now();
  const CaseBranch& request = *traced.front().request;
  std::vector<Branch> equilibria;
  for (const TracedBranch& one : traced) equilibria.push_back(one.branch);
  return with_tori(traced.front().request,
                   trace_cycles_leaving(field_of(traced.front().base.problem), equilibria, time.rest(),
                                        request.cycles.options, observer),
                   begun, time, observer);
}

std::vector<TracedBranch> trace_settled_cycles(const Request& request, const Subject& subject,
                                               const TimeBudget& time,
                                               const continuation::Observer& observer) {
  const Clock::time_point begun = Clock::now();
  const std::shared_ptr<const Field> field = field_of(subject.built.problem);
  const Vector& p = subject.guess.parameters;
  std::vector<CycleBranch> branches;
  try {
    CycleStart start =
        settled_cycle(field, subject.guess.unknowns.head(field->size()), p, request->cycles.settle,
                      request->cycles.options, [&] { return time.goes_on(); });
    start.both_ways = request->start.has_value();
    const continuation::TraceOptions options = time.rest();
    if (request->switching) {
      branches = trace_connected_cycles(start, options, request->cycles.options, observer);
    } else {
      branches.push_back(trace_cycles(start, options, request->cycles.options, observer));
    }
  } catch (const std::invalid_argument& error) {
    return {unstarted(request, subject, error.what())};
  } catch (const continuation::Unfinished& error) {
    Subject ended = subject;
    ended.stop = error.stop;
    return {unstarted(request, ended, error.what())};
  }
  return with_tori(request, std::move(branches), begun, time, observer);
}

std::vector<TracedBranch> trace_from_orbit(const Request& request, const Subject& subject,
                                           const TimeBudget& time, const continuation::Observer& observer) {
  const Clock::time_point begun = Clock::now();
  problems::LibraryModel::Values values;
  for (const Setting& setting : request->problem.model->settings) {
    const bool varies = setting.name == request->options.parameter;
    values.push_back(varies ? request->start.value_or(request->options.from)
                            : fixed_value(request->problem, setting.name));
  }
  OrbitStart start;
  try {
    start = request->problem.model->orbit(values, request->cycles.options, request->cycles.settle);
  } catch (const std::invalid_argument& error) {
    return {unstarted(request, subject, error.what())};
  }
  start.both_ways = request->start.has_value();
  const continuation::TraceOptions options = time.rest();
  if (request->switching)
    return told(request, trace_connected_orbits(start, options, request->cycles.options, observer), begun);
  return told(request, std::vector{trace_orbits(start, options, request->cycles.options, observer)}, begun);
}

}  // namespace arcslip
