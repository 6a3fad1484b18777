#include "arcslip/problems/ridges/response_peaks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/problem/linearization.hpp"

namespace arcslip::problems {
namespace {

using continuation::Branch;
using continuation::BranchPoint;
using continuation::Guess;
using continuation::PointType;

Guess guess_at(const BranchPoint& point) { return {point.unknowns, point.parameters, point.regime, {}}; }

bool same_place(const BranchPoint& a, const BranchPoint& b) {
  return a.parameters == b.parameters && a.unknowns == b.unknowns;
}

}  // namespace

std::size_t highest_of(const std::vector<ResponsePeak>& peaks) {
  const auto highest = std::max_element(
      peaks.begin(), peaks.end(), [](const auto& a, const auto& b) { return a.log_height < b.log_height; });
  return static_cast<std::size_t>(highest - peaks.begin());
}

/// Derivatives of L = ln g on the solutions, by both parameters.
class ResponsePeaks::Slopes {
 public:
  struct Values {
    double log_height;
    double along;   ///< dL/da at fixed b, or dL/ds where a direction is given
    double across;  ///< dL/db at fixed a, or at fixed s
  };

  Slopes(const continuation::Problem& problem, Index along, Index across, Index objective)
      : problem_(problem),
        along_(along),
        across_(across),
        objective_(objective),
        at_(problem),
        solver_(continuation::make_bordered_solver(problem.size(), 1, problem.sparse())),
        ones_(Vector::Ones(problem.size())) {
    gradient_.unknowns.setZero(problem.size());
    gradient_.parameters.setZero(static_cast<Index>(problem.parameter_names().size()));
  }

  /// With a direction t (n + 1), such as the response's own d(u, a)/ds, places are told by s = t.(u, a)/|t|^2
  /// instead of a, so that the response may be vertical; at a smooth peak dL/db is the same with any of them.
  Values at(const Guess& guess, const Vector* direction = nullptr) {
    const Index n = problem_.size();
    const double height =
        problem_.observe(guess.unknowns, guess.parameters, guess.regime, objective_, gradient_);
    if (!(height > 0)) throw std::runtime_error("the objective is not positive");
    if (!at_.evaluate(guess.unknowns, guess.parameters, guess.regime))
      throw std::runtime_error("a peak cannot be evaluated");
    at_.fill(*solver_, ones_);
    solver_->columns().col(0) = at_.parameter_jacobian().col(along_);
    if (direction == nullptr) {
      solver_->rows().setZero();
      solver_->corner()(0, 0) = 1;
    } else {
      const Vector row = *direction / direction->squaredNorm();
      solver_->rows().row(0) = row.head(n).transpose();
      solver_->corner()(0, 0) = row(n);
    }
    if (solver_->factor() == 0) throw std::runtime_error("the response is singular at a peak");
    return {std::log(height), rate(solved(Vector::Unit(n + 1, n))) / height,
            (rate(solved(crossing())) + gradient_.parameters(across_)) / height};
  }

 private:
  Vector solved(Vector right) {
    solver_->solve(right);
    return right;
  }

  /// That of g as (u, a) change.
  double rate(const Vector& change) const { return continuation::rate(gradient_, along_, change); }

  Vector crossing() const {
    Vector right(problem_.size() + 1);
    right << -at_.parameter_jacobian().col(across_), 0;
    return right;
  }

  const continuation::Problem& problem_;
  Index along_;
  Index across_;
  Index objective_;
  continuation::Linearization at_;
  std::unique_ptr<continuation::BorderedSolver> solver_;
  Vector ones_;
  continuation::Gradient gradient_;
};

ResponsePeaks::ResponsePeaks(PeakedResponse response)
    : response_(std::move(response)),
      along_(continuation::index_of(response_.problem->parameter_names(), response_.along)),
      across_(continuation::index_of(response_.problem->parameter_names(), response_.across)) {
  const std::vector<continuation::Observable> all = response_.problem->observables();
  const Index objective =
      continuation::index_of(continuation::observable_names(*response_.problem), response_.objective);
  const continuation::Observable& wanted = all[static_cast<std::size_t>(objective)];
  if (!wanted.has_gradient || wanted.period > 0)
    throw std::invalid_argument(fmt::format("ResponsePeaks: {} has no {}", response_.objective,
                                            wanted.has_gradient ? "height" : "gradient"));
  slopes_ = std::make_shared<Slopes>(*response_.problem, along_, across_, objective);
  response_.options.stop_at.clear();
  response_.options.stop_after.clear();
  response_.options.extrema_of = {response_.objective};
  response_.options.branch_point_pairs = false;  // a response under a given load has no others beside it
  starts_.push_back(response_.start);
}

/// The solution at the first value of `along`, traced over `across` from the nearest one that is known.
const Guess& ResponsePeaks::start(double across) {
  const auto value = [&](const Guess& guess) { return guess.parameters(across_); };
  auto place = std::lower_bound(starts_.begin(), starts_.end(), across,
                                [&](const Guess& guess, double wanted) { return value(guess) < wanted; });
  if (place != starts_.end() && value(*place) == across) return *place;
  auto near = place;
  if (place == starts_.end() ||
      (place != starts_.begin() && across / value(*(place - 1)) < value(*place) / across))
    near = place - 1;
  constexpr double beside = 1e-6;  // too near for steps between the two
  if (std::abs(across / value(*near) - 1) < beside) {
    Guess guess = *near;
    guess.parameters(across_) = across;
    const continuation::Solution solution = continuation::solve(*response_.problem, guess);
    guess.unknowns = solution.unknowns;
    const double on_border = response_.options.tolerances.both_sides;
    if (solution.outcome == continuation::Correction::converged &&
        crossed_border(*response_.problem, guess.unknowns, guess.parameters, guess.regime, on_border) < 0) {
      return *starts_.insert(place, std::move(guess));
    }
  }
  continuation::TraceOptions options = response_.options;
  options.parameter = response_.across;
  options.from = value(*near);
  options.to = across;
  options.extrema_of.clear();
  const Branch way = trace(*response_.problem, *near, options);
  if (way.stop == continuation::Stop::time_limit || way.stop == continuation::Stop::interrupted)
    throw continuation::Unfinished(way.stop, way.explanation);
  if (!way.complete() || way.points.back().parameters(across_) != across) {
    throw std::runtime_error(fmt::format("at {} = {:.10g} no way to {} = {:.10g}: {}", response_.along,
                                         response_.from, response_.across, across, way.explanation));
  }
  return *starts_.insert(place, guess_at(way.points.back()));
}

Branch ResponsePeaks::trace_over(double across, double longest) {
  continuation::TraceOptions options = response_.options;
  options.parameter = response_.along;
  options.from = response_.from;
  options.to = response_.to;
  options.max_step = longest;
  ++traced_;
  return trace(*response_.problem, start(across), options);
}

Branch ResponsePeaks::response_at(double across) {
  Branch branch = trace_over(across, response_.options.max_step);
  if (branch.stop == continuation::Stop::time_limit || branch.stop == continuation::Stop::interrupted)
    throw continuation::Unfinished(branch.stop, branch.explanation);
  constexpr double finer = 0.2;  // of the longest step: other points, so that a chance is not met again
  if (!branch.complete()) branch = trace_over(across, finer * response_.options.max_step);
  if (!branch.complete() || branch.points.back().parameters(along_) != response_.to) {
    throw std::runtime_error(fmt::format("the response at {} = {:.10g} could not be traced: {}",
                                         response_.across, across, branch.explanation));
  }
  return branch;
}

std::vector<ResponsePeak> ResponsePeaks::at(double across) {
  const Branch branch = response_at(across);
  const Edge first = edge(branch.points.front());
  const Edge last = edge(branch.points.back());
  std::vector<ResponsePeak> peaks;
  if (first.slope < 0) peaks.push_back(first.peak);
  for (std::size_t i = 1; i + 1 < branch.points.size(); ++i) {
    if (branch.points[i].type == PointType::peak) add_peak(branch, i, peaks);
  }
  if (last.slope > 0) peaks.push_back(last.peak);
  if (peaks.empty())  // flat but for rounding
    peaks.push_back((first.peak.log_height > last.peak.log_height ? first : last).peak);
  return peaks;
}

ResponsePeaks::Edge ResponsePeaks::edge(const BranchPoint& point) {
  const Guess at = guess_at(point);
  const Slopes::Values slopes = slopes_->at(at);
  return {{ResponsePeakSite::edge, at, point.parameters(along_), slopes.log_height,
           slopes.across * point.parameters(across_)},
          slopes.along};
}

/// A solution next to a point, forwards (way = 1) or backwards (-1) along the response: reached from the
/// point there, for at a corner Newton's method may go to and fro between both sides.
Guess ResponsePeaks::beside(const Branch& branch, std::size_t i, int way) const {
  constexpr double nearest = 1e-9;  // in the problem's scale
  constexpr double farthest = 1e-6;
  const BranchPoint& point = branch.points[i];
  continuation::Corrector corrector(*response_.problem, along_, {});
  continuation::CurvePoint origin = corrector.make_point();
  origin.unknowns = point.unknowns;
  origin.parameters = point.parameters;
  origin.regime = point.regime;
  corrector.set_scale(origin);
  continuation::CurvePoint near = origin;
  Vector chord = Vector::Zero(point.tangent.size());
  for (std::size_t k = i; chord.norm() < nearest && k > 0 && k + 1 < branch.points.size();) {
    k = way > 0 ? k + 1 : k - 1;
    near.unknowns = branch.points[k].unknowns;
    near.parameters = branch.points[k].parameters;
    corrector.difference(near, origin, chord);
  }
  const Vector normal = chord.normalized();
  double distance = chord.norm();
  for (continuation::CurvePoint next = near; distance > 10 * nearest; distance *= 0.1) {
    corrector.difference(near, origin, chord);
    corrector.displace(origin, 0.1 * chord, next);
    if (corrector.correct(next, origin, normal, 0.1 * distance) != continuation::Correction::converged) break;
    near = next;
  }
  if (!(distance < farthest)) throw std::runtime_error("no solution beside a corner");
  return {near.unknowns, near.parameters, point.regime, {}};
}

/// A corner between two solutions that are next to it, with places told by a direction.
ResponsePeak ResponsePeaks::corner(const Guess& before, const Guess& behind, const Vector& direction) {
  const Slopes::Values left = slopes_->at(before, &direction);
  const Slopes::Values right = slopes_->at(behind, &direction);
  const double jump = right.along - left.along;
  const double moves = jump == 0 ? 0 : -(right.across - left.across) / jump;
  return {ResponsePeakSite::corner, before, before.parameters(along_), left.log_height,
          (left.across + left.along * moves) * before.parameters(across_)};
}

void ResponsePeaks::add_peak(const Branch& branch, std::size_t i, std::vector<ResponsePeak>& peaks) {
  const BranchPoint& point = branch.points[i];
  const Guess at = guess_at(point);
  // On a border: the regimes of both sides give the slopes of both.
  std::size_t first = i;
  std::size_t last = i;
  while (first > 0 && same_place(branch.points[first - 1], point)) --first;
  while (last + 1 < branch.points.size() && same_place(branch.points[last + 1], point)) ++last;
  for (std::size_t k = first; k <= last && first > 0; ++k) {
    if (branch.points[k].type != PointType::regime_switch) continue;
    Guess before = at;
    before.regime = branch.points[first - 1].regime;
    Guess behind = at;
    behind.regime = branch.points[k].regime;
    peaks.push_back(corner(before, behind, point.tangent));
    return;
  }
  const Slopes::Values slopes = slopes_->at(at, &point.tangent);
  // Along the branch, in its own scale, in which nothing changes by much within a step of 1.
  constexpr double flat = 1e-5;
  if (!(std::abs(slopes.along) > flat)) {
    peaks.push_back({ResponsePeakSite::smooth, at, point.parameters(along_), slopes.log_height,
                     slopes.across * point.parameters(across_)});
    return;
  }
  ResponsePeak found = corner(beside(branch, i, -1), beside(branch, i, 1), point.tangent);
  found.at = at;
  found.place = point.parameters(along_);
  found.log_height = slopes.log_height;
  peaks.push_back(found);
}

}  // namespace arcslip::problems
