#include "arcslip/continuation/cycles/cycle_branch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "arcslip/continuation/cycles/end_of_kind.hpp"
#include "arcslip/continuation/path/watch.hpp"
#include "arcslip/continuation/points/branch_point_problem.hpp"
#include "arcslip/continuation/points/normal_form.hpp"
#include "carrier.hpp"
#include "orbit_mark.hpp"

namespace arcslip::continuation {
namespace {

/// How far along a branch the frame of its last point serves. On a branch point it has to: others cannot be
/// corrected there.
class MeshWatch {
 public:
  MeshWatch(OrbitProblem& problem, const OrbitOptions& options) : problem_(problem), options_(options) {}

  bool serves(const BranchPoint& point) {
    constexpr double grip = 0.5;
    if (point.type == PointType::branch_point) singular_ = point.arclength;
    if (point.arclength == singular_) return true;
    return problem_.mesh_error(point.unknowns, point.regime) <= options_.tolerance &&
           problem_.phase_grip(point.unknowns, point.regime) > grip &&
           problem_.apart_grip(point.unknowns, point.regime) > grip;
  }

  /// Whether a new frame can wait for one more point: signs that are all rounding would put it off for ever.
  bool can_wait() {
    constexpr int most = 3;
    waits_ = waits_ < most ? waits_ + 1 : 0;
    return waits_ > 0;
  }

  /// What a branch began with, on the mesh that it began on.
  const CurvePoint& start(const Progress& progress) {
    if (!start_) start_ = progress.start;
    return *start_;
  }

  /// A frame for an orbit; none where no mesh of this resolution is good enough.
  std::optional<Regime> renewed(const Vector& u, const Vector& p, const Regime& regime) {
    // or the next point would ask again; a finer mesh starts all over, which takes long where it is large
    const double margin = problem_.field().sparse() ? 0.5 : 0.3;
    const OrbitFrame& frame = problem_.frame(regime);
    const Matrix orbit = problem_.orbit(u);
    const Vector range = range_on(frame, orbit);
    OrbitMesh mesh = frame.mesh.equidistributed(orbit, range, problem_.resolution());
    Matrix carried = frame.mesh.carried(orbit, mesh);
    if (mesh.errors(carried, range).maxCoeff() > margin * options_.tolerance) return std::nullopt;
    return problem_.add_frame(mesh, carried, p);
  }

 private:
  OrbitProblem& problem_;
  const OrbitOptions& options_;
  double singular_ = std::numeric_limits<double>::quiet_NaN();  // where the last branch point is
  int waits_ = 0;
  std::optional<CurvePoint> start_;
};

/// Thrown where a finer mesh is needed and there may be one.
struct TooCoarse {};

bool may_be_finer(const OrbitProblem& problem, const OrbitOptions& orbits) {
  const auto* cycles = dynamic_cast<const CycleProblem*>(&problem);
  const Index periods = cycles == nullptr ? 1 : cycles->periods();
  return 2 * problem.resolution() <=
         (problem.is_trigonometric() ? periods * orbits.most_waves : orbits.most_intervals);
}

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

bool is_at_rest(const OrbitProblem& problem, const BranchPoint& point) {
  if (!problem.may_rest()) return false;
  const Matrix orbit = problem.orbit(point.unknowns);
  return orbit.rowwise().maxCoeff() == orbit.rowwise().minCoeff();
}

/// Whether a point has the signs that are known of it.
bool agrees(const OrbitProblem& problem, const CurvePoint& point, const Signs& signs) {
  const auto differs = [](int known, double value) { return known * sign_of(value) < 0; };
  if (differs(signs.parameter, point.tangent(point.tangent.size() - 1))) return false;
  Vector functions(std::ssize(problem.test_types()));
  problem.test(point.unknowns, point.parameters, point.regime, functions);
  for (Index i = 0; i < functions.size(); ++i) {
    if (differs(signs.functions[static_cast<std::size_t>(i)], functions(i))) return false;
  }
  ComplexVector eigenvalues;
  return signs.unstable < 0 ||
         !problem.eigenvalues(point.unknowns, point.parameters, point.regime, eigenvalues) ||
         (eigenvalues.real().array() > 0).count() == signs.unstable;
}

/// Puts a branch on a mesh that fits where it stands; false if no mesh of this resolution does. It may stay
/// on its own for a while where the other one has a special point, which lies elsewhere there, be it by 1e-8,
/// on the other side of it: that would be told twice.
bool renew(OrbitProblem& problem, MeshWatch& meshes, Branch& branch, const TraceOptions& options) {
  Progress& progress = *branch.checkpoint->ahead;
  const Regime before = progress.here.regime;
  const auto regime = meshes.renewed(progress.here.unknowns, progress.here.parameters, before);
  if (!regime) return false;
  const Carrier carrier(problem, before, *regime);
  Corrector corrector(problem, index_of(problem.parameter_names(), options.parameter),
                      {.tolerance = options.tolerance});
  const Vector bend = carrier(progress.bend.cwiseProduct(progress.here.scale));
  CurvePoint here = progress.here;
  if (!carrier.carry(corrector, here)) return false;
  if (!agrees(problem, here, progress.signs) && meshes.can_wait()) return true;
  progress.start = meshes.start(progress);
  progress.here = here;
  progress.bend = bend.cwiseQuotient(progress.here.scale);
  Carrier of_start(problem, progress.start.regime, *regime);
  of_start.turn_to(progress.start.unknowns, here.unknowns);
  of_start.carry(corrector, progress.start);
  progress.past.clear();
  return true;
}

/// Tells where the period grows while the parameter no longer changes, and the orbit all but rests on its
/// way: where it comes ever nearer to an equilibrium. Relaxation oscillations grow as fast, without rest.
class GrowthWatch {
 public:
  GrowthWatch(const OrbitProblem& problem, const TraceOptions& options, double tolerance)
      : problem_(problem),
        options_(options),
        nearly_(std::min(1e-8, 0.01 * tolerance)),
        parameter_(index_of(problem.parameter_names(), options.parameter)) {}

  bool goes_on(const BranchPoint& point) {
    constexpr double grown = 1.05;
    constexpr int many = 30;       // points: where rounding hides how an orbit goes on
    constexpr double rest = 1e-2;  // of the mean speed: that from an equilibrium falls with e^(-T/2) at least
    if (!problem_.has_duration()) return true;
    Vector unknowns(problem_.size());
    Vector scale(point.parameters.size());
    problem_.scale(point.unknowns, point.parameters, unknowns, scale);
    const double value = point.parameters(parameter_);
    const double period = problem_.duration(point.unknowns, point.parameters);
    const double same = nearly_ * scale(parameter_);
    last_period_ = period;
    if (!(std::abs(value - value_) <= same) || period < period_) {
      value_ = value;
      period_ = period;
      points_ = 0;
    }
    return (period < grown * period_ && ++points_ < many) ||
           problem_.least_speed(point.unknowns, point.parameters, point.regime) > rest;
  }

  /// A sentence, with as many digits of the parameter as are known.
  std::string told() const {
    return fmt::format(
        "the period grows without bound, past {:.6g}: an orbit that begins and ends on an equilibrium lies "
        "at {} = {:.{}g}",
        last_period_, options_.parameter, value_, static_cast<int>(std::ceil(-std::log10(nearly_))));
  }

 private:
  const OrbitProblem& problem_;
  const TraceOptions& options_;
  double nearly_;  // of the parameter: its distance from its limit falls with e^-T until meshes hide it
  Index parameter_;
  double value_ = std::numeric_limits<double>::quiet_NaN();
  double period_ = 0;  // the least at this value
  double last_period_ = 0;
  int points_ = 0;  // since then
};

/// One way; `begin` traces up to where the observer says no. Of a branch that leaves a branch point, which
/// cannot be corrected on the meshes that follow, the mark of this tells where it comes back.
template <class Begin>
Branch one_way(OrbitProblem& problem, TraceOptions options, const OrbitOptions& orbits,
               const Observer& observer, const std::optional<OrbitMark>& left, const Begin& begin) {
  options.journal = nullptr;  // which has no meshes: the same work is done anew
  end_with_kind(problem, options);
  MeshWatch meshes(problem, orbits);
  GrowthWatch growth(problem, options, orbits.tolerance);
  bool worn = false;
  bool told = false;
  bool grows = false;
  bool rests = false;
  bool closes = false;
  const TimeBudget time(options);
  const Observer watching = [&](const BranchPoint& point) {
    told = observer && !observer(point);
    problem.note_apart(point.unknowns, point.regime);
    worn = point.type != PointType::event && !meshes.serves(point);  // one of these may be the end
    grows = !growth.goes_on(point);
    rests = !options.branch_point_pairs && is_at_rest(problem, point);
    closes = left && point.type == PointType::branch_point &&
             is_same(*left, mark_of(problem, point, index_of(problem.parameter_names(), options.parameter)));
    return !told && !worn && !grows && !rests && !closes;
  };
  Branch branch = begin(options, watching);
  while (branch.stop == Stop::interrupted && (worn || rests) && !told && !grows && !closes) {
    if (rests)
      options.branch_point_pairs = true;  // as nothing bends, steps grow beyond what lies between two
    rests = false;
    if (std::exchange(worn, false) && !renew(problem, meshes, branch, options)) {
      if (may_be_finer(problem, orbits)) throw TooCoarse{};
      branch.stop = Stop::no_value;
      branch.explanation = fmt::format(
          "an orbit of {} {} misses more than {:g} of what its unknowns do, at {} = {:.10g}",
          problem.resolution(), problem.is_trigonometric() ? "waves" : "intervals", orbits.tolerance,
          options.parameter,
          branch.points.back().parameters(index_of(problem.parameter_names(), options.parameter)));
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
  if (branch.stop == Stop::interrupted && grows && !told) {
    branch.stop = Stop::infinite_period;
    branch.explanation = growth.told();
    branch.checkpoint.reset();
  }
  return branch;
}

OrbitBranch on_these_intervals(const OrbitStart& start, const TraceOptions& options,
                               const OrbitOptions& orbits, const Observer& observer) {
  OrbitProblem& problem = *start.problem;
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

OrbitStart start_from(std::shared_ptr<OrbitProblem> problem, const Matrix& orbit, double duration,
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
