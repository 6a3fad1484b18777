// Where a curve of extrema comes to a corner within its regime, which no border tells of: there the extremum
// is followed from response to response, in steps of the parameter; and where rounding hides how it turns.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "arcslip/continuation/curves/extremum_tracer.hpp"
#include "arcslip/continuation/curves/response_extremum.hpp"
#include "arcslip/continuation/linear/borders.hpp"

namespace arcslip::continuation {
namespace {

bool turns_at(const BranchPoint& row) {
  return row.type == PointType::fold || row.type == PointType::corner_fold;
}

}  // namespace

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
bool ExtremumTracer::finish(double value) {
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
  const double here = curve_.points.back().parameters(parameter_);
  double sense = 1;
  for (std::size_t i = curve_.points.size(); i-- > 0;) {
    const BranchPoint& point = curve_.points[i];
    const double change = here - point.parameters(parameter_);
    if (std::abs(change) > options_.tolerances.same_point * scale) return change > 0 ? sense : -sense;
    if (turns_at(point)) sense = -sense;
  }
  return curve_.points.back().tangent(problem_.size()) > 0 ? 1 : -1;
}

/// Goes on as a smooth extremum from the last row. False where that leads nowhere, back, or along another
/// one, and leaves no row.
bool ExtremumTracer::smoothly_on(const Walk& walk, ResponseExtremum& extrema) {
  constexpr std::size_t enough = 5;  // rows
  const std::size_t before = curve_.points.size();
  smooth(guess_at(walk.here, curve_.points.back().tangent), true, 1);
  if (is_unfinished(curve_.stop) && !near_) return true;
  const std::size_t added = curve_.points.size() - before;
  const auto begin = curve_.points.begin() + static_cast<std::ptrdiff_t>(before);
  const auto turn = std::find_if(begin, curve_.points.end(), turns_at);  // behind which peaks are troughs
  const auto seen = std::min(begin + static_cast<std::ptrdiff_t>(std::min(added, enough)), turn);
  const bool ahead = seen != begin && (seen[-1].parameters(parameter_) - value(walk.here)) * walk.sense > 0;
  std::optional<bool> peak;
  for (auto row = seen - 1; ahead && row != turn && !peak; ++row) peak = is_peak(*row, extrema);
  for (auto row = seen - 1; ahead && row != begin && !peak; --row) peak = is_peak(row[-1], extrema);
  const bool is_same = peak == walk.peak;
  const bool ends = is_end(curve_.stop) || near_ || told_to_end_ || curve_.stop == Stop::max_points;
  const bool goes_round = curve_.stop == Stop::repeats;
  if (ahead && is_same && !goes_round && (added >= enough || ends)) return true;
  curve_.points.resize(before);
  seen_ = std::min(seen_, before);
  near_ = false;
  turns_ = false;
  stop(Stop::min_step, "the extremum is followed from response to response, at " + place());
  return false;
}

/// Goes on from the last row, a fold beside which rounding hides how the curve runs, as far away as needed to
/// tell: there the parameter changes twice as fast as half as far away. False where it nowhere does, or goes
/// on as it came, and leaves no fold.
bool ExtremumTracer::past_turn() {
  constexpr double farthest = 0.1;  // in the scale
  constexpr double nearest = 1e-5;  // the same: nearer than this the parameter all but stands still
  constexpr double sure = 100;      // times what it changes there
  const BranchPoint fold = curve_.points.back();
  curve_.points.pop_back();
  if (curve_.points.empty() || !problem_.adapt(split(fold))) return false;
  const double sense = way_so_far(parameter_scale(fold));
  Corrector corrector(problem_, parameter_, {.tolerance = options_.tolerance});
  CurvePoint origin = corrector.make_point();
  origin.unknowns = fold.unknowns;
  origin.parameters = fold.parameters;
  origin.regime = fold.regime;
  corrector.set_scale(origin);
  CurvePoint at = origin;
  const Vector normal = fold.tangent.cwiseQuotient(origin.scale).normalized();
  double rounding = 0;  // of the rate at which the parameter changes
  for (double way = options_.tolerances.same_point; way < farthest; way *= 2) {
    corrector.displace(origin, way * normal, at);
    if (corrector.correct(at, origin, normal, way, false) != Correction::converged) continue;
    const double rate = corrector.direction()(problem_.size());
    if (way < nearest) rounding = std::max(rounding, std::abs(rate));
    if (way < nearest || !(std::abs(rate) > sure * rounding)) continue;
    if (rate * sense > 0) return false;
    add_turn(fold);
    const Vector tangent = corrector.direction().cwiseProduct(origin.scale);
    if (!told_to_end_) smooth({at.unknowns, at.parameters, at.regime, tangent}, true, 0);
    return !told_to_end_;
  }
  return false;
}

/// A fold and the extremum of what is looked for along the curve that it is, too.
void ExtremumTracer::add_turn(BranchPoint fold) {
  const double rises = observable_rate(fold, way(curve_.points.back(), fold));
  fold.type = PointType::fold;
  add(fold);
  if (told_to_end_ || options_.extrema_of.empty()) return;
  fold.type = rises > 0 ? PointType::peak : PointType::trough;
  add(std::move(fold));
}

/// Where the parameter stands still, rounding makes turns of it and extrema along the curve. One of each is
/// told where it goes back behind them, none where it goes on.
void ExtremumTracer::tell_turns_once() {
  constexpr double rounding = 1e-12;  // of the parameter, in its scale
  std::vector<BranchPoint>& rows = curve_.points;
  const auto is_extremum = [](const BranchPoint& row) {
    return row.type == PointType::peak || row.type == PointType::trough;
  };
  for (auto first = rows.begin(); (first = std::find_if(first, rows.end(), turns_at)) != rows.end();) {
    const double here = first->parameters(parameter_);
    const double scale = parameter_scale(*first);
    const auto change = [&](const BranchPoint& row) { return row.parameters(parameter_) - here; };
    const auto moves = [&](const BranchPoint& row) { return std::abs(change(row)) > rounding * scale; };
    const auto before = std::find_if(std::reverse_iterator(first), rows.rend(), moves);
    const auto behind = std::find_if(first, rows.end(), moves);
    if (before != rows.rend() && behind != rows.end()) {
      const bool turns = change(*before) * change(*behind) > 0;
      bool turn_is_told = !turns;
      bool extremum_is_told = !turns;
      for (auto row = before.base(); row != behind; ++row) {
        if (turns_at(*row) && std::exchange(turn_is_told, true)) row->type = PointType::regular;
        if (is_extremum(*row) && std::exchange(extremum_is_told, true)) row->type = PointType::regular;
      }
    }
    first = behind;
  }
}

/// Whether the curve has turned where it stands before, a while ago: then it goes back on itself.
bool ExtremumTracer::has_turned_here() const {
  constexpr std::size_t while_ago = 5;  // rows
  const BranchPoint& here = curve_.points.back();
  for (std::size_t i = 0; i + while_ago < curve_.points.size(); ++i) {
    const BranchPoint& point = curve_.points[i];
    const bool turns = point.type == PointType::corner_fold || point.type == PointType::fold;
    if (turns && steps(way(point, here), here).norm() < options_.tolerances.same_solution) return true;
  }
  return false;
}

/// Whether a row is a peak, where the slopes beside it tell.
std::optional<bool> ExtremumTracer::is_peak(const BranchPoint& row, ResponseExtremum& extrema) const {
  const BasePoint at = split(row);
  return extrema.begin(at) ? extrema.is_peak(at) : std::nullopt;
}

/// Whether the last rows are peaks, as the last one tells that does, and turns behind it.
std::optional<bool> ExtremumTracer::were_peaks(ResponseExtremum& extrema) const {
  constexpr std::size_t most = 100;  // rows
  bool turned = false;
  for (std::size_t i = curve_.points.size(); i-- > 0 && i + most >= curve_.points.size();) {
    if (const std::optional<bool> peak = is_peak(curve_.points[i], extrema)) return *peak != turned;
    if (turns_at(curve_.points[i])) turned = !turned;
  }
  return std::nullopt;
}

/// The extremum that the last rows belong to, as the last row. These may lie a little beside it, or where it
/// has vanished, as the conditions of an extremum are steep next to corners.
std::optional<BasePoint> ExtremumTracer::begin_walk(ResponseExtremum& extrema, bool& peak) {
  constexpr std::size_t most_back = 100;  // rows that may lie on none
  constexpr std::size_t most_beside = 20;
  const double beside = options_.tolerances.beside_extremum;
  const double same = options_.tolerances.on_extremum;
  const auto nearest = [&](bool as_peak) {
    const BasePoint at = split(curve_.points.back());
    return extrema.begin(at) ? extrema.next_to(at, as_peak, beside) : std::nullopt;
  };
  std::optional<bool> kind = were_peaks(extrema);
  std::optional<ResponseExtremum::Found> found;
  for (std::size_t back = 0; back < most_back && !found; ++back) {
    if (back > 0 && curve_.points.size() < 2) break;
    if (back > 0 && turns_at(curve_.points.back()) && kind) kind = !*kind;
    if (back > 0) curve_.points.pop_back();
    const auto as_peak = kind.value_or(true) ? nearest(true) : std::nullopt;
    const auto as_trough = kind.value_or(false) ? std::nullopt : nearest(false);
    peak = as_peak && (!as_trough || std::abs(as_peak->way) <= std::abs(as_trough->way));
    found = peak ? as_peak : as_trough;
  }
  if (!found || std::abs(found->way) <= same) return found ? std::optional(found->at) : std::nullopt;
  for (std::size_t i = 0; i < most_beside && curve_.points.size() > 1; ++i) {
    const auto here = nearest(peak);
    if (here && std::abs(here->way) <= same) break;
    curve_.points.pop_back();
  }
  BranchPoint corrected = row(found->at, PointType::regular);
  corrected.tangent = direction_to(corrected);
  add(std::move(corrected));
  return found->at;
}

namespace {
constexpr double first_step = 1e-9;  // of the parameter, in its scale
}

/// Whether the slope vanishes at an extremum, and not only at another one that is nearby as long as little
/// has been walked from where they were one: the conditions measure the way to that.
bool ExtremumTracer::is_smooth(const Walk& walk, double scale) {
  constexpr double aside = 1e-3;  // of the way walked, nan where it has not turned
  const double walked = std::abs(value(walk.here) - walk.turned) / scale;
  Vector residual(problem_.size());
  const Guess at = guess_at(walk.here);
  return problem_.adapt(walk.here) &&
         problem_.evaluate(at.unknowns, at.parameters, at.regime, {.residual = &residual}) &&
         residual.lpNorm<Eigen::Infinity>() < std::fmin(aside * walked, options_.tolerances.beside_extremum);
}

/// The row of a response's extremum at a value of the parameter, and what the next one is predicted by.
void ExtremumTracer::stride(Walk& walk, const ResponseExtremum::Found& next, double to) {
  walk.rate = (guess_at(next.at).unknowns - guess_at(walk.here).unknowns) / (to - value(walk.here));
  BranchPoint point = row(next.at, is_asked_for(to) ? PointType::user : PointType::regular);
  const double length = steps(way(curve_.points.back(), point), point).norm();
  point.tangent = direction_to(point);
  add(std::move(point));
  walk.here = next.at;
  if (walk.predicts && std::abs(next.way) < 0.05 * length)
    walk.step = std::min(2 * walk.step, options_.max_step);
  walk.predicts = true;
  ++walk.walked;
  walk.flips = 0;
  walk.widens = false;
}

/// Where the extremum vanishes together with one of the other kind: on that the curve goes back. False where
/// it does not.
bool ExtremumTracer::fold_back(Walk& walk, ResponseExtremum& extrema) {
  constexpr double far = 1e-5;  // on the response, in the scale: to the other one of a pair that vanishes
  constexpr int most = 10;      // rows on which rounding hides it
  const auto other_at = [&](const BasePoint& at) { return extrema.next_to(at, !walk.peak, far); };
  auto other = other_at(walk.here);
  for (int back = 0; back < std::min(most, walk.walked) && !other && curve_.points.size() > 1; ++back) {
    curve_.points.pop_back();
    other = other_at(split(curve_.points.back()));
  }
  std::optional<ResponseExtremum::Found> behind;  // from where on the other one is told
  const std::size_t last = curve_.points.size() - 1;
  for (std::size_t back = 1; back < most && back <= last && !other && !behind; ++back) {
    const BasePoint at = split(curve_.points[last - back]);
    if ((value(at) - value(walk.here)) * walk.sense < 0) behind = other_at(at);
  }
  if (behind) other = {split(curve_.points.back()), 0, false};
  if (!other || ++walk.flips > 1) {
    stop(Stop::min_step,
         fmt::format("the extremum is lost on a corner that no border tells of, at {}", place()));
    return false;
  }
  walk.peak = !walk.peak;
  walk.sense = -walk.sense;
  walk.here = other->at;
  walk.turned = value(walk.here);
  walk.step = first_step;
  walk.predicts = false;
  walk.rate.setZero();
  BranchPoint fold = row(walk.here, PointType::corner_fold);
  fold.tangent = -curve_.points.back().tangent;
  add(std::move(fold));
  if (told_to_end_ || is_satisfied()) return false;
  if (behind) stride(walk, *behind, value(behind->at));
  if (!has_turned_here()) return !told_to_end_;
  stop(Stop::min_step, "the curve goes back on itself, at " + place());
  return false;
}

/// How far from where it is predicted an extremum is looked for. Two that vanish together lie apart by the
/// root of the way from there.
double ExtremumTracer::reach_at(const Walk& walk, double to, double scale) const {
  constexpr double beside = 1e-6;  // in the scale of the parameter
  const BranchPoint& last = curve_.points.back();
  const double fast = steps(padded(walk.rate, problem_.size() + 1), last).norm() * scale;
  const double steady = (100 + fast) * std::abs(to - value(walk.here)) / scale;
  const double from_turn = std::abs(to - walk.turned) / scale;
  return from_turn < beside ? std::max(steady, std::sqrt(from_turn)) : steady;
}

bool ExtremumTracer::walk() {
  constexpr double least_step = 1e-12;
  constexpr double widest_step = 1e-5;  // from a turn to where rounding no longer hides how it goes on
  ResponseExtremum extrema(base_, problem_.active(), *problem_.extremum_of());
  Walk walk;
  const auto begin = begin_walk(extrema, walk.peak);
  if (!begin) return false;
  const double scale = parameter_scale(curve_.points.back());
  walk.here = *begin;
  walk.sense = way_so_far(scale);
  walk.step = first_step;
  walk.rate = Vector::Zero(problem_.size());
  const Vector& tangent = curve_.points.back().tangent;
  if (tangent(problem_.size()) * walk.sense > 0)
    walk.rate = tangent.head(problem_.size()) / tangent(problem_.size());
  while (std::ssize(curve_.points) < options_.max_points) {
    if (!time_.goes_on()) {
      stop(time_.is_spent() ? Stop::time_limit : Stop::interrupted, "left at " + place());
      return false;
    }
    const double from = value(walk.here);
    const double to = next_value(from, from + walk.sense * walk.step * scale);
    if (to == from) return finish(from);
    Guess guess = guess_at(walk.here);
    guess.unknowns += walk.rate * (to - from);
    guess.parameters(parameter_) = to;
    const double reach = reach_at(walk, to, scale);
    const auto next =
        extrema.next_to(problem_.split(guess.unknowns, guess.parameters, walk.here.regime), walk.peak, reach);
    const bool inside = next && distance(next->at) >= 0;
    const bool in_window = next && next->at.parameters(problem_.active()) >= window_.low &&
                           next->at.parameters(problem_.active()) <= window_.high;
    if (inside && in_window) {
      stride(walk, *next, to);
      // Along the direction of a response left behind Newton's method goes ever less far.
      walk.predicts = extrema.begin(walk.here);
      if (told_to_end_) return false;
      if (next->corner || walk.walked < patience_ || !is_smooth(walk, scale)) continue;
      patience_ *= 2;
      if (smoothly_on(walk, extrema)) return true;
      walk.predicts = extrema.begin(walk.here);
      continue;
    }
    walk.step *= walk.widens ? 4 : 0.25;
    if (walk.widens ? walk.step < widest_step : walk.step > least_step) continue;
    if (next && !in_window) {
      curve_.points.back().type = PointType::end;
      stop(Stop::reached_end,
           fmt::format("{} reached an end of its range", problem_.observables().front().name));
      return false;
    }
    if (next) {
      const auto place = meeting();
      return place && leave(*place);
    }
    if (walk.flips > 0 && !walk.widens) {
      walk.widens = true;
      walk.step = first_step;
      continue;
    }
    if (!fold_back(walk, extrema)) return false;
  }
  return false;
}

}  // namespace arcslip::continuation
