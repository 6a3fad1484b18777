#include "arcslip/cases/runs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "arcslip/assembly/resonances.hpp"
#include "arcslip/assembly/structures.hpp"
#include "arcslip/continuation/path/switching.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "arcslip/problems/response/more_harmonics.hpp"
#include "cases/all_solutions.hpp"
#include "cases/curves.hpp"
#include "cases/cycles.hpp"
#include "cases/departures.hpp"
#include "cases/ring_amplification.hpp"
#include "cases/surfaces.hpp"

namespace arcslip {
namespace {

using continuation::BasePoint;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::PointType;
using continuation::TimeBudget;
using Clock = std::chrono::steady_clock;

Built build_library(const ProblemRequest& request) {
  const std::shared_ptr<const continuation::Problem> problem = request.model->build(request.settings);
  const auto guess = [model = request.model, problem](const Built::ValueOf& value,
                                                      const continuation::TraceOptions& /*limits*/) {
    problems::LibraryModel::Values settings;
    for (const Setting& setting : model->settings) settings.push_back(value(setting.name));
    return model->guess(*problem, settings);
  };
  return {problem, guess};
}

std::vector<TracedBranch> trace_branches(const Request& request, const Subject& subject,
                                         const TimeBudget& time, const continuation::Observer& observer) {
  const continuation::Problem& problem = *subject.built.problem;
  if (has_orbits_alone(*request)) return trace_from_orbit(request, subject, time, observer);
  if (asks_for_cycles(*request)) return trace_settled_cycles(request, subject, time, observer);
  std::vector<Branch> branches;
  std::shared_ptr<const problems::SolutionCount> solutions;
  const auto rest = [&] {
    continuation::TraceOptions options = time.rest();
    options.events.insert(options.events.end(), subject.built.events.begin(), subject.built.events.end());
    return options;
  };
  std::vector<continuation::Guess> begun{subject.guess};
  if (request->all_solutions) {
    problems::AllSolutions all = find_all_solutions(*request, subject, time);
    begun = std::move(all.solutions);
    solutions = std::make_shared<const problems::SolutionCount>(std::move(all.count));
  }
  if (request->switching && request->start) {
    branches = continuation::trace_connected_through(problem, begun, rest(), observer);
  } else if (request->switching) {
    branches = continuation::trace_connected(problem, subject.guess, rest(), observer);
  } else if (request->all_solutions) {
    branches = continuation::trace_through(problem, begun, rest(), observer);
  } else if (request->start) {
    branches.push_back(continuation::trace_both(problem, subject.guess, rest(), observer));
  } else {
    branches.push_back(continuation::trace(problem, subject.guess, rest(), observer));
  }
  std::vector<TracedBranch> traced;
  traced.reserve(branches.size());
  for (Branch& branch : branches) {
    traced.push_back({request, subject.built, nullptr, std::move(branch), 0});
    traced.back().solutions = solutions;
  }
  if (!request->switching || !may_leave_cycles(problem)) return traced;
  for (TracedBranch& one : cycles_leaving(traced, time, observer)) traced.push_back(std::move(one));
  return traced;
}

}  // namespace

bool needs_balance(const SystemParameters& system, const std::optional<double>& harmonics_tolerance) {
  return !structures_of(system).is_one_contact(system) || system.harmonics.size() > 1 ||
         harmonics_tolerance || system.has_others() || !system.varied.empty() || system.tells_lag;
}

Built build(const ProblemRequest& request) {
  return request.model != nullptr ? build_library(request) : request.response->build(request);
}

std::vector<std::string> tracked_observables(const ProblemRequest& request, bool with_phases) {
  std::vector<std::string> names;
  for (const continuation::Observable& observable : build(request).problem->observables()) {
    if (observable.has_gradient && (with_phases || observable.period == 0)) names.push_back(observable.name);
  }
  return names;
}

double fixed_value(const ProblemRequest& problem, const std::string& parameter) {
  if (problem.model == nullptr) {
    return parameter == "P"     ? problem.system.preload
           : parameter == "eta" ? problem.eta
           : parameter == "R"   ? problem.R
                                : system_parameter(problem.system, parameter).value;
  }
  for (std::size_t i = 0; i < problem.settings.size(); ++i) {
    if (problem.model->settings[i].name == parameter) return problem.settings[i];
  }
  return 0;
}

Subject build(const ProblemRequest& request, const std::string& parameter, double value,
              const continuation::TraceOptions& limits) {
  Subject subject{build(request), {}, {}};
  const auto value_of = [&](const std::string& name) {
    return name == parameter ? value : fixed_value(request, name);
  };
  try {
    subject.guess = subject.built.guess(value_of, limits);
  } catch (const std::invalid_argument& error) {
    subject.failure = error.what();
  } catch (const continuation::Unfinished& error) {
    subject.failure = error.what();
    subject.stop = error.stop;
  }
  return subject;
}

CaseBranch seed_branch(const CaseBranch& request) {
  CaseBranch seeds = request;
  seeds.options.parameter = request.curve->active;
  seeds.options.from = request.curve->from;
  seeds.options.to = request.curve->to;
  if (request.curve->is_surface()) {  // no branch, but a point
    const double value = fixed_value(request.problem, request.curve->active);
    if (value >= request.curve->window.low && value <= request.curve->window.high) seeds.options.from = value;
    seeds.start = seeds.options.from;
  }
  seeds.options.stop_at.clear();
  seeds.options.stop_after.clear();
  seeds.curve.reset();
  return seeds;
}

namespace {

/// Puts a stored point in place of the guess, found or not. Throws InputError where it is one of another
/// problem.
void begin_from(const CaseBranch& request, Subject& subject) {
  const StoredPoint& point = *request.stored;
  const continuation::Problem& problem = *subject.built.problem;
  if (point.unknowns.size() != problem.size())
    throw InputError(fmt::format("branch.from_point: the point has {} in place of the problem's {} unknowns",
                                 point.unknowns.size(), problem.size()));
  const std::vector<std::string> names = problem.parameter_names();
  continuation::Guess& guess = subject.guess;
  guess = {point.unknowns, Vector(std::ssize(names)), point.regime, {}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool varies = names[i] == request.options.parameter;
    guess.parameters(static_cast<Index>(i)) =
        varies ? *request.start : fixed_value(request.problem, names[i]);
  }
  subject.failure.clear();
}

/// Those on which the first points of curves are looked for, `first` or the cycles that leave it; and,
/// without points, what else was not traced to its end.
std::vector<TracedBranch> branches_across(const CurveRequest& asked, const CaseBranch& first,
                                          const Subject& subject, const TimeBudget& time) {
  const auto across = std::make_shared<CaseBranch>(first);
  if (asked.level)
    across->options.events.push_back(continuation::event_at(*asked.level, *subject.built.problem));
  const bool of_cycles = asked.of_cycles && !subject.built.problem->is_map();
  across->switching = of_cycles;
  across->options.max_seconds = time.rest().max_seconds;
  std::vector<TracedBranch> traced = trace_branches(across, subject, TimeBudget(across->options), {});
  if (!of_cycles) return traced;
  std::erase_if(traced,
                [](const TracedBranch& one) { return cycles_of(one) == nullptr && one.branch.complete(); });
  for (TracedBranch& one : traced) {
    if (cycles_of(one) == nullptr) one.branch.points.clear();
  }
  return traced;
}

std::vector<TracedBranch> trace_given(const Request& request, const TimeBudget& time,
                                      const continuation::Observer& observer) {
  const Clock::time_point begun = Clock::now();
  const CaseBranch first = request->curve ? seed_branch(*request) : *request;
  Subject subject =
      build(first.problem, first.options.parameter, first.start.value_or(first.options.from), time.rest());
  if (first.stored) begin_from(first, subject);
  if (subject.failure.empty() && subject.built.problem->sparse() &&
      may_leave_cycles(*subject.built.problem) && request->cycles.options.trigonometric)
    subject.failure = "cycles of sparse systems are held on intervals, not by balance";
  if (!subject.failure.empty()) return {unstarted(request, subject, subject.failure)};
  if (request->curve && request->curve->is_surface()) return {cover_surface(request, subject, time)};
  if (request->curve)
    return trace_curves(request, subject, branches_across(*request->curve, first, subject, time), time,
                        observer);
  std::vector<TracedBranch> traced = trace_branches(request, subject, time, observer);
  if (traced.empty()) {
    const CaseBranch& asked = *request;
    return {unstarted(request, subject,
                      fmt::format("no solution was found at {} = {:.10g}, be it by deflation",
                                  asked.options.parameter, asked.start.value_or(asked.options.from)))};
  }
  const std::chrono::duration<double> seconds = Clock::now() - begun;
  for (TracedBranch& branch : traced) branch.seconds = seconds.count() / static_cast<double>(traced.size());
  return traced;
}

}  // namespace

std::vector<int> missing_orders(const SystemParameters& system, const Branch& branch, double tolerance,
                                const TimeBudget& time) {
  constexpr int least = 15;
  SystemParameters wide = system;
  wide.harmonics =
      orders_up_to(std::max(2 * highest_order(system.harmonics) + 1, least * system.periods()), system);
  const problems::HarmonicResponse problem(build_harmonic_system(wide));
  const problems::HarmonicResponse traced(build_harmonic_system(system));
  Vector residual(problem.size());
  Vector largest = Vector::Zero(problem.harmonics());
  for (const BranchPoint& point : branch.points) {
    if (!time.goes_on()) return {};
    const continuation::Guess padded =
        problems::carried(traced, {point.unknowns, point.parameters, point.regime}, problem);
    if (!problem.evaluate(padded.unknowns, padded.parameters, padded.regime, {&residual})) continue;
    for (Index row = 0; row < residual.size(); ++row) {
      double& size = largest(row / 2 % problem.harmonics());
      size = std::max(size, std::abs(residual(row)));
    }
  }
  std::vector<int> missing;
  for (Index a = 0; a < problem.harmonics(); ++a) {
    const int h = wide.harmonics[static_cast<std::size_t>(a)];
    const bool is_there = std::count(system.harmonics.begin(), system.harmonics.end(), h) > 0;
    if (largest(a) > tolerance && !is_there) missing.push_back(h);
  }
  return missing;
}

void add_orders(std::vector<int>& orders, const std::vector<int>& more) {
  const int of_load = orders.front();
  orders.insert(orders.end(), more.begin(), more.end());
  std::sort(orders.begin(), orders.end());
  orders.erase(std::unique(orders.begin(), orders.end()), orders.end());
  const auto first = std::find(orders.begin(), orders.end(), of_load);
  std::rotate(orders.begin(), first, first + 1);
}

namespace {

/// The branch with as many harmonics as its own points ask for.
std::vector<TracedBranch> trace_balanced(const Request& request, const TimeBudget& time,
                                         const continuation::Observer& observer) {
  const auto widened = std::make_shared<CaseBranch>(*request);
  std::vector<int>& orders = widened->problem.system.harmonics;
  while (true) {
    std::vector<TracedBranch> traced = trace_given(widened, time, observer);
    std::vector<int> missing;
    for (TracedBranch& one : traced) {
      one.request = request;
      if (!one.branch.complete() || one.curve) continue;
      const std::vector<int> more =
          missing_orders(widened->problem.system, one.branch, *request->problem.harmonics_tolerance, time);
      missing.insert(missing.end(), more.begin(), more.end());
      if (time.goes_on()) continue;
      one.branch.stop = time.is_spent() ? continuation::Stop::time_limit : continuation::Stop::interrupted;
      one.branch.explanation = "ended before it was known whether its harmonics suffice";
    }
    if (!time.goes_on() || missing.empty()) return traced;
    add_orders(orders, missing);
  }
}

/// Says of a response that went no further what it may have met there.
void explain_end(TracedBranch& one) {
  using continuation::Stop;
  Branch& branch = one.branch;
  const ProblemRequest& problem = one.request->problem;
  const bool is_stuck = branch.stop == Stop::min_step || branch.stop == Stop::repeats;
  if (!is_stuck || one.curve || branch.points.empty() || problem.model != nullptr ||
      problem.response->has_own_frequency())
    return;
  const Index eta = continuation::index_of(one.problem().parameter_names(), "eta");
  SystemParameters system = problem.system;
  system.harmonics = one.base.harmonics;
  const std::string why = undamped_resonance(system, branch.points.back().parameters(eta));
  if (!why.empty()) branch.explanation += ": " + why;
}

}  // namespace

std::vector<TracedBranch> trace(const CaseBranch& request, const continuation::Observer& observer) {
  const TimeBudget time(request.options);
  const Request kept = tells_amplification(request) ? with_equal_peak(request, time)
                                                    : std::make_shared<const CaseBranch>(request);
  std::vector<TracedBranch> traced = request.problem.harmonics_tolerance
                                         ? trace_balanced(kept, time, observer)
                                         : trace_given(kept, time, observer);
  std::for_each(traced.begin(), traced.end(), explain_end);
  const auto is_left = [](const TracedBranch& one) { return is_unfinished(one.branch.stop); };
  const bool goes_on = request.switching && request.problem.stability &&
                       !request.problem.response->has_own_frequency() &&
                       std::none_of(traced.begin(), traced.end(), is_left);
  if (!goes_on) return traced;
  for (TracedBranch& one : trace_departures(traced, time, observer)) traced.push_back(std::move(one));
  return traced;
}

}  // namespace arcslip
