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
        solver_(at_.make_solver(1)),
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
      across_(continuation::index_of(response_.problem->parameter_names(), response_.across)),
      objective_(
          continuation::index_of(continuation::observable_names(*response_.problem), response_.objective)) {
  const std::vector<continuation::Observable> all = response_.problem->observables();
  const continuation::Observable& wanted = all[static_cast<std::size_t>(objective_)];
  if (!wanted.has_gradient || wanted.period > 0)
    throw std::invalid_argument(fmt::format("ResponsePeaks: {} has no {}", response_.objective,
                                            wanted.has_gradient ? "height" : "gradient"));
  slopes_ = std::make_shared<Slopes>(*response_.problem, along_, across_, objective_);
  response_.options.stop_at.clear();
  response_.options.stop_after.clear();
  response_.options.extrema_of = {response_.objective};
  response_.options.branch_point_pairs = false;  // a response under a given load has no others beside it
  first_ = {response_.from, {response_.start}};
  last_ = {response_.to, {}};
}

std::vector<ResponsePeak> ResponsePeaks::at(double across) {
  if (response_.is_polished) {
    if (std::optional<std::vector<ResponsePeak>> peaks = peaks_of(traced_at(across, true), true))
      return *std::move(peaks);
  }
  const Branch branch = traced_at(across, false);
  std::vector<ResponsePeak> peaks = *peaks_of(branch, false);
  if (!peaks.empty()) return peaks;
  const ResponsePeak first = edge(guess_at(branch.points.front())).peak;  // flat but for rounding
  const ResponsePeak last = edge(guess_at(branch.points.back())).peak;
  return {first.log_height > last.log_height ? first : last};
}

/// Whether the height rises from a point to a peak as to one that is level there, with no other between.
bool ResponsePeaks::rises_to(const BranchPoint& point, const ResponsePeak& peak) const {
  constexpr double unlike = 0.2;    // of what the slope at the point tells
  constexpr double nothing = 1e-9;  // of ln height
  continuation::Gradient gradient{Vector::Zero(point.unknowns.size()), Vector::Zero(point.parameters.size())};
  const double height =
      response_.problem->observe(point.unknowns, point.parameters, point.regime, objective_, gradient);
  const double per_place = point.tangent(point.tangent.size() - 1);
  const double slope = continuation::rate(gradient, along_, point.tangent) / (height * per_place);
  const double expected = 0.5 * slope * (peak.place - point.parameters(along_));
  const double risen = peak.log_height - std::log(height);
  return std::abs(risen - expected) <= unlike * std::abs(risen) + nothing;
}

/// Those on the points of a branch; or next to these, if they were located roughly, and none where there are
/// none or one is not found there.
std::optional<std::vector<ResponsePeak>> ResponsePeaks::peaks_of(const Branch& branch, bool is_rough) {
  std::vector<ResponsePeak> peaks;
  const auto& points = branch.points;
  const auto add_end = [&](const BranchPoint& end) {
    if (const auto peak = rising_edge(guess_at(end))) peaks.push_back(*peak);
  };
  add_end(points.front());
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    if (points[i].type != PointType::peak) continue;
    if (!is_rough) {
      add_peak(branch, i, peaks);
      continue;
    }
    const std::optional<ResponsePeak> found = next_to(guess_at(points[i]), ResponsePeakSite::smooth);
    const auto leads_there = [&](const BranchPoint& point) { return rises_to(point, *found); };
    if (!found || !std::all_of(points.begin() + static_cast<std::ptrdiff_t>(i) - 1,
                               points.begin() + static_cast<std::ptrdiff_t>(i) + 2, leads_there))
      return std::nullopt;
    peaks.push_back(*found);
  }
  add_end(points.back());
  if (is_rough && peaks.empty()) return std::nullopt;
  return peaks;
}

ResponsePeaks::Edge ResponsePeaks::edge(const Guess& at) {
  const Slopes::Values slopes = slopes_->at(at);
  return {{ResponsePeakSite::edge, at, at.parameters(along_), slopes.log_height,
           slopes.across * at.parameters(across_)},
          slopes.along};
}

/// That end, if the height rises towards it.
std::optional<ResponsePeak> ResponsePeaks::rising_edge(const Guess& at) {
  const Edge found = edge(at);
  const bool is_first = at.parameters(along_) == response_.from;
  return found.slope * (is_first ? -1 : 1) > 0 ? std::optional(found.peak) : std::nullopt;
}

bool ResponsePeaks::is_inside(const Guess& at) const {
  return crossed_border(*response_.problem, at.unknowns, at.parameters, at.regime,
                        response_.options.tolerances.both_sides) < 0;
}

std::optional<ResponsePeak> ResponsePeaks::edge_next_to(const Guess& guess) {
  const continuation::Solution solution = continuation::solve(*response_.problem, guess);
  const Guess at{solution.unknowns, guess.parameters, guess.regime, {}};
  if (solution.outcome != continuation::Correction::converged || !is_inside(at)) return std::nullopt;
  return rising_edge(at);
}

/// Where the height is level, by secants along the branch, with the branch's direction there.
std::optional<Guess> ResponsePeaks::level_next_to(const Guess& guess, Vector& direction) const {
  constexpr int most = 12;           // corrections
  constexpr double farthest = 0.05;  // at once, in the problem's scale
  constexpr double settled = 1e-7;   // of the last correction but one, which leaves far less
  const continuation::Problem& problem = *response_.problem;
  continuation::Corrector corrector(problem, along_, {});
  continuation::CurvePoint origin = corrector.make_point();
  origin.unknowns = guess.unknowns;
  origin.parameters = guess.parameters;
  origin.regime = guess.regime;
  corrector.set_scale(origin);
  const Vector by_parameter = Vector::Unit(problem.size() + 1, problem.size());
  if (corrector.linearise(origin, by_parameter) != continuation::Correction::converged) return std::nullopt;
  const Vector forward = corrector.direction().normalized();
  continuation::Gradient gradient{Vector::Zero(problem.size()), Vector::Zero(origin.parameters.size())};
  continuation::CurvePoint at = origin;
  double bend =
      -static_cast<double>(problem.size());  // d2L/ds2 of a single resonance, whose u is on a circle
  double last_slope = 0;
  double last_move = 0;
  bool is_settled = false;
  for (int i = 0; i < most; ++i) {
    corrector.difference(at, origin, direction);
    const double way = forward.dot(direction);
    if (corrector.correct(at, origin, forward, way, is_settled) != continuation::Correction::converged)
      return std::nullopt;
    direction = corrector.direction();
    if (is_settled) {
      direction = direction.cwiseProduct(origin.scale);
      return Guess{at.unknowns, at.parameters, at.regime, {}};
    }
    const double height = problem.observe(at.unknowns, at.parameters, at.regime, objective_, gradient);
    const double slope = continuation::rate(gradient, along_, origin.scale, direction) / height;
    if (i > 0) bend = (slope - last_slope) / last_move;
    if (!(height > 0 && bend < 0)) return std::nullopt;
    const double move = std::clamp(-slope / bend, -farthest, farthest);
    is_settled = std::abs(move) <= settled;
    last_slope = slope;
    last_move = move;
    at.unknowns += move * direction.head(problem.size()).cwiseProduct(origin.scale.head(problem.size()));
    at.parameters(along_) += move * direction(problem.size()) * origin.scale(problem.size());
  }
  return std::nullopt;
}

std::optional<ResponsePeak> ResponsePeaks::next_to(const Guess& guess, ResponsePeakSite site) {
  if (site == ResponsePeakSite::corner) return std::nullopt;
  if (site == ResponsePeakSite::edge) return edge_next_to(guess);
  Vector direction(response_.problem->size() + 1);
  const std::optional<Guess> at = level_next_to(guess, direction);
  if (!at || !is_inside(*at)) return std::nullopt;
  const double place = at->parameters(along_);
  if (!(place > response_.from && place < response_.to)) return std::nullopt;
  const Slopes::Values slopes = slopes_->at(*at, &direction);
  return ResponsePeak{ResponsePeakSite::smooth, *at, place, slopes.log_height,
                      slopes.across * at->parameters(across_)};
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
