#include "arcslip/continuation/curves/extremum_tracer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "arcslip/continuation/path/repetition.hpp"

namespace arcslip::continuation {

Guess ExtremumTracer::guess_at(const BasePoint& point, const Vector& direction) const {
  Guess guess;
  problem_.join(point, guess.unknowns, guess.parameters);
  guess.regime = point.regime;
  guess.direction = direction;
  return guess;
}

BranchPoint ExtremumTracer::row(const BasePoint& at, PointType type) {
  const Guess guess = guess_at(at);
  BranchPoint point;
  point.type = type;
  point.regime = at.regime;
  point.unknowns = guess.unknowns;
  point.parameters = guess.parameters;
  Vector residual(base_.size());
  if (base_.evaluate(at.unknowns, at.parameters, at.regime, {&residual}))
    point.residual = residual.lpNorm<Eigen::Infinity>();
  return point;
}

/// A difference of (u, p) in units of the scale at a point, by whose length arclengths are measured.
Vector ExtremumTracer::steps(const Vector& difference, const BranchPoint& at) const {
  Vector unknowns(problem_.size());
  Vector parameters(at.parameters.size());
  problem_.scale(at.unknowns, at.parameters, unknowns, parameters);
  Vector scale(problem_.size() + 1);
  scale << unknowns * std::sqrt(static_cast<double>(problem_.size())), parameters(parameter_);
  return difference.cwiseQuotient(scale);
}

Vector ExtremumTracer::way(const BranchPoint& from, const BranchPoint& to) const {
  Vector difference(problem_.size() + 1);
  difference << to.unknowns - from.unknowns, to.parameters(parameter_) - from.parameters(parameter_);
  return difference;
}

/// The unit direction from the last row to a point.
Vector ExtremumTracer::direction_to(const BranchPoint& point) const {
  const Vector chord = way(curve_.points.back(), point);
  return chord / steps(chord, point).norm();
}

/// A unit of the parameter at a point, in the units of arclengths.
double ExtremumTracer::parameter_scale(const BranchPoint& at) const {
  return 1 / steps(Vector::Ones(problem_.size() + 1), at)(problem_.size());
}

std::string ExtremumTracer::place() const {
  return fmt::format("{} = {:.10g}", options_.parameter, curve_.points.back().parameters(parameter_));
}

/// Options for what is left of the curve.
TraceOptions ExtremumTracer::rest() const {
  TraceOptions rest = options_;
  rest.max_seconds = time_.rest().max_seconds;
  rest.max_points = std::max(2L, options_.max_points - std::ssize(curve_.points));
  for (StopAfter& rule : rest.stop_after) {
    rule.count -= std::count_if(curve_.points.begin(), curve_.points.end(), [&](const BranchPoint& point) {
      return point.type == rule.type && point.label == rule.label;
    });
  }
  if (!curve_.points.empty()) rest.stop_at.push_back(curve_.points.front().parameters(parameter_));
  return rest;
}

/// Options for one step of about this length, wherever it leads.
TraceOptions ExtremumTracer::freely(double way) const {
  TraceOptions free;
  free.parameter = options_.parameter;
  free.tolerance = options_.tolerance;
  free.tolerances = options_.tolerances;
  const double far = 1 + 2 * std::max(std::abs(options_.from), std::abs(options_.to));
  free.from = -far;
  free.to = far;
  free.max_step = std::min(1.0, 10 * way);  // the first step is a tenth
  free.min_step = 1e-3 * free.max_step;
  free.max_points = 2;
  return free;
}

/// Whether the rows so far are all that was asked for.
bool ExtremumTracer::is_satisfied() {
  const std::vector<StopAfter> left = rest().stop_after;
  if (std::none_of(left.begin(), left.end(), [](const StopAfter& rule) { return rule.count <= 0; }))
    return false;
  stop(Stop::requested, "stop_after was satisfied at " + place());
  return true;
}

void ExtremumTracer::stop(Stop reason, std::string explanation) {
  curve_.stop = reason;
  curve_.explanation = std::move(explanation);
}

void ExtremumTracer::add(BranchPoint point) {
  if (!curve_.points.empty()) {
    const BranchPoint& last = curve_.points.back();
    point.arclength = last.arclength + steps(way(last, point), point).norm();
  }
  curve_.points.push_back(std::move(point));
  if (!observer_ || observer_(curve_.points.back())) return;
  told_to_end_ = true;
  stop(Stop::interrupted, "told to end at " + place());
}

/// Adds a piece but its first points.
void ExtremumTracer::append(Branch piece, std::size_t skipped) {
  if (curve_.points.empty()) curve_.checkpoint = std::move(piece.checkpoint);
  curve_.work = curve_.work + piece.work;
  stop(piece.stop, piece.explanation);
  if (curve_.warning.empty()) curve_.warning = piece.warning;
  const bool begins = curve_.points.empty();
  double offset = 0;
  if (!begins && !piece.points.empty()) {
    const BranchPoint& last = curve_.points.back();
    const BranchPoint& first = piece.points.front();
    offset = last.arclength + steps(way(last, first), first).norm();
  }
  for (std::size_t i = skipped; i < piece.points.size(); ++i) {
    BranchPoint& point = piece.points[i];
    point.arclength += offset;
    if (!begins && point.type == PointType::start) point.type = PointType::regular;
    if (point.type == PointType::user && !is_asked_for(point.parameters(parameter_)))
      point.type = PointType::regular;
    curve_.points.push_back(std::move(point));
  }
  if (!begins && curve_.stop == Stop::closed_loop && !came_back())
    stop(Stop::repeats,
         "the curve comes back to where its last piece began and not to its start, at " + place());
}

/// A piece within a regime or along a border. `sees` gets all of its points in their order, also of those
/// that the journal knows, and ends it where it returns true.
Branch ExtremumTracer::piece(ExtendedProblem& problem, const Guess& from, bool towards_to,
                             const TraceOptions& options, const Observer& sees) {
  near_ = false;
  const Observer watch = [&](const BranchPoint& point) {
    const bool goes_on = !observer_ || observer_(point);
    near_ = sees(point) && goes_on;
    return goes_on && !near_;
  };
  const auto ended = [&](Branch& part) {
    if (near_) part.stop = Stop::requested;  // to the journal it is whole
  };
  Branch part = trace_part(
      problem, from, towards_to, options, watch, ended,
      [&](const BranchPoint& point) { near_ = sees(point); }, with_these_intervals());
  if (near_) part.stop = Stop::interrupted;
  return part;
}

/// Traces a piece within a regime, which is left before a border that it comes near to.
void ExtremumTracer::smooth(const Guess& guess, bool towards_to, std::size_t skipped) {
  mode_ = Mode::smooth;
  near_ = false;
  double last = -1;
  const Observer comes_near = [&](const BranchPoint& point) {
    const auto border = nearest_border(base_, problem_.active(), split(point), point.regime);
    const double distance = border ? border->distance : 1;
    passes_ = passes_ && distance < near;
    const bool nears = !passes_ && distance < near && distance < last && point.type == PointType::regular;
    last = distance;
    return nears;
  };
  TraceOptions options = rest();
  options.turns_at_corners = false;
  const std::size_t before = curve_.points.size();
  if (!problem_.adapt(problem_.split(guess.unknowns, guess.parameters, guess.regime)))
    return stop(Stop::no_value, "the problem has no value where the curve goes on");
  Branch part = piece(problem_, guess, towards_to, options, comes_near);
  const auto turn = turns_in_place(part.points, options_.tolerances);
  turns_ = turn.has_value();
  if (turn) {
    // A corner that no border tells of, or rounding: but for the first turn what is found is none of the
    // curve.
    part.points.resize(*turn + 1);
    part.stop = Stop::min_step;
  }
  append(std::move(part), skipped);
  constexpr std::size_t well = 10;  // rows
  if (curve_.points.size() > before + well) patience_ = 3;
}

/// Traces a piece along a border, up to where one of the slopes vanishes.
void ExtremumTracer::along(const Ledge& ledge, const std::optional<Regime>& vanishing) {
  mode_ = Mode::ledge;
  border_ = ledge.border;
  peak_ = ledge.peak;
  near_ = false;
  BorderProblem edge(base_, problem_.active(), ledge.border);
  if (!edge.adapt(ledge.from) || !slopes_.begin(ledge.from, ledge.border))
    return stop(Stop::no_value, "the corner cannot be followed along its border");
  const Guess from = guess_at(ledge.from, ledge.direction);
  const BranchPoint begin = row(ledge.from, PointType::start);
  TraceOptions options = rest();
  for (const Side side : {CornerSlopes::arriving, CornerSlopes::leaving}) {
    const std::string& name = side == CornerSlopes::arriving ? before_vanishes : behind_vanishes;
    // Of a zero where the piece begins the slope is divided by the way from there.
    const bool begins_at_zero = vanishing == slopes_.regime(side);
    const auto slope_at = [&, side, begins_at_zero](const Vector& u, const Vector& p, const Regime& regime) {
      BranchPoint point = begin;
      point.unknowns = u;
      point.parameters = p;
      const double distance = steps(way(begin, point), begin).norm();
      if (!begins_at_zero || distance > near) {
        const double slope = slopes_.slope(edge.split(u, p, regime), side);
        return begins_at_zero ? slope / distance : slope;
      }
      const Guess beside = guess_at(ledge.beside);
      point.unknowns = beside.unknowns;
      point.parameters = beside.parameters;
      return slopes_.slope(ledge.beside, side) / steps(way(begin, point), begin).norm();
    };
    options.events.push_back({name, slope_at});
    options.stop_after.push_back({PointType::event, 1, name});
  }
  Branch traced = piece(edge, from, true, options, [&](const BranchPoint& point) {
    slopes_.follow(split(point));
    return false;
  });
  if (!curve_.points.empty() && !traced.points.empty()) {
    BranchPoint& here = curve_.points.back();
    here.tangent = traced.points.front().tangent;
    if (here.arrival.size() > 0) turn(here.tangent, ledge.from.regime);
    if (told_to_end_) return;
  }
  const bool begins = curve_.points.empty();
  append(std::move(traced), begins ? 0 : 1);
}

/// Rows of what the curve turns at, where it goes on in another direction than that in which it came.
void ExtremumTracer::turn(Vector tangent, const Regime& regime) {
  const BranchPoint here = curve_.points.back();
  const Index last = tangent.size() - 1;
  const auto add_as = [&](PointType type) {
    BranchPoint point = here;
    point.type = type;
    point.regime = regime;
    point.arrival.resize(0);
    point.tangent = tangent;
    add(std::move(point));
  };
  if (here.arrival(last) * tangent(last) < 0) add_as(PointType::corner_fold);
  const double before = observable_rate(curve_.points.back(), here.arrival);
  const double behind = observable_rate(curve_.points.back(), tangent);
  const bool told = std::min(std::abs(before), std::abs(behind)) > options_.tolerances.no_rate;
  if (told && before * behind < 0) add_as(before > 0 ? PointType::peak : PointType::trough);
}

/// How the observable whose extrema are looked for along the curve changes in a direction.
double ExtremumTracer::observable_rate(const BranchPoint& at, const Vector& direction) const {
  if (options_.extrema_of.empty()) return 0;
  const Index which = index_of(observable_names(problem_), options_.extrema_of.front());
  Gradient gradient{Vector::Zero(problem_.size()), Vector::Zero(at.parameters.size())};
  const double size = std::abs(problem_.observe(at.unknowns, at.parameters, at.regime, which, gradient));
  return rate(gradient, parameter_, direction) / size;
}

/// Whether it has come back to its start as it left it, behind which it is cut.
bool ExtremumTracer::came_back() {
  const BranchPoint& start = curve_.points.front();
  for (std::size_t i = std::max<std::size_t>(seen_, 1); seen_ > 0 && i < curve_.points.size(); ++i) {
    BranchPoint& point = curve_.points[i];
    if (point.regime != start.regime ||
        !(steps(way(start, point), start).norm() < options_.tolerances.same_point) ||
        !(point.arriving().dot(start.tangent) > 0))
      continue;
    point.type = PointType::end;
    curve_.points.resize(i + 1);
    stop(Stop::closed_loop, "the branch came back to its start");
    return true;
  }
  seen_ = curve_.points.size();
  return false;
}

/// Whether the last pieces have led nowhere.
bool ExtremumTracer::stalls() {
  constexpr int most = 5;
  constexpr double nowhere = 1e-9;  // in the scale
  const BranchPoint& last = curve_.points.back();
  const bool moves = !stood_ || !(steps(way(*stood_, last), last).norm() < nowhere);
  stood_ = last;
  stalled_ = moves ? 0 : stalled_ + 1;
  if (stalled_ < most) return false;
  stop(Stop::min_step, "no piece leads on from " + place());
  return true;
}

/// Adds the next piece; false where the curve has come to an end.
bool ExtremumTracer::go_on() {
  if (curve_.points.empty() || curve_.stop == Stop::closed_loop || came_back()) return false;
  if (stalls()) return false;
  const BranchPoint& last = curve_.points.back();
  if (told_to_end_ || (curve_.stop == Stop::interrupted && !near_)) return false;
  if (std::ssize(curve_.points) >= options_.max_points && curve_.stop != Stop::max_points &&
      !is_end(curve_.stop))
    return false;
  if (mode_ == Mode::ledge) {
    const bool vanishes = curve_.stop == Stop::requested && last.type == PointType::event;
    if (vanishes && last.label == before_vanishes) return enter(CornerSlopes::arriving);
    if (vanishes && last.label == behind_vanishes) return enter(CornerSlopes::leaving);
    if (curve_.stop != Stop::left_regime) return false;
    BranchPoint& here = curve_.points.back();
    here.type = PointType::regime_switch;
    here.arrival = here.tangent;
    return leave({split(here), std::nullopt, here.tangent, peak_});
  }
  const bool is_stuck = near_ || curve_.stop == Stop::left_regime || curve_.stop == Stop::min_step ||
                        curve_.stop == Stop::no_value || curve_.stop == Stop::no_start;
  if (!is_stuck) return false;
  if (std::exchange(turns_, false) && past_turn()) return true;
  if (curve_.points.empty() || told_to_end_) return false;
  if (const auto place = meeting()) return leave(*place);
  if (told_to_end_) return false;
  if (!near_) return curve_.stop != Stop::left_regime && walk();
  passes_ = true;
  const Guess guess{last.unknowns, last.parameters, last.regime, last.tangent};
  smooth(guess, true, 1);
  return true;
}

/// Where Newton's method leads to no row beside the first one.
bool ExtremumTracer::walk_from(const BasePoint& start, bool towards_to) {
  BranchPoint first = row(start, PointType::start);
  const bool up = towards_to == (options_.to > options_.from);
  first.tangent = (up ? 1 : -1) * Vector::Unit(problem_.size() + 1, problem_.size());
  add(std::move(first));
  return !told_to_end_ && walk();
}

Branch ExtremumTracer::half(const BasePoint& start, bool corner, bool towards_to) {
  if (corner) {
    const bool up = towards_to == (options_.to > options_.from);
    for (const Ledge& ledge : ledges({start, std::nullopt, {}, std::nullopt})) {
      if ((ledge.direction(ledge.direction.size() - 1) > 0) != up) continue;
      along(ledge, std::nullopt);
      break;
    }
  } else {
    smooth(guess_at(start), towards_to, 0);
    const bool begins = !curve_.points.empty() || curve_.stop != Stop::no_start;
    if (!begins && !walk_from(start, towards_to)) return std::move(curve_);
  }
  while (go_on()) curve_.checkpoint.reset();
  tell_turns_once();
  return std::move(curve_);
}

}  // namespace arcslip::continuation
