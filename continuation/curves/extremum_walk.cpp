// Where a curve of extrema comes to a corner within its regime, which no border tells of: there the extremum
// is followed from response to response, in steps of the parameter.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/curves/extremum_tracer.hpp"
#include "arcslip/continuation/curves/response_extremum.hpp"

namespace arcslip::continuation {

/// The nearest value that wants a row on the way, which ends there at the latest.
double ExtremumTracer::next_value(double from, double to) const {
  std::vector<double> targets = rest().stop_at;
  targets.push_back(options_.from);
  targets.push_back(options_.to);
  for (const double target : targets)
    if ((target - from) * (to - target) > 0) to = target;
  const auto [low, high] = std::minmax(options_.from, options_.to);
  return std::clamp(to, std::min(low, from), std::max(high, from));
}

bool ExtremumTracer::is_asked_for(double value) const {
  return std::count(options_.stop_at.begin(), options_.stop_at.end(), value) > 0;
}

/// Ends on an end of the range.
bool ExtremumTracer::finish_walk(double value) {
  curve_.points.back().type = PointType::end;
  if (value == options_.to) {
    stop(Stop::reached_end, "the last value was reached");
  } else {
    stop(Stop::left_range, "the branch leaves the range at " + place());
  }
  return false;
}

/// The sense in which the parameter has changed up to the last row, by rows so far away that its rounding and
/// the attempts at a corner do not count.
double ExtremumTracer::way_so_far(double scale) const {
  constexpr double surely_apart = 1e-7;
  const double here = curve_.points.back().parameters(parameter_);
  double sense = 1;
  for (std::size_t i = curve_.points.size(); i-- > 0;) {
    const BranchPoint& point = curve_.points[i];
    const double change = here - point.parameters(parameter_);
    if (std::abs(change) > surely_apart * scale) return change > 0 ? sense : -sense;
    if (point.type == PointType::fold || point.type == PointType::corner_fold) sense = -sense;
  }
  return curve_.points.back().tangent(problem_.size()) > 0 ? 1 : -1;
}

/// Goes on as a smooth extremum from the last row. False where that leads nowhere, or back, and leaves no
/// row.
bool ExtremumTracer::smoothly_on(const BasePoint& here, double sense) {
  constexpr std::size_t enough = 5;  // rows
  const std::size_t before = curve_.points.size();
  smooth(guess_at(here, curve_.points.back().tangent), true, 1);
  const std::size_t added = curve_.points.size() - before;
  const std::size_t seen = before + std::min(added, enough) - 1;
  const bool ahead = added > 0 && (curve_.points[seen].parameters(parameter_) - value(here)) * sense > 0;
  const bool ends = is_end(curve_.stop) || near_ || told_to_end_ || curve_.stop == Stop::max_points;
  if (ahead && (added >= enough || ends)) return true;
  curve_.points.resize(before);
  near_ = false;
  stop(Stop::min_step, "the extremum is followed from response to response, at " + place());
  return false;
}

/// Whether the curve has turned where it stands before, a while ago: then it goes back on itself.
bool ExtremumTracer::has_turned_here() const {
  constexpr std::size_t while_ago = 5;  // rows
  constexpr double same = 1e-6;
  const BranchPoint& here = curve_.points.back();
  for (std::size_t i = 0; i + while_ago < curve_.points.size(); ++i) {
    const BranchPoint& point = curve_.points[i];
    const bool turns = point.type == PointType::corner_fold || point.type == PointType::fold;
    if (turns && steps(way(point, here), here).norm() < same) return true;
  }
  return false;
}

/// The extremum that the last rows belong to, as the last row. These may lie a little beside it, or where it
/// has vanished, as the conditions of an extremum are steep next to corners.
std::optional<BasePoint> ExtremumTracer::begin_walk(ResponseExtremum& extrema, bool& peak) {
  constexpr std::size_t most_back = 100;  // rows that may lie on none
  constexpr std::size_t most_beside = 20;
  constexpr double beside = 1e-8;  // on the response, in the scale: still the row's
  constexpr double same = 1e-10;   // the same: as well as points are located
  const auto nearest = [&](bool as_peak) {
    const BasePoint at = split(curve_.points.back());
    return extrema.begin(at) ? extrema.next_to(at, as_peak, beside) : std::nullopt;
  };
  std::optional<ResponseExtremum::Found> found;
  for (std::size_t back = 0; back < most_back && curve_.points.size() > 1 && !found; ++back) {
    const auto as_peak = nearest(true);
    const auto as_trough = nearest(false);
    peak = as_peak && (!as_trough || std::abs(as_peak->way) <= std::abs(as_trough->way));
    found = peak ? as_peak : as_trough;
    if (!found) curve_.points.pop_back();
  }
  if (!found || std::abs(found->way) <= same) return found ? std::optional(found->at) : std::nullopt;
  for (std::size_t i = 0; i < most_beside && curve_.points.size() > 1; ++i) {
    const auto here = nearest(peak);
    if (here && std::abs(here->way) <= same) break;
    curve_.points.pop_back();
  }
  BranchPoint corrected = row(found->at, PointType::regular);
  corrected.tangent = way(curve_.points.back(), corrected);
  corrected.tangent /= steps(corrected.tangent, corrected).norm();
  add(std::move(corrected));
  return found->at;
}

bool ExtremumTracer::walk() {
  constexpr double least_step = 1e-12;  // of the parameter, in its scale
  constexpr double first_step = 1e-9;
  constexpr double far =
      1e-5;  // on the response, in the scale: to the other extremum of a pair that vanishes
  ResponseExtremum extrema(base_, problem_.active(), *problem_.extremum_of());
  bool peak = false;
  const auto begin = begin_walk(extrema, peak);
  if (!begin) return false;
  BasePoint here = *begin;
  const BranchPoint last = curve_.points.back();
  const Index n = problem_.size();
  const double scale = 1 / steps(Vector::Ones(n + 1), last)(n);
  double sense = way_so_far(scale);
  Vector rate = Vector::Zero(n);  // of the unknowns over the parameter
  bool predicts = false;
  double step = first_step;
  int flips = 0;
  for (int walked = 0; std::ssize(curve_.points) < options_.max_points;) {
    const double from = value(here);
    const double to = next_value(from, from + sense * step * scale);
    if (to == from) return finish_walk(from);
    Guess guess = guess_at(here);
    guess.unknowns += rate * (to - from);
    guess.parameters(parameter_) = to;
    const double reach = 100 * std::abs(to - from) / scale;
    auto next = extrema.next_to(problem_.split(guess.unknowns, guess.parameters, here.regime), peak, reach);
    const bool inside = next && distance(next->at) >= 0;
    const bool in_window = next && next->at.parameters(problem_.active()) >= window_.low &&
                           next->at.parameters(problem_.active()) <= window_.high;
    if (next && inside && in_window) {
      const Guess there = guess_at(next->at);
      rate = (there.unknowns - guess_at(here).unknowns) / (to - from);
      BranchPoint point = row(next->at, is_asked_for(to) ? PointType::user : PointType::regular);
      point.tangent = way(curve_.points.back(), point);
      point.tangent /= steps(point.tangent, point).norm();
      const bool good =
          predicts && std::abs(next->way) < 0.05 * steps(way(curve_.points.back(), point), point).norm();
      add(point);
      if (told_to_end_) return false;
      here = next->at;
      if (good) step = std::min(2 * step, options_.max_step);
      if (!predicts) predicts = true;
      ++walked;
      flips = 0;
      if (next->corner || walked < patience_) continue;
      patience_ *= 2;
      if (smoothly_on(here, sense)) return true;
      continue;
    }
    step *= 0.25;
    if (step > least_step) continue;
    if (next && !in_window) {
      curve_.points.back().type = PointType::end;
      stop(Stop::reached_end,
           fmt::format("{} reached an end of its range", problem_.observables().front().name));
      return false;
    }
    if (next && !inside) {
      const auto place = meeting();
      return place && leave(*place);
    }
    // It vanishes together with one of the other kind, on which the curve goes back.
    const auto other = extrema.next_to(here, !peak, far);
    if (!other || ++flips > 1) return false;
    peak = !peak;
    sense = -sense;
    here = other->at;
    step = first_step;
    predicts = false;
    rate.setZero();
    BranchPoint fold = row(here, PointType::corner_fold);
    fold.tangent = -curve_.points.back().tangent;
    add(std::move(fold));
    if (told_to_end_ || is_satisfied()) return false;
    if (has_turned_here()) {
      stop(Stop::min_step, "the curve goes back on itself, at " + this->place());
      return false;
    }
  }
  return false;
}

}  // namespace arcslip::continuation
