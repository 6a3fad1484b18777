#include "cases/curves.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/path/switching.hpp"
#include "arcslip/continuation/points/normal_form.hpp"
#include "cases/further_curves.hpp"

namespace arcslip {
namespace {

using continuation::BasePoint;
using continuation::Branch;
using continuation::BranchPoint;
using continuation::ExtendedProblem;
using continuation::PointType;
using continuation::TimeBudget;

/// Whether solutions are one: of orbits, which may be told on different meshes, by what is observed of them.
bool same_solution(const continuation::Problem& a, const BasePoint& at, const continuation::Problem& b,
                   const BranchPoint& seed) {
  if (dynamic_cast<const continuation::OrbitProblem*>(&b) == nullptr)
    return at.unknowns.size() == seed.unknowns.size() && same_place(at.unknowns, seed.unknowns);
  Vector of_curve;
  Vector of_seed;
  a.observe(at.unknowns, at.parameters, at.regime, of_curve);
  b.observe(seed.unknowns, seed.parameters, seed.regime, of_seed);
  return of_curve.size() == of_seed.size() && same_place(of_curve, of_seed);
}

/// Whether a curve passes the special point of a base like its own.
bool passes(const TracedBranch& traced, const continuation::Problem& base, const BranchPoint& seed,
            const std::string& second) {
  const Index parameter = continuation::index_of(base.parameter_names(), second);
  return std::any_of(traced.branch.points.begin(), traced.branch.points.end(), [&](const BranchPoint& point) {
    const BasePoint at = traced.curve->split(point.unknowns, point.parameters, point.regime);
    return std::abs(at.parameters(parameter) - seed.parameters(parameter)) <=
               1e-12 * std::abs(seed.parameters(parameter)) &&
           same_place(at.parameters, seed.parameters) && same_solution(*traced.base.problem, at, base, seed);
  });
}

/// Whether a `user` point is one that was asked for.
bool is_listed(const BranchPoint& point, const TracedBranch& curve) {
  const continuation::TraceOptions& options = curve.request->options;
  const double value =
      point.parameters(continuation::index_of(curve.curve->parameter_names(), options.parameter));
  return std::count(options.stop_at.begin(), options.stop_at.end(), value) > 0;
}

/// Why a branch that was traced whole begins no curve.
std::string why_none(const continuation::Problem& problem, const Branch& branch, const std::string& second) {
  std::vector<std::string> met;
  for (const BranchPoint& point : branch.points) {
    const std::string name = problem.describe(point.regime);
    if (std::find(met.begin(), met.end(), name) == met.end()) met.push_back(name);
  }
  const std::string regimes =
      problem.switch_count() > 0
          ? fmt::format(" in the {} {}", met.size() > 1 ? "regimes" : "regime", fmt::join(met, ", "))
          : "";
  return fmt::format(": the branch there, traced from end to end{}, has none; at another {} it may", regimes,
                     second);
}

/// Whether a point of the branch is one through which a curve is wanted: of phase resonances one at which the
/// lag rises with eta, as it falls at antiresonances: by the point before, for none begins a branch.
bool is_seed(const CurveRequest& asked, const continuation::Problem& problem, const BranchPoint& point) {
  if (point.type != asked.type) return false;
  if (!asked.level) return true;
  const auto above = [&](const BranchPoint& at) {
    return continuation::above(*asked.level, problem, at.unknowns, at.parameters, at.regime);
  };
  if (!continuation::is_at(*asked.level, problem, point)) return false;
  return !asked.is_backbone() || (above(*(&point - 1)) < 0) == (asked.from < asked.to);
}

}  // namespace

TracedBranch unstarted(const Request& request, const Subject& subject, const std::string& why) {
  TracedBranch none{request, subject.built, nullptr, {}, 0};
  none.branch.stop = subject.stop;
  none.branch.explanation = why;
  return none;
}

namespace {

/// The curve through a special point of a branch.
TracedBranch trace_through(const Request& request, const TracedBranch& seeds, const BranchPoint& seed,
                           const std::string& observable, const continuation::TraceOptions& options,
                           const continuation::Observer& observer) {
  const CurveRequest& asked = *request->curve;
  const continuation::OrbitOptions& orbits = request->cycles.options;
  const std::shared_ptr<const continuation::Problem>& base = seeds.base.problem;
  return traced_curve(request, seeds.base, [&] {
    if (!asked.level) {
      return continuation::trace_curve_through(base, asked.active, seed, observable, options, asked.window,
                                               orbits, observer);
    }
    continuation::CurveStart start = continuation::curve_at(*asked.level, *base, asked.active, seed);
    Branch curve =
        continuation::trace_curve(*start.problem, start.point, options, asked.window, observer, orbits);
    return continuation::Curve{base, std::move(start.problem), std::move(curve)};
  });
}

}  // namespace

std::vector<TracedBranch> trace_curves(const Request& request, const Subject& subject,
                                       const std::vector<TracedBranch>& across, const TimeBudget& time,
                                       const continuation::Observer& observer) {
  const CurveRequest& asked = *request->curve;
  continuation::TraceOptions options = request->options;
  const std::string observable = options.extrema_of.empty() ? "" : options.extrema_of.front();
  const bool ridge = asked.type == PointType::peak || asked.type == PointType::trough;
  options.extrema_of = {ridge ? observable : asked.active};  // one of the two, or rows would be ambiguous
  options.stop_at.push_back(asked.seed);  // where a curve that comes back to another seed shows itself
  std::vector<TracedBranch> curves;
  bool is_left = false;  // of those behind it nothing is known
  for (const TracedBranch& seeds : across) {
    const continuation::Problem& problem = *seeds.base.problem;
    for (const BranchPoint& seed : seeds.branch.points) {
      if (is_left || !is_seed(asked, problem, seed)) continue;
      const auto known = [&](const TracedBranch& curve) {
        return passes(curve, problem, seed, options.parameter);
      };
      if (std::any_of(curves.begin(), curves.end(), known)) continue;
      options.max_seconds = time.rest().max_seconds;
      curves.push_back(trace_through(request, seeds, seed, observable, options, observer));
      is_left = is_unfinished(curves.back().branch.stop);
    }
  }
  if (request->switching) follow_curves(options, asked.window, time, observer, curves);
  for (TracedBranch& curve : curves) {
    for (BranchPoint& point : curve.branch.points) {
      if (point.type == PointType::user && !is_listed(point, curve)) point.type = PointType::regular;
    }
  }
  if (!curves.empty()) return curves;
  Subject none = subject;
  const auto unfinished = std::find_if(across.begin(), across.end(),
                                       [](const TracedBranch& one) { return !one.branch.complete(); });
  const bool is_whole = unfinished == across.end();
  if (!is_whole && !is_end(unfinished->branch.stop)) none.stop = unfinished->branch.stop;
  std::string why = ": no cycles were found";
  if (!is_whole) {
    why = ": " + unfinished->branch.explanation;
  } else if (!across.empty()) {
    why = why_none(*subject.built.problem, across.front().branch, options.parameter);
  }
  return {unstarted(request, none,
                    fmt::format("no {} was found for {} = {:g} to {:g} at {} = {:g}{}", asked.name,
                                asked.active, asked.from, asked.to, options.parameter, asked.seed, why))};
}

}  // namespace arcslip
