#include "cases/further_curves.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <typeinfo>

#include "arcslip/continuation/curves/cycle_curves.hpp"
#include "arcslip/continuation/curves/meeting_curves.hpp"
#include "arcslip/continuation/cycles/orbit_mark.hpp"
#include "arcslip/continuation/cycles/torus_problem.hpp"
#include "arcslip/continuation/path/switching.hpp"
#include "arcslip/continuation/points/hopf_problem.hpp"
#include "arcslip/continuation/points/normal_form.hpp"
#include "cases/cycles.hpp"

namespace arcslip {
namespace {

using continuation::BasePoint;
using continuation::BranchPoint;
using continuation::ExtendedProblem;
using continuation::OrbitCurveStart;
using continuation::OrbitProblem;
using continuation::TraceOptions;

/// Whether two points of the same kind are so by the same pair, where that is what they are.
bool has_same_pair(const BasePoint& one, const BasePoint& other) {
  constexpr double located = 1e-5;
  return one.extras.size() != other.extras.size() || one.extras.size() == 0 ||
         std::abs(one.extras(0) - other.extras(0)) <= located * (1 + std::abs(other.extras(0)));
}

/// Whether a curve is of points of the same kind as another, and passes a point of the base.
bool is_known(const TracedBranch& curve, const ExtendedProblem& kind, const BasePoint& at) {
  const ExtendedProblem& own = *curve.curve;
  const bool same_kind = typeid(own) == typeid(kind) && own.size() == kind.size();
  return same_kind &&
         std::any_of(curve.branch.points.begin(), curve.branch.points.end(), [&](const BranchPoint& point) {
           const BasePoint here = curve.curve->split(point.unknowns, point.parameters, point.regime);
           return has_same_pair(here, at) && same_place(here.parameters, at.parameters) &&
                  same_place(here.unknowns, at.unknowns);
         });
}

/// How far inside a pair of eigenvalues is imaginary, or one of multipliers is on the unit circle, where that
/// is what the points are; elsewhere, as beyond Bogdanov-Takens points and 1:1 resonances, they are neutral
/// saddles.
double inside(const ExtendedProblem& problem, const BasePoint& at) {
  if (dynamic_cast<const continuation::HopfProblem*>(&problem) != nullptr) return at.extras(0);
  if (dynamic_cast<const continuation::TorusProblem*>(&problem) != nullptr) return 1 - std::abs(at.extras(0));
  return 1;
}

constexpr double on_edge = 1e-6;  // rounding of that, where a pair meets

double inside(const TracedBranch& curve, const BranchPoint& point) {
  return inside(*curve.curve, curve.curve->split(point.unknowns, point.parameters, point.regime));
}

/// Without neutral saddles.
void keep_pairs(TracedBranch& curve) {
  std::erase_if(curve.branch.points,
                [&](const BranchPoint& point) { return inside(curve, point) < -on_edge; });
}

/// Whether of what was traced to its end nothing is left but where it began: pairs that meet with two
/// eigenvectors need not leave.
bool has_no_pairs(const TracedBranch& curve) {
  return curve.branch.complete() &&
         std::none_of(curve.branch.points.begin(), curve.branch.points.end(),
                      [&](const BranchPoint& point) { return inside(curve, point) > on_edge; });
}

/// Moves a start on a special point beside it, so that this is passed as others are: of Hopf points to the
/// side where they are ones.
void put_beside(ExtendedProblem& problem, Index second, const continuation::TraceOptions& options,
                BasePoint& at) {
  constexpr double beside = 1e-3;
  const double middle = 0.5 * (options.from + options.to);
  const double inwards = at.parameters(second) < middle ? 1 : -1;
  for (const double way : {inwards, -inwards}) {
    BasePoint there = at;
    there.parameters(second) += way * beside * std::abs(options.to - options.from);
    const auto located = continuation::locate(problem, there, options.tolerance);
    if (!located || !(inside(problem, located->point) > 0)) continue;
    at = located->point;
    return;
  }
}

/// Whether a curve is of special cycles like those of this start, and passes it, or ends at small ones like
/// it.
bool has_come_to(const TracedBranch& curve, const continuation::OrbitCurveStart& start,
                 const ExtendedProblem& kind) {
  constexpr double near = 1e-2;
  constexpr double located = 1e-5;
  constexpr double shrunk = 0.2;  // of the largest cycle
  const ExtendedProblem& own = *curve.curve;
  const auto* orbits = dynamic_cast<const continuation::OrbitProblem*>(&own.base());
  if (orbits == nullptr || typeid(own) != typeid(kind)) return false;
  const bool is_small = start.direction.size() > 0;
  const Vector& p = start.point.parameters;
  const double duration = start.orbits->duration(start.point.unknowns, p);
  const double margin = is_small ? near : located;
  const continuation::OrbitMark begun = mark_of(*start.orbits, start.point, own.active());
  const auto is_there = [&](const BranchPoint& point) {
    const BasePoint at = own.split(point.unknowns, point.parameters, point.regime);
    if (!((at.parameters - p).array().abs() <= margin * p.array().abs().max(margin)).all()) return false;
    if (!is_small)
      return has_same_pair(at, start.point) && is_same(begun, mark_of(*orbits, at, own.active()));
    return std::abs(orbits->duration(at.unknowns, at.parameters) - duration) < near * duration &&
           orbits->apart(at.unknowns, at.regime) < shrunk;
  };
  return std::any_of(curve.branch.points.begin(), curve.branch.points.end(), is_there);
}

/// The one of the same equilibria or points of a map.
FurtherCurve meeting(const TracedBranch& from, const continuation::CurveWindow& window,
                     continuation::CurveStart start) {
  const std::shared_ptr<ExtendedProblem> problem = std::move(start.problem);
  const std::shared_ptr<const CaseBranch> request = from.request;
  const auto is_part_of = [problem, at = start.point](const TracedBranch& curve) {
    return is_known(curve, *problem, at);
  };
  const auto trace = [problem, base = from.base, request, window, at = start.point](
                         const TraceOptions& options, const continuation::Observer& observer) {
    BasePoint beside = at;
    const Index second = continuation::index_of(base.problem->parameter_names(), options.parameter);
    put_beside(*problem, second, options, beside);
    TracedBranch traced = traced_curve(request, base, [&] {
      return continuation::Curve{base.problem, problem,
                                 continuation::trace_curve(*problem, beside, options, window, observer)};
    });
    keep_pairs(traced);
    return traced;
  };
  return {start.point.parameters, false, is_part_of, trace};
}

FurtherCurve of_cycles(const TracedBranch& from, const continuation::CurveWindow& window,
                       const OrbitCurveStart& start) {
  const std::shared_ptr<ExtendedProblem> kind = start.make(*start.orbits, start.point);
  const std::shared_ptr<const CaseBranch> request = from.request;
  const auto is_part_of = [kind, start](const TracedBranch& curve) {
    return has_come_to(curve, start, *kind);
  };
  const auto trace = [kind, base = from.base, request, window, start](
                         const TraceOptions& options, const continuation::Observer& observer) {
    OrbitCurveStart beside = start;
    const Index second = continuation::index_of(start.orbits->parameter_names(), options.parameter);
    if (start.direction.size() == 0) put_beside(*kind, second, options, beside.point);
    return traced_curve(request, base, [&] {
      return continuation::trace_orbit_curve(beside, options, window, request->cycles.options, observer);
    });
  };
  return {start.point.parameters, true, is_part_of, trace};
}

bool is_of_orbits(const TracedBranch& curve) {
  return dynamic_cast<const OrbitProblem*>(curve.base.problem.get()) != nullptr;
}

}  // namespace

TracedBranch traced_curve(const std::shared_ptr<const CaseBranch>& request, const Built& base,
                          const std::function<continuation::Curve()>& trace) {
  const auto begun = std::chrono::steady_clock::now();
  continuation::Curve curve = trace();
  TracedBranch traced{request, base, std::move(curve.problem), std::move(curve.branch), 0};
  traced.base.problem = std::move(curve.base);
  traced.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return traced;
}

std::vector<FurtherCurve> further_curves(const TracedBranch& curve, const BranchPoint& point,
                                         const continuation::CurveWindow& window) {
  const std::shared_ptr<const continuation::Problem>& base = curve.base.problem;
  std::vector<FurtherCurve> further;
  std::vector<OrbitCurveStart> cycles;
  if (is_of_orbits(curve)) {
    cycles = continuation::cycle_curves_meeting(*curve.curve, point);
  } else {
    continuation::CurveStart start = continuation::curve_meeting(*curve.curve, point);
    if (start.problem != nullptr) further.push_back(meeting(curve, window, std::move(start)));
    if (may_leave_cycles(*base))
      cycles = continuation::cycle_curves_from(std::make_shared<continuation::EquilibriumField>(base),
                                               *curve.curve, point, curve.request->cycles.options);
  }
  for (const OrbitCurveStart& start : cycles) further.push_back(of_cycles(curve, window, start));
  return further;
}

void follow_curves(TraceOptions options, const continuation::CurveWindow& window,
                   const continuation::TimeBudget& time, const continuation::Observer& observer,
                   std::vector<TracedBranch>& curves) {
  // false where no more may be followed
  const auto follow = [&](const FurtherCurve& one) {
    if (!time.goes_on()) return false;
    if (std::any_of(curves.begin(), curves.end(), one.is_part_of)) return true;
    if (curves.size() >= options.max_branches) {
      const std::vector<std::string> names = curves.front().base.problem->parameter_names();
      const double second = one.parameters(continuation::index_of(names, options.parameter));
      curves.back().branch.warn(continuation::more_branches(curves.size(), options.parameter, second));
      return false;
    }
    options.max_seconds = time.rest().max_seconds;
    if (TracedBranch traced = one.trace(options, observer); !has_no_pairs(traced))
      curves.push_back(std::move(traced));
    return true;
  };
  std::vector<FurtherCurve> of_cycles;  // that begin on others: they wait for all of these
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const TracedBranch from = curves[i];
    for (const BranchPoint& point : from.branch.points) {
      for (FurtherCurve& one : further_curves(from, point, window)) {
        if (one.is_of_cycles && !is_of_orbits(from)) {
          of_cycles.push_back(std::move(one));
        } else if (!follow(one)) {
          return;
        }
      }
    }
    if (i + 1 < curves.size()) continue;
    if (!std::all_of(of_cycles.begin(), of_cycles.end(), follow)) return;
    of_cycles.clear();
  }
}

}  // namespace arcslip
