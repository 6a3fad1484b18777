#include "arcslip/continuation/path/switching.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "arcslip/continuation/events/corner.hpp"
#include "arcslip/continuation/points/normal_form.hpp"

namespace arcslip::continuation {
namespace {

/// A direction from a point, of unit length in the problem's scale there.
struct Way {
  Vector place;  ///< (u, p_a) over the scale
  Vector direction;
};

/// Remembers the ways that were gone already.
class Map {
 public:
  Map(const Problem& problem, Index parameter, const Tolerances& tolerances)
      : problem_(problem), parameter_(parameter), tolerances_(tolerances) {}

  Way way(const Vector& unknowns, const Vector& parameters, const Vector& direction) const {
    const Index n = unknowns.size();
    Vector scale(n);
    Vector parameter_scale(parameters.size());
    problem_.scale(unknowns, parameters, scale, parameter_scale);
    Vector all(n + 1);
    all << scale * std::sqrt(static_cast<double>(n)), parameter_scale(parameter_);
    Way result;
    result.place.resize(n + 1);
    result.place << unknowns, parameters(parameter_);
    result.place = result.place.cwiseQuotient(all);
    result.direction = direction.cwiseQuotient(all).normalized();
    return result;
  }

  bool gone(const Way& way) const {
    return std::any_of(gone_.begin(), gone_.end(), [&](const Way& other) {
      return (other.place - way.place).norm() < tolerances_.same_point &&
             (other.direction - way.direction).norm() < tolerances_.same_direction;
    });
  }

  void go(Way way) { gone_.push_back(std::move(way)); }

  /// Both ways through a special point, forward and back.
  void pass(const BranchPoint& point) {
    const Vector& arrival = point.arrival.size() > 0 ? point.arrival : point.tangent;
    go(way(point.unknowns, point.parameters, point.tangent));
    go(way(point.unknowns, point.parameters, -arrival));
  }

 private:
  const Problem& problem_;
  Index parameter_;
  Tolerances tolerances_;
  std::vector<Way> gone_;
};

bool meets_others(const BranchPoint& point) {
  return point.type == PointType::branch_point || point.type == PointType::regime_switch;
}

}  // namespace

std::vector<Guess> other_ways(const Problem& problem, const std::string& parameter, const BranchPoint& point,
                              const Tolerances& tolerances) {
  const Index active = index_of(problem.parameter_names(), parameter);
  const Guess at{point.unknowns, point.parameters, point.regime, {}};
  std::vector<Guess> ways;
  if (point.type == PointType::branch_point) {
    const auto form = branch_point_form(problem, active, at, tolerances);
    if (!form) return {};
    for (const Vector& direction : form->directions) {
      if (direction.size() == 0) continue;
      ways.push_back({at.unknowns, at.parameters, at.regime, direction});
      ways.push_back({at.unknowns, at.parameters, at.regime, -direction});
    }
  } else if (point.type == PointType::regime_switch) {
    ways = leaving_pieces(problem, active, at, tolerances);
  }
  Map map(problem, active, tolerances);
  map.pass(point);
  std::erase_if(ways, [&](const Guess& guess) {
    return map.gone(map.way(guess.unknowns, guess.parameters, guess.direction));
  });
  return ways;
}

std::vector<Branch> trace_connected(const Problem& problem, const Guess& guess, const TraceOptions& options,
                                    const FollowOptions& follow, const Observer& observer) {
  const TimeBudget time(options);
  Map map(problem, index_of(problem.parameter_names(), options.parameter), options.tolerances);
  std::vector<Branch> branches;
  std::deque<Guess> waiting;
  bool interrupted = false;
  const auto collect = [&](Branch branch) {
    interrupted = is_unfinished(branch.stop);
    for (const BranchPoint& point : branch.points) {
      if (meets_others(point)) map.pass(point);
    }
    for (const BranchPoint& point : branch.points) {
      if (!meets_others(point)) continue;
      for (Guess& way : other_ways(problem, options.parameter, point, options.tolerances))
        waiting.push_back(std::move(way));
    }
    branches.push_back(std::move(branch));
  };
  collect(trace(problem, guess, options, observer));
  while (!waiting.empty() && branches.size() < follow.max_branches && !interrupted) {
    const Guess next = std::move(waiting.front());
    waiting.pop_front();
    Way way = map.way(next.unknowns, next.parameters, next.direction);
    if (map.gone(way)) continue;
    map.go(std::move(way));
    collect(trace(problem, next, time.rest(), observer));
  }
  return branches;
}

std::vector<Branch> trace_through(const Problem& problem, const std::vector<Guess>& solutions,
                                  const TraceOptions& options, const Observer& observer) {
  const Index active = index_of(problem.parameter_names(), options.parameter);
  const TimeBudget time(options);
  std::vector<Branch> branches;
  const auto passed = [&](const Guess& solution) {
    Vector scale(solution.unknowns.size());
    Vector parameter_scale(solution.parameters.size());
    problem.scale(solution.unknowns, solution.parameters, scale, parameter_scale);
    const auto here = [&](const BranchPoint& point) {
      return point.parameters(active) == solution.parameters(active) && point.regime == solution.regime &&
             (point.unknowns - solution.unknowns).cwiseQuotient(scale).lpNorm<Eigen::Infinity>() <
                 options.tolerances.same_solution;
    };
    return std::any_of(branches.begin(), branches.end(), [&](const Branch& branch) {
      return std::any_of(branch.points.begin(), branch.points.end(), here);
    });
  };
  for (const Guess& solution : solutions) {
    if (passed(solution)) continue;
    TraceOptions landing = time.rest();
    landing.stop_at.push_back(solution.parameters(active));
    branches.push_back(trace_both(problem, solution, landing, observer));
    if (is_unfinished(branches.back().stop)) break;
  }
  return branches;
}

}  // namespace arcslip::continuation
