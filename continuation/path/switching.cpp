#include "arcslip/continuation/path/switching.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>

#include "arcslip/continuation/events/corner.hpp"
#include "arcslip/continuation/path/symmetric_branches.hpp"
#include "arcslip/continuation/points/multiple_point.hpp"
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
  Map(const Problem& problem, Index parameter, const Tolerances& tolerances,
      std::vector<Symmetry> symmetries = {})
      : problem_(problem),
        parameter_(parameter),
        tolerances_(tolerances),
        symmetries_(std::move(symmetries)) {}

  Way way(const Vector& unknowns, const Vector& parameters, const Vector& direction) const {
    const Index n = unknowns.size();
    Vector scale(n);
    Vector parameter_scale(parameters.size());
    problem_.scale(unknowns, parameters, scale, parameter_scale);
    Vector all(n + 1);
    all << scale * std::sqrt(static_cast<double>(n)), parameter_scale(parameter_);
    Way result{Vector(n + 1), direction.cwiseQuotient(all).normalized()};
    result.place << unknowns, parameters(parameter_);
    result.place = result.place.cwiseQuotient(all);
    return result;
  }

  Way way(const Guess& guess) const { return way(guess.unknowns, guess.parameters, guess.direction); }

  bool gone(const Way& way) const {
    return std::any_of(gone_.begin(), gone_.end(), [&](const Way& other) {
      return (other.place - way.place).norm() < tolerances_.same_point &&
             (other.direction - way.direction).norm() < tolerances_.same_direction;
    });
  }

  /// Whether it or an image of it was gone.
  bool gone(const Vector& unknowns, const Vector& parameters, const Vector& direction) const {
    if (gone(way(unknowns, parameters, direction))) return true;
    const Index n = unknowns.size();
    return std::any_of(symmetries_.begin(), symmetries_.end(), [&](const Symmetry& symmetry) {
      Vector image = direction;
      image.head(n) = symmetry.map * direction.head(n);
      return gone(way(symmetry.map * unknowns, parameters, image));
    });
  }

  void go(Way way) { gone_.push_back(std::move(way)); }

  /// Both ways through a special point, forward and back.
  void pass(const BranchPoint& point) {
    go(way(point.unknowns, point.parameters, point.tangent));
    go(way(point.unknowns, point.parameters, -point.arriving()));
  }

 private:
  const Problem& problem_;
  Index parameter_;
  Tolerances tolerances_;
  std::vector<Symmetry> symmetries_;
  std::vector<Way> gone_;
};

bool meets_others(const BranchPoint& point) {
  return point.type == PointType::branch_point || point.type == PointType::regime_switch;
}

/// A point that is found wherever a branch is traced from.
bool is_landmark(const BranchPoint& point) {
  return point.type == PointType::fold || point.type == PointType::peak || point.type == PointType::trough;
}

/// A branch point as its own conditions have it, which hold it also across both branches, where a point of
/// one of them alone is known to the root of rounding; the point itself where they do not find it there.
Guess settled(const Problem& problem, Index active, const BranchPoint& point, const Tolerances& tolerances) {
  Guess at{point.unknowns, point.parameters, point.regime, {}};
  BranchPointProblem conditions(problem, active);
  const auto located = locate(conditions, {at.unknowns, at.parameters, at.regime, Vector::Zero(1)});
  if (!located) return at;
  Vector scale(at.unknowns.size());
  Vector parameter_scale(at.parameters.size());
  problem.scale(at.unknowns, at.parameters, scale, parameter_scale);
  const BasePoint& found = located->point;
  const auto far = [](const Vector& a, const Vector& b, const Vector& size) {
    return (a - b).cwiseQuotient(size).lpNorm<Eigen::Infinity>();
  };
  const bool is_there = far(found.unknowns, at.unknowns, scale) < tolerances.same_point &&
                        std::abs(found.parameters(active) - at.parameters(active)) <
                            tolerances.same_point * parameter_scale(active);
  Vector before(problem.size());
  Vector after(problem.size());
  const bool has_values = problem.evaluate(at.unknowns, at.parameters, at.regime, {&before}) &&
                          problem.evaluate(found.unknowns, found.parameters, at.regime, {&after});
  if (!is_there || !has_values || after.lpNorm<Eigen::Infinity>() > before.lpNorm<Eigen::Infinity>())
    return at;
  return {found.unknowns, found.parameters, at.regime, {}};
}

/// Both ways along each other branch through a branch point, from where its own conditions have it; along
/// this one as well, but where others are told by it. `untold` becomes true where the branches are not known.
std::vector<Guess> ways_through(const Problem& problem, Index active, const BranchPoint& point,
                                const Tolerances& tolerances, bool& untold) {
  const Guess along{point.unknowns, point.parameters, point.regime, point.tangent};
  const auto multiple = multiple_point(problem, active, along, tolerances);
  const Guess at = multiple ? multiple->at : settled(problem, active, point, tolerances);
  std::vector<Vector> directions;
  if (multiple) {
    directions = multiple->directions;
    untold = untold || directions.empty() || !multiple->is_whole;
  } else if (const auto form = branch_point_form(problem, active, at, tolerances)) {
    directions.assign(form->directions.begin(), form->directions.end());
  }
  std::vector<Guess> ways;
  for (const Vector& direction : directions) {
    if (direction.size() == 0) continue;
    ways.push_back({at.unknowns, at.parameters, at.regime, direction});
    ways.push_back({at.unknowns, at.parameters, at.regime, -direction});
  }
  return ways;
}

/// What leaves a special point among the solutions of one problem, without its own branch: where rounding
/// moves the point off by its root it turns that one's tangent by far more, so that the nearest way is meant.
std::vector<Guess> other_ways_in(const Problem& problem, Index active, const BranchPoint& point,
                                 const Tolerances& tolerances, bool& untold) {
  std::vector<Guess> ways;
  if (point.type == PointType::branch_point) {
    ways = ways_through(problem, active, point, tolerances, untold);
  } else if (point.type == PointType::regime_switch) {
    ways = leaving_pieces(problem, active, {point.unknowns, point.parameters, point.regime, {}}, tolerances);
  }
  const Map map(problem, active, tolerances);
  const double turned = point.type == PointType::branch_point ? 0.02 : tolerances.same_direction;
  for (const Vector& own : {point.tangent, Vector(-point.arriving())}) {
    const Vector direction = map.way(point.unknowns, point.parameters, own).direction;
    const auto apart = [&](const Guess& way) { return (map.way(way).direction - direction).norm(); };
    const auto nearest = std::ranges::min_element(ways, {}, apart);
    if (nearest != ways.end() && apart(*nearest) < turned) ways.erase(nearest);
  }
  return ways;
}

/// What leaves a special point, whatever symmetries it loses there.
std::vector<Guess> all_other_ways(SymmetricBranches& symmetric, Index active, const BranchPoint& point,
                                  const Tolerances& tolerances, bool& untold) {
  if (point.type != PointType::branch_point)
    return other_ways_in(symmetric.whole(), active, point, tolerances, untold);
  std::vector<Guess> ways;
  for (const Problem* problem : symmetric.leaving(point)) {
    for (Guess& way : other_ways_in(*problem, active, point, tolerances, untold))
      ways.push_back(std::move(way));
  }
  return ways;
}

/// Whether points are a solution, at the same value of the parameter. Keeps a reference to it.
class IsSolution {
 public:
  IsSolution(const Problem& problem, const Guess& solution, const TraceOptions& options)
      : solution_(solution),
        active_(index_of(problem.parameter_names(), options.parameter)),
        same_(options.tolerances.same_solution),
        scale_(solution.unknowns.size()) {
    Vector parameter_scale(solution.parameters.size());
    problem.scale(solution.unknowns, solution.parameters, scale_, parameter_scale);
  }

  bool operator()(const BranchPoint& point) const {
    return point.parameters(active_) == solution_.parameters(active_) && point.regime == solution_.regime &&
           (point.unknowns - solution_.unknowns).cwiseQuotient(scale_).lpNorm<Eigen::Infinity>() < same_;
  }

 private:
  const Guess& solution_;
  Index active_;
  double same_;
  Vector scale_;
};

/// Whether one of the branches passes the solution, or its image under one of the options' symmetries.
bool passes(const std::vector<Branch>& branches, const Problem& problem, const Guess& solution,
            const TraceOptions& options) {
  std::vector<Guess> images{solution};
  for (const Symmetry& symmetry : options.symmetries) {
    images.push_back(solution);
    images.back().unknowns = symmetry.map * solution.unknowns;
  }
  return std::any_of(images.begin(), images.end(), [&](const Guess& image) {
    const IsSolution is_solution(problem, image, options);
    return std::any_of(branches.begin(), branches.end(), [&](const Branch& branch) {
      return std::any_of(branch.points.begin(), branch.points.end(), is_solution);
    });
  });
}

/// What is said where several eigenvalues vanish at once and directions are not told.
std::string untold_branches(const std::string& parameter, double at) {
  return fmt::format(
      "at {} = {:.10g} several eigenvalues vanish at once, and not all branches that leave there are told by "
      "derivatives of the second and third order; others were not followed",
      parameter, at);
}

/// With a point of each branch at the solution's value of the parameter.
TraceOptions landing_on(const Guess& solution, const Problem& problem, TraceOptions options) {
  options.stop_at.push_back(solution.parameters(index_of(problem.parameter_names(), options.parameter)));
  return options;
}

/// Traces branches one after the other, each way once.
class Network {
 public:
  Network(const Problem& problem, const TraceOptions& options, const Observer& observer)
      : problem_(problem),
        active_(index_of(problem.parameter_names(), options.parameter)),
        symmetric_(problem, options.tolerances),
        options_(with_symmetries(problem, options)),
        observer_(observer),
        time_(options_),
        map_(problem, active_, options.tolerances, options_.symmetries) {}

  /// Ways that leave the points of a branch, at branch points in both senses or, of images, in one.
  void leave(const std::vector<BranchPoint>& points, bool images = false) {
    for (const BranchPoint& point : points) {
      if (meets_others(point) || is_landmark(point)) map_.pass(point);
    }
    for (const BranchPoint& point : points) {
      if (!meets_others(point)) continue;
      bool untold = false;
      std::vector<Guess> ways = all_other_ways(symmetric_, active_, point, options_.tolerances, untold);
      if (untold) untold_.push_back(point.parameters(active_));
      if (images && point.type == PointType::branch_point && ways.size() > 1) ways.resize(1);
      for (Guess& way : ways) waiting_.push_back(std::move(way));
    }
  }

  void follow(const Guess& guess) {
    Guess start = guess;
    const Problem& within = symmetric_.of(start);
    take(within, trace(within, start, time_.rest(), observer_));
  }

  /// Both ways, unless a branch has come by.
  void follow_both(const Guess& solution) {
    if (interrupted_ || passes(branches_, problem_, solution, options_)) return;
    Guess start = solution;
    const Problem& within = symmetric_.of(start);
    Branch branch = trace_both(within, start, landing_on(solution, problem_, time_.rest()), observer_);
    const IsSolution is_solution(problem_, start, options_);
    std::vector<BranchPoint> here;
    std::copy_if(branch.points.begin(), branch.points.end(), std::back_inserter(here), is_solution);
    take(within, std::move(branch));
    for (const BranchPoint& point : here) map_.pass(point);
  }

  std::vector<Branch> all() {
    while (!waiting_.empty() && !interrupted_) {
      const Guess next = std::move(waiting_.front());
      waiting_.pop_front();
      if (map_.gone(next.unknowns, next.parameters, next.direction)) continue;
      if (branches_.size() >= options_.max_branches) {
        branches_.back().warn(more_branches(branches_.size(), options_.parameter, next.parameters(active_)));
        break;
      }
      map_.go(map_.way(next));
      follow(next);
    }
    return std::move(branches_);
  }

 private:
  void take(const Problem& within, Branch branch) {
    interrupted_ = is_unfinished(branch.stop);
    if (!interrupted_ && is_known(branch)) return;
    if (branch.stop == Stop::closed_loop) map_.pass(branch.points.back());
    if (branch.stop == Stop::own_image) pass_settled(within, branch.points.back());
    leave(branch.points);
    for (const double at : untold_) branch.warn(untold_branches(options_.parameter, at));
    untold_.clear();
    branches_.push_back(std::move(branch));
  }

  /// The way along which a branch became its own image, both ways, as other branches through the point know
  /// it.
  void pass_settled(const Problem& within, const BranchPoint& point) {
    double straightest = 0.5;
    std::optional<Way> best;
    bool untold = false;
    for (const Guess& guess : ways_through(within, active_, point, options_.tolerances, untold)) {
      Way way = map_.way(guess);
      const Way arrival = map_.way(guess.unknowns, guess.parameters, point.arriving());
      const double along = std::abs(way.direction.dot(arrival.direction));
      if (along < straightest) continue;
      straightest = along;
      best = std::move(way);
    }
    if (!best) return;
    map_.go(*best);
    best->direction = -best->direction;
    map_.go(*best);
  }

  /// Whether it is a piece, or an image, of one that was traced, which had passed the point where it begins
  /// without finding it.
  bool is_known(const Branch& branch) const {
    std::size_t landmarks = 0;
    for (const BranchPoint& point : branch.points) {
      if (!is_landmark(point)) continue;
      if (!map_.gone(point.unknowns, point.parameters, point.tangent)) return false;
      ++landmarks;
    }
    return landmarks > 0;
  }

  static TraceOptions with_symmetries(const Problem& problem, TraceOptions options) {
    options.symmetries = problem.symmetries();
    return options;
  }

  const Problem& problem_;
  Index active_;
  SymmetricBranches symmetric_;
  TraceOptions options_;
  const Observer& observer_;
  TimeBudget time_;
  Map map_;
  std::vector<Branch> branches_;
  std::deque<Guess> waiting_;
  std::vector<double> untold_;  // values of the parameter where branches meet that are not known
  bool interrupted_ = false;
};

}  // namespace

std::vector<Guess> other_ways(const Problem& problem, const std::string& parameter, const BranchPoint& point,
                              const Tolerances& tolerances) {
  SymmetricBranches symmetric(problem, tolerances);
  bool untold = false;
  return all_other_ways(symmetric, index_of(problem.parameter_names(), parameter), point, tolerances, untold);
}

std::string more_branches(std::size_t followed, const std::string& parameter, double at) {
  return fmt::format("max_branches = {} were followed; what leaves at {} = {:.10g} was not", followed,
                     parameter, at);
}

std::vector<Branch> trace_connected(const Problem& problem, const Guess& guess, const TraceOptions& options,
                                    const Observer& observer) {
  Network network(problem, options, observer);
  network.follow(guess);
  return network.all();
}

std::vector<Branch> trace_leaving(const Problem& problem, const std::vector<BranchPoint>& points,
                                  const TraceOptions& options, const FollowOptions& follow,
                                  const Observer& observer) {
  Network network(problem, options, observer);
  network.leave(points, follow.images);
  return network.all();
}

std::vector<Branch> trace_connected_through(const Problem& problem, const std::vector<Guess>& solutions,
                                            const TraceOptions& options, const Observer& observer) {
  Network network(problem, options, observer);
  for (const Guess& solution : solutions) network.follow_both(solution);
  return network.all();
}

std::vector<Branch> trace_through(const Problem& problem, const std::vector<Guess>& solutions,
                                  const TraceOptions& options, const Observer& observer) {
  const TimeBudget time(options);
  std::vector<Branch> branches;
  for (const Guess& solution : solutions) {
    if (passes(branches, problem, solution, options)) continue;
    branches.push_back(trace_both(problem, solution, landing_on(solution, problem, time.rest()), observer));
    if (is_unfinished(branches.back().stop)) break;
  }
  return branches;
}

}  // namespace arcslip::continuation
