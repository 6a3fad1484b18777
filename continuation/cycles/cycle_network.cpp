// All cycles that can be reached from equilibria.

#include <algorithm>
#include <cmath>
#include <deque>

#include "arcslip/continuation/cycles/cycle_branch.hpp"
#include "arcslip/continuation/cycles/orbit_mark.hpp"
#include "arcslip/continuation/cycles/orbit_observables.hpp"
#include "arcslip/continuation/path/switching.hpp"

namespace arcslip::continuation {
namespace {

struct Mark {
  PointType type;
  OrbitMark orbit;
};

/// What is looked for on cycles: extrema of what these have, whereas those of equilibria are others.
TraceOptions of_cycles(const Field& field, const TraceOptions& given) {
  TraceOptions options = unwatched(given);
  std::vector<std::string> known{duration_name(field.names(), field.parameter_names()), "norm"};
  for (const std::string& name : field.names()) known.insert(known.end(), {name + "_max", name + "_min"});
  for (const std::string& name : given.extrema_of) {
    if (std::find(known.begin(), known.end(), name) != known.end()) options.extrema_of.push_back(name);
  }
  return options;
}

/// Follows orbits, each branch once.
class OrbitNetwork {
 public:
  OrbitNetwork(const Field& field, const TraceOptions& options, const OrbitOptions& orbits,
               const Observer& observer)
      : options_(options),
        orbits_(orbits),
        observer_(observer),
        parameter_(index_of(field.parameter_names(), options.parameter)),
        time_(options_) {}

  /// The cycles that leave a Hopf point are to be followed.
  void expect(const std::shared_ptr<const Field>& field, const BranchPoint& hopf) {
    waiting_.push_back({nullptr, hopf, 0, field});
  }

  void begin(const OrbitStart& start) { follow(start, 0); }

  /// Those from Hopf points, which come first, and with `further` what the branches found meet. Without time
  /// left the next branch is begun, and says so.
  void follow_waiting(bool further = true) {
    while (!waiting_.empty() && !interrupted_) {
      const Waiting next = std::move(waiting_.front());
      waiting_.pop_front();
      if (!further && next.problem) return;
      const bool doubles = next.point.type == PointType::period_doubling;
      const std::vector<OrbitStart> starts = starts_at(next);
      for (const OrbitStart& start : starts) {
        if (interrupted_ || is_end_of(next, start)) continue;
        if (found_.size() >= orbits_.max_branches)
          return found_.back().branch.warn(
              more_branches(found_.size(), options_.parameter, next.point.parameters(parameter_)));
        follow(start, next.doublings + (doubles ? 1 : 0));
        if (next.field && !found_.empty() && found_.back().branch.stop == Stop::no_start &&
            has_equal(starts, start))
          found_.back().branch.warn(
              "several equal pairs of eigenvalues are on the axis at once, and the cycles that begin there "
              "are those of none of them alone; they were not found");
      }
    }
  }

  std::vector<OrbitBranch> take() { return std::move(found_); }

 private:
  struct Waiting {
    std::shared_ptr<const OrbitProblem> problem;
    BranchPoint point;
    int doublings;
    std::shared_ptr<const Field> field;  // of a Hopf point's equilibria, which has no orbits
  };

  void follow(const OrbitStart& start, int doublings) {
    OrbitBranch traced = trace_orbits(start, time_.rest(), orbits_, observer_);
    interrupted_ = is_unfinished(traced.branch.stop);
    if (begins_outside(traced.branch)) return;
    for (const BranchPoint& point : traced.branch.points) {
      if (point.type == PointType::branch_point || point.type == PointType::period_doubling) {
        marks_.push_back(mark(*traced.problem, point));
        waiting_.push_back({traced.problem, point, doublings, nullptr});
      }
    }
    if (!traced.branch.points.empty()) {
      if (traced.branch.first_stop) keep_end(*traced.problem, traced.branch.points.front());
      keep_end(*traced.problem, traced.branch.points.back());
    }
    found_.push_back(std::move(traced));
  }

  /// Whether another cycle begins with the same period, as that of another pair at the same Hopf point.
  static bool has_equal(const std::vector<OrbitStart>& starts, const OrbitStart& one) {
    constexpr double equal = 1e-6;  // as well as the point is located, by far
    const auto duration = [](const OrbitStart& start) {
      return start.problem->duration(start.guess.unknowns, start.guess.parameters);
    };
    return std::count_if(starts.begin(), starts.end(), [&](const OrbitStart& other) {
             return std::abs(duration(other) - duration(one)) < equal * duration(one);
           }) > 1;
  }

  /// From a special point on an end of the range away from it.
  static bool begins_outside(const Branch& branch) {
    return branch.stop == Stop::no_start && !branch.points.empty();
  }

  /// Of one on which orbits come to be of a simpler kind.
  void keep_end(const OrbitProblem& problem, const BranchPoint& end) {
    constexpr double nothing = 2e-3;  // of what keeps them apart: branches end at half of it
    const auto* orbits = dynamic_cast<const PeriodicOrbit*>(&problem);
    if (orbits == nullptr || !(std::abs(problem.apart(end.unknowns, end.regime)) < nothing)) return;
    const int rounds = orbits->is_two_rounds(end.unknowns, end.regime) ? 2 : 1;
    ends_.push_back({end.parameters, orbits->period(end.unknowns, end.parameters) / rounds});
  }

  std::vector<OrbitStart> starts_at(const Waiting& from) const {
    const BranchPoint& point = from.point;
    std::vector<OrbitStart> starts;
    if (point.type == PointType::hopf) {
      for (const CycleStart& one :
           cycles_from_hopf(from.field, {point.unknowns, point.parameters, point.regime}, orbits_))
        starts.push_back({one.problem, one.guess, one.both_ways});
    } else if (point.type == PointType::period_doubling) {
      if (from.doublings >= orbits_.doublings) return starts;
      const auto& orbits = dynamic_cast<const PeriodicOrbit&>(*from.problem);
      if (auto start = orbit_from_doubling(orbits, parameter_, point)) starts.push_back(std::move(*start));
    } else if (times_marked(mark(*from.problem, point)) <= 1) {  // else both of its branches are known
      if (auto start = orbit_from_branch_point(*from.problem, options_.parameter, point, options_.tolerances))
        starts.push_back(std::move(*start));
    }
    return starts;
  }

  /// Whether a branch has come to where this one begins.
  bool is_end_of(const Waiting& from, const OrbitStart& start) const {
    if (from.point.type == PointType::branch_point) return false;
    const auto& orbits = dynamic_cast<const PeriodicOrbit&>(from.problem ? *from.problem : *start.problem);
    const Vector& u = from.problem ? from.point.unknowns : start.guess.unknowns;
    return is_reached(from.point.parameters, orbits.period(u, from.point.parameters));
  }

  /// Whether a branch has ended there, on a cycle of this period or on an equilibrium.
  bool is_reached(const Vector& parameters, double period) const {
    constexpr double near = 1e-3;  // branches end this short of it, and nearer by the square of their size
    return std::any_of(ends_.begin(), ends_.end(), [&](const End& end) {
      const Vector size = parameters.cwiseAbs().cwiseMax(near);
      return (end.parameters - parameters).cwiseQuotient(size).lpNorm<Eigen::Infinity>() < near &&
             std::abs(end.period - period) < near * period;
    });
  }

  Mark mark(const OrbitProblem& problem, const BranchPoint& point) const {
    return {point.type, mark_of(problem, point, parameter_)};
  }

  long times_marked(const Mark& at) const {
    return std::count_if(marks_.begin(), marks_.end(), [&](const Mark& other) {
      return other.type == at.type && is_same(at.orbit, other.orbit);
    });
  }

  struct End {
    Vector parameters;
    double period;
  };

  TraceOptions options_;
  OrbitOptions orbits_;
  const Observer& observer_;
  Index parameter_;
  TimeBudget time_;
  std::vector<OrbitBranch> found_;
  std::deque<Waiting> waiting_;
  std::vector<Mark> marks_;
  std::vector<End> ends_;
  bool interrupted_ = false;
};

std::vector<CycleBranch> cycle_branches(std::vector<OrbitBranch> orbits) {
  std::vector<CycleBranch> all;
  for (OrbitBranch& one : orbits) all.push_back(cycle_branch(std::move(one)));
  return all;
}

}  // namespace

std::vector<OrbitBranch> trace_connected_orbits(const OrbitStart& start, const TraceOptions& options,
                                                const OrbitOptions& orbits, const Observer& observer) {
  OrbitNetwork network(start.problem->field(), options, orbits, observer);
  network.begin(start);
  network.follow_waiting();
  return network.take();
}

std::vector<CycleBranch> trace_connected_cycles(const CycleStart& start, const TraceOptions& options,
                                                const CycleOptions& cycles, const Observer& observer) {
  return cycle_branches(trace_connected_orbits({start.problem, start.guess, start.both_ways},
                                               of_cycles(start.problem->field(), options), cycles, observer));
}

std::vector<CycleBranch> trace_cycles_leaving(const std::shared_ptr<const Field>& field,
                                              const std::vector<Branch>& equilibria,
                                              const TraceOptions& options, const CycleOptions& cycles,
                                              const Observer& observer, bool follow) {
  OrbitNetwork network(*field, of_cycles(*field, options), cycles, observer);
  for (const Branch& branch : equilibria) {
    for (const BranchPoint& point : branch.points) {
      if (point.type == PointType::hopf) network.expect(field, point);
    }
  }
  network.follow_waiting(follow);
  return cycle_branches(network.take());
}

}  // namespace arcslip::continuation
