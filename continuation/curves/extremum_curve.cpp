#include "arcslip/continuation/curves/extremum_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/continuation/curves/corner_slopes.hpp"
#include "arcslip/continuation/curves/half_curve.hpp"
#include "arcslip/continuation/points/border_problem.hpp"
#include "arcslip/continuation/points/normal_form.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {
namespace {

using Side = CornerSlopes::Side;

constexpr double near = 1e-6;          // a border, in the scale: here a curve of smooth extrema is left
constexpr double narrow = 1e-5;        // the same: what turns within this is not traced
constexpr double within_reach = 1e-2;  // the same: nearer than this one that cannot go on may come to one
constexpr double shortest_way = 1e-9;  // in the scale, from a place along a border or into a regime,
constexpr double longest_way = 1e-3;   // and as far as this one goes for a slope that is surely not rounding

/// A place on a border to which a curve comes.
struct Place {
  BasePoint at;                  ///< in the regime from which it comes
  std::optional<int> vanishing;  ///< the regime in which the slope vanishes there
  Vector arrival;                ///< of the curve, as BranchPoint::tangent; empty where it starts there
  std::optional<bool> peak;      ///< whether it comes along a border, and as a peak
};

/// A piece of the curve that leaves a place along a border as a corner.
struct Ledge {
  BasePoint from;
  int border;
  Vector direction;  ///< as BranchPoint::tangent
  BasePoint beside;  ///< a little way on
  bool peak;
};

class ExtremumCurve {
 public:
  ExtremumCurve(ExtendedProblem& problem, const TraceOptions& options, const CurveWindow& window,
                const Observer& observer)
      : problem_(problem),
        base_(problem.base()),
        options_(within_window(options, window, base_.size())),
        window_(window),
        observer_(observer),
        parameter_(index_of(problem.parameter_names(), options.parameter)),
        slopes_(base_, problem.active(), *problem.extremum_of()) {}

  Branch half(const BasePoint& start, bool corner, bool towards_to);

 private:
  enum class Mode { smooth, ledge };

  bool go_on();
  bool leave(const Place& place);
  bool enter(Side side);
  std::optional<BasePoint> first_inside(const BasePoint& corner, Side side, double inside, double least);
  std::optional<BasePoint> fold_beside(const BasePoint& corner, int border, Side side);
  bool add_fold(const BasePoint& corner, int border, Side side);
  BasePoint settled(const BasePoint& point, int border) const;
  BasePoint at_value(const BasePoint& next, int border, double value) const;
  BasePoint refined(const BasePoint& point, int border, Side side);
  double distance(const BasePoint& point) const;
  double observable_rate(const BranchPoint& at, const Vector& direction) const;
  std::optional<Place> meeting();
  std::optional<Place> meeting_beside(const BranchPoint& last, const NearestBorder& nearest);
  bool turns_between(const BasePoint& point, const NearestBorder& nearest, const BasePoint& beside,
                     const BasePoint& place);
  std::vector<Ledge> ledges(const Place& place);
  void add_ledges(const BasePoint& at, int border, const Place& place, std::vector<Ledge>& all);
  std::vector<BranchPoint> step_off(BorderProblem& edge, const BasePoint& from, bool up, double way) const;
  std::vector<BranchPoint> surely_off(BorderProblem& edge, const BasePoint& from, bool up,
                                      std::optional<int> vanishing);
  struct Inside {
    double slope;
    double way;
  };
  Inside next_inside(const BasePoint& corner, Side side);
  bool fill(int border, const BasePoint& corner, double from, double to, Side side);

  void smooth(const Guess& guess, bool towards_to, std::size_t skipped);
  void along(const Ledge& ledge, std::optional<int> vanishing);
  void append(Branch piece, std::size_t skipped);
  void add(BranchPoint point);
  void turn(Vector tangent, int regime);
  void stop(Stop reason, std::string explanation);
  bool came_back();
  bool is_satisfied();

  TraceOptions rest() const;
  TraceOptions freely(double way) const;
  Guess guess_at(const BasePoint& point, const Vector& direction = {}) const;
  BasePoint split(const BranchPoint& point) const {
    return problem_.split(point.unknowns, point.parameters, point.regime);
  }
  BranchPoint row(const BasePoint& at, PointType type);
  Vector steps(const Vector& difference, const BranchPoint& at) const;
  Vector way(const BranchPoint& from, const BranchPoint& to) const;
  std::string place() const;
  double value(const BasePoint& point) const { return guess_at(point).parameters(parameter_); }

  ExtendedProblem& problem_;
  const Problem& base_;
  TraceOptions options_;
  CurveWindow window_;
  const Observer& observer_;
  Index parameter_;
  CornerSlopes slopes_;
  TimeBudget time_{options_};
  Branch curve_;
  Mode mode_ = Mode::smooth;
  int border_ = 0;        // of a ledge
  bool peak_ = false;     // the same: whether it is one of peaks
  std::size_t seen_ = 0;  // rows in which the start was looked for
  bool near_ = false;     // whether the last piece was left before a border
  bool passes_ = false;   // whether it is so near to a border that it does not meet
  bool told_to_end_ = false;
};

Guess ExtremumCurve::guess_at(const BasePoint& point, const Vector& direction) const {
  Guess guess;
  problem_.join(point, guess.unknowns, guess.parameters);
  guess.regime = point.regime;
  guess.direction = direction;
  return guess;
}

BranchPoint ExtremumCurve::row(const BasePoint& at, PointType type) {
  const Guess guess = guess_at(at);
  BranchPoint point;
  point.type = type;
  point.regime = at.regime;
  point.unknowns = guess.unknowns;
  point.parameters = guess.parameters;
  Vector residual(problem_.size());
  problem_.adapt(at);
  if (problem_.evaluate(guess.unknowns, guess.parameters, at.regime, {&residual}))
    point.residual = residual.lpNorm<Eigen::Infinity>();
  return point;
}

/// A difference of (u, p) in units of the scale at a point, by whose length arclengths are measured.
Vector ExtremumCurve::steps(const Vector& difference, const BranchPoint& at) const {
  Vector unknowns(problem_.size());
  Vector parameters(at.parameters.size());
  problem_.scale(at.unknowns, at.parameters, unknowns, parameters);
  Vector scale(problem_.size() + 1);
  scale << unknowns * std::sqrt(static_cast<double>(problem_.size())), parameters(parameter_);
  return difference.cwiseQuotient(scale);
}

Vector ExtremumCurve::way(const BranchPoint& from, const BranchPoint& to) const {
  Vector difference(problem_.size() + 1);
  difference << to.unknowns - from.unknowns, to.parameters(parameter_) - from.parameters(parameter_);
  return difference;
}

std::string ExtremumCurve::place() const {
  return fmt::format("{} = {:.10g}", options_.parameter, curve_.points.back().parameters(parameter_));
}

/// Options for what is left of the curve.
TraceOptions ExtremumCurve::rest() const {
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
TraceOptions ExtremumCurve::freely(double way) const {
  TraceOptions free;
  free.parameter = options_.parameter;
  free.tolerance = options_.tolerance;
  const double far = 1 + 2 * std::max(std::abs(options_.from), std::abs(options_.to));
  free.from = -far;
  free.to = far;
  free.max_step = std::min(1.0, 10 * way);  // the first step is a tenth
  free.min_step = 1e-3 * free.max_step;
  free.max_points = 2;
  return free;
}

/// Whether the rows so far are all that was asked for.
bool ExtremumCurve::is_satisfied() {
  const std::vector<StopAfter> left = rest().stop_after;
  if (std::none_of(left.begin(), left.end(), [](const StopAfter& rule) { return rule.count <= 0; }))
    return false;
  stop(Stop::requested, "stop_after was satisfied at " + place());
  return true;
}

void ExtremumCurve::stop(Stop reason, std::string explanation) {
  curve_.stop = reason;
  curve_.explanation = std::move(explanation);
}

void ExtremumCurve::add(BranchPoint point) {
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
void ExtremumCurve::append(Branch piece, std::size_t skipped) {
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
    const auto asked =
        std::count(options_.stop_at.begin(), options_.stop_at.end(), point.parameters(parameter_));
    if (point.type == PointType::user && asked == 0) point.type = PointType::regular;
    curve_.points.push_back(std::move(point));
  }
}

/// Traces a piece within a regime, which is left before a border that it comes near to.
void ExtremumCurve::smooth(const Guess& guess, bool towards_to, std::size_t skipped) {
  mode_ = Mode::smooth;
  near_ = false;
  double last = -1;
  const Observer watch = [&](const BranchPoint& point) {
    const auto border = nearest_border(base_, problem_.active(), split(point), point.regime);
    const double distance = border ? border->distance : 1;
    const bool goes_on = !observer_ || observer_(point);
    passes_ = passes_ && distance < near;
    near_ = goes_on && !passes_ && distance < near && distance < last && point.type == PointType::regular;
    last = distance;
    return goes_on && !near_;
  };
  const TraceOptions options = rest();
  problem_.adapt(problem_.split(guess.unknowns, guess.parameters, guess.regime));
  append(follow_curve(problem_, watch,
                      [&](const Observer& follow) {
                        return trace_one_way(problem_, guess, towards_to, options, follow);
                      }),
         skipped);
}

const std::string before_vanishes = "the slope before it vanishes";
const std::string behind_vanishes = "the slope behind it vanishes";

/// Traces a piece along a border, up to where one of the slopes vanishes.
void ExtremumCurve::along(const Ledge& ledge, std::optional<int> vanishing) {
  mode_ = Mode::ledge;
  border_ = ledge.border;
  peak_ = ledge.peak;
  near_ = false;
  BorderProblem edge(base_, problem_.active(), ledge.border);
  edge.adapt(ledge.from);
  slopes_.begin(ledge.from, ledge.border);
  const Guess from = guess_at(ledge.from, ledge.direction);
  const BranchPoint begin = row(ledge.from, PointType::start);
  TraceOptions options = rest();
  for (const Side side : {CornerSlopes::arriving, CornerSlopes::leaving}) {
    const std::string& name = side == CornerSlopes::arriving ? before_vanishes : behind_vanishes;
    // Of a zero where the piece begins the slope is divided by the way from there.
    const bool begins_at_zero = vanishing == slopes_.regime(side);
    const auto slope_at = [&, side, begins_at_zero](const Vector& u, const Vector& p, int regime) {
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
  const Observer watch = [&](const BranchPoint& point) {
    slopes_.follow(split(point));
    return !observer_ || observer_(point);
  };
  Branch piece = follow_curve(
      edge, watch, [&](const Observer& follow) { return trace_one_way(edge, from, true, options, follow); });
  if (!curve_.points.empty() && !piece.points.empty()) {
    BranchPoint& here = curve_.points.back();
    here.tangent = piece.points.front().tangent;
    if (here.arrival.size() > 0) turn(here.tangent, ledge.from.regime);
    if (told_to_end_) return;
  }
  const bool begins = curve_.points.empty();
  append(std::move(piece), begins ? 0 : 1);
}

/// Rows of what the curve turns at, where it goes on in another direction than that in which it came.
void ExtremumCurve::turn(Vector tangent, int regime) {
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
  constexpr double level = 1e-9;  // the rate is rounding
  const double before = observable_rate(curve_.points.back(), here.arrival);
  const double behind = observable_rate(curve_.points.back(), tangent);
  const bool told = std::min(std::abs(before), std::abs(behind)) > level;
  if (told && before * behind < 0) add_as(before > 0 ? PointType::peak : PointType::trough);
}

/// The point and one a little way along the border; empty where the border does not go on in the regime.
std::vector<BranchPoint> ExtremumCurve::step_off(BorderProblem& edge, const BasePoint& from, bool up,
                                                 double way) const {
  if (!edge.adapt(from)) return {};
  const TraceOptions free = freely(way);
  Branch step = trace_one_way(edge, guess_at(from), up, free);
  const bool goes = step.points.size() == 2 && step.points.back().arclength > 0.01 * way;
  return goes ? std::move(step.points) : std::vector<BranchPoint>{};
}

/// So far that a slope which vanishes at the place is no rounding.
std::vector<BranchPoint> ExtremumCurve::surely_off(BorderProblem& edge, const BasePoint& from, bool up,
                                                   std::optional<int> vanishing) {
  const Side side =
      vanishing == slopes_.regime(CornerSlopes::leaving) ? CornerSlopes::leaving : CornerSlopes::arriving;
  const double level = vanishing ? rounding_of(slopes_.slope(from, side)) : 0;
  std::vector<BranchPoint> step;
  for (double way = shortest_way; way <= longest_way; way *= 10) {
    step = step_off(edge, from, up, way);
    if (!step.empty() && std::abs(slopes_.slope(split(step.back()), side)) > level) break;
  }
  return step;
}

/// A slope inside that is no rounding, next to a place on the border where it vanishes. What turns nearer
/// than the shortest way is not told apart from the place.
ExtremumCurve::Inside ExtremumCurve::next_inside(const BasePoint& corner, Side side) {
  const double level = rounding_of(slopes_.slope(corner, side));
  double slope = slopes_.slope_inside(corner, side, shortest_way);
  double way = shortest_way;
  while (!(std::abs(slope) > level) && way < longest_way)
    slope = slopes_.slope_inside(corner, side, way *= 10);
  return {slope, way};
}

/// The pieces that leave a point along a border of its regime.
void ExtremumCurve::add_ledges(const BasePoint& at, int border, const Place& place, std::vector<Ledge>& all) {
  if (!slopes_.begin(at, border)) return;
  BorderProblem edge(base_, problem_.active(), border);
  for (const bool up : {true, false}) {
    const std::vector<BranchPoint> step = surely_off(edge, at, up, place.vanishing);
    if (step.empty()) continue;
    const BranchPoint& from = step.front();
    constexpr double back = -0.999999;  // the cosine of the way that the curve came
    if (place.peak && steps(from.tangent, from).dot(steps(place.arrival, from)) < back) continue;
    const BasePoint beside = split(step.back());
    const auto other = nearest_border(base_, problem_.active(), beside, at.regime, border);
    if (other && other->distance < 0) continue;
    const double before = slopes_.slope(beside, CornerSlopes::arriving);
    const double behind = slopes_.slope(beside, CornerSlopes::leaving);
    if (before * behind < 0) all.push_back({at, border, from.tangent, beside, before > 0});
  }
}

/// Those that leave a place in all regimes that meet there.
std::vector<Ledge> ExtremumCurve::ledges(const Place& place) {
  constexpr std::size_t most = 16;  // regimes
  std::vector<Ledge> all;
  std::vector<int> regimes{place.at.regime};
  for (std::size_t i = 0; i < regimes.size() && regimes.size() < most; ++i) {
    BasePoint at = place.at;
    at.regime = regimes[i];
    for (int b = 0; b < base_.border_count(at.regime); ++b) {
      const double value = base_.border(at.unknowns, at.parameters, at.regime, b, nullptr);
      const int beyond = base_.regime_beyond(at.regime, b);
      if (!(std::abs(value) <= on_border) || beyond < 0) continue;
      const auto known = std::find(regimes.begin(), regimes.end(), beyond);
      const bool was_seen_from_there = known < regimes.begin() + static_cast<std::ptrdiff_t>(i);
      if (!was_seen_from_there) add_ledges(at, b, place, all);
      if (known == regimes.end()) regimes.push_back(beyond);
    }
  }
  return all;
}

/// Goes on along a border: as a peak where it came as one, straight on if there are several.
bool ExtremumCurve::leave(const Place& place) {
  if (is_satisfied()) return false;
  const std::vector<Ledge> all = ledges(place);
  const BranchPoint& here = curve_.points.back();
  const auto rank = [&](const Ledge& ledge) {
    const double straight = steps(ledge.direction, here).dot(steps(place.arrival, here));
    return (place.peak == ledge.peak ? 2 : 0) + straight;
  };
  const auto best = std::max_element(all.begin(), all.end(),
                                     [&](const Ledge& a, const Ledge& b) { return rank(a) < rank(b); });
  if (best == all.end()) {
    stop(
        Stop::grazing_border,
        fmt::format("the extremum comes to a border and no corner goes on from there, at {}", this->place()));
    return false;
  }
  curve_.points.back().regime = best->from.regime;
  along(*best, place.vanishing);
  return true;
}

/// Rows on the values asked for that lie between two values of the parameter, beside a corner at one of them.
/// False where the curve ends on one of them.
bool ExtremumCurve::fill(int border, const BasePoint& corner, double from, double to, Side side) {
  std::vector<double> targets = options_.stop_at;
  targets.push_back(options_.from);
  targets.push_back(options_.to);
  std::erase_if(targets, [&](double t) { return !((t - from) * (to - t) > 0); });
  std::sort(targets.begin(), targets.end(),
            [&](double a, double b) { return std::abs(a - from) < std::abs(b - from); });
  BorderProblem edge(base_, problem_.active(), border);
  for (const double target : targets) {
    Guess guess = guess_at(corner);
    guess.parameters(parameter_) = target;
    const auto at =
        locate(edge, problem_.split(guess.unknowns, guess.parameters, corner.regime), options_.tolerance);
    const auto found = at ? slopes_.extremum_inside(at->point, side) : std::nullopt;
    if (!found) continue;
    BranchPoint point = row(*found, PointType::user);
    point.tangent = way(curve_.points.back(), point);
    point.tangent /= steps(point.tangent, point).norm();
    const bool ends = target == options_.from || target == options_.to;
    if (ends) point.type = PointType::end;
    add(std::move(point));
    if (!ends) continue;
    if (target == options_.to) stop(Stop::reached_end, "the last value was reached");
    if (target == options_.from) stop(Stop::left_range, "the branch leaves the range at " + place());
    return false;
  }
  return !told_to_end_;
}

/// Goes on from the corner that is the last row, where the slope on one side vanishes, as a smooth extremum.
bool ExtremumCurve::enter(Side side) {
  BranchPoint& here = curve_.points.back();
  here.type = PointType::regime_switch;
  here.label.clear();
  here.regime = slopes_.regime(side);
  here.arrival = here.tangent;
  if (is_satisfied()) return false;
  BasePoint corner = split(here);
  corner.regime = slopes_.regime(CornerSlopes::arriving);
  corner = refined(corner, border_, side);
  const Guess moved = guess_at(corner);
  here.unknowns = moved.unknowns;
  here.parameters = moved.parameters;
  const auto [inside, from] = next_inside(corner, side);
  const auto outer = slopes_.extremum_inside(corner, side, from);
  const bool turns = outer && distance(*outer) < narrow;
  const auto next =
      turns ? first_inside(corner, side, -inside, distance(*outer)) : first_inside(corner, side, inside, 0);
  if (!next) {
    stop(Stop::grazing_border,
         fmt::format("the extremum leaves a border and no smooth one goes on from there, at {}", place()));
    return false;
  }
  Vector direction = way(here, row(*next, PointType::regular));
  if (turns) {
    const auto fold = fold_beside(corner, border_, side);
    if (fold && fold->parameters != corner.parameters) direction = way(here, row(*fold, PointType::fold));
  }
  direction /= steps(direction, here).norm();
  here.tangent = direction;
  turn(direction, slopes_.regime(side));
  if (turns) {
    if (!add_fold(corner, border_, side)) {
      stop(Stop::grazing_border, fmt::format("the extremum turns beside a border, at {}", place()));
      return false;
    }
  } else if (told_to_end_ || !fill(border_, corner, value(corner), value(*next), side)) {
    return false;
  }
  passes_ = true;
  smooth(guess_at(*next, direction), true, 0);
  return true;
}

/// An extremum inside the regime of a side, beside a corner: of those along the border where the slope on it
/// has another sign than `inside` the farthest to which they lead. At the corner their distance is `least`.
std::optional<BasePoint> ExtremumCurve::first_inside(const BasePoint& corner, Side side, double inside,
                                                     double least) {
  BorderProblem edge(base_, problem_.active(), border_);
  struct Found {
    BasePoint point;
    double way;  // along the border, which may be shorter than asked for
  };
  const auto beside = [&](bool up, double way) -> std::optional<Found> {
    const std::vector<BranchPoint> step = step_off(edge, corner, up, way);
    if (step.empty() || !(slopes_.slope(split(step.back()), side) * inside < 0)) return std::nullopt;
    const auto found = slopes_.extremum_inside(split(step.back()), side);
    return found ? std::optional(Found{*found, step.back().arclength}) : std::nullopt;
  };
  std::optional<Found> last;
  for (const bool up : {true, false}) {
    for (double way = 10 * shortest_way; way <= 1.1 * longest_way; way *= 4) {
      const auto next = beside(up, way);
      // They come to the border as the way does, or as its square: all that is farther is another extremum.
      const auto leads = [&](const Found& from, const Found& to) {
        const double growth = to.way / from.way;
        const double most = 2 * growth * growth * std::abs(distance(from.point) - least);
        return distance(to.point) - least < std::max(most, shortest_way);
      };
      if (last && (!next || !leads(*last, *next))) break;
      if (next && distance(next->point) < narrow) last = next;
      if (next && last) last = next;
    }
    if (last) return last->point;
  }
  return std::nullopt;
}

/// A point on a border to rounding, if Newton's method comes so far.
BasePoint ExtremumCurve::settled(const BasePoint& point, int border) const {
  constexpr double rounding = 1e-14;
  BorderProblem edge(base_, problem_.active(), border);
  const auto located = locate(edge, point, rounding);
  return located ? located->point : point;
}

/// The point on a border at a value of the parameter, next to another one.
BasePoint ExtremumCurve::at_value(const BasePoint& next, int border, double value) const {
  Guess guess = guess_at(next);
  guess.parameters(parameter_) = value;
  return settled(problem_.split(guess.unknowns, guess.parameters, next.regime), border);
}

/// A place on a border where the slope on a side vanishes, to rounding: the tracer's points are good to its
/// tolerance, and of a sharp response the slope there is not.
BasePoint ExtremumCurve::refined(const BasePoint& point, int border, Side side) {
  constexpr double farthest = 1e-5;
  const double place = value(point);
  const double scale =
      1 / steps(Vector::Ones(problem_.size() + 1), row(point, PointType::regular))(problem_.size());
  const auto slope_at = [&](double at) { return slopes_.slope(at_value(point, border, at), side); };
  for (double reach = shortest_way; reach <= farthest; reach *= 10) {
    const double low = place - reach * scale;
    const double high = place + reach * scale;
    const double at_low = slope_at(low);
    const double at_high = slope_at(high);
    if (!(at_low * at_high < 0)) continue;
    return at_value(point, border, zero_between(slope_at, low, high, at_low, at_high));
  }
  return settled(point, border);
}

/// From a border.
double ExtremumCurve::distance(const BasePoint& point) const {
  const auto nearest = nearest_border(base_, problem_.active(), point, point.regime);
  return nearest ? nearest->distance : std::numeric_limits<double>::infinity();
}

/// Where the curve that leaves a corner into the regime of a side turns in its parameter, close to the
/// border: the slope inside, which has another sign at the border and further on, just touches zero. It is
/// the corner itself if that is nearer than the shortest way.
std::optional<BasePoint> ExtremumCurve::fold_beside(const BasePoint& corner, int border, Side side) {
  const double inside = next_inside(corner, side).slope;
  std::optional<BasePoint> top;
  const double scale =
      1 / steps(Vector::Ones(problem_.size() + 1), row(corner, PointType::regular))(problem_.size());
  const auto height = [&](double along, bool up) {
    const BasePoint from = at_value(corner, border, value(corner) + (up ? along : -along) * scale);
    if (!(slopes_.slope(from, side) * inside < 0)) return std::nan("");
    const auto highest = slopes_.steepest_inside(from, side, inside, narrow);
    if (highest) top = highest->point;
    return highest ? highest->slope : std::nan("");
  };
  for (const bool up : {true, false}) {
    double before = shortest_way;
    double at_before = height(before, up);
    if (at_before <= 0) return corner;
    for (double along = 2 * before; at_before > 0 && along < longest_way; along *= 2) {
      const double here = height(along, up);
      if (here <= 0) {
        height(zero_between([&](double x) { return height(x, up); }, before, along, at_before, here), up);
        return top;
      }
      before = along;
      at_before = here;
    }
  }
  return std::nullopt;
}

/// Rows of where the curve turns close to a border, coming from the last row.
bool ExtremumCurve::add_fold(const BasePoint& corner, int border, Side side) {
  const auto found = fold_beside(corner, border, side);
  if (!found) return false;
  if (found->parameters == corner.parameters) return true;
  BranchPoint fold = row(*found, PointType::fold);
  fold.tangent = way(curve_.points.back(), fold);
  fold.tangent /= steps(fold.tangent, fold).norm();
  fold.tangent(fold.tangent.size() - 1) = 0;
  const double rises = observable_rate(fold, way(curve_.points.back(), fold));
  add(fold);
  if (!options_.extrema_of.empty()) {
    fold.type = rises > 0 ? PointType::peak : PointType::trough;
    add(fold);
  }
  return !told_to_end_;
}

/// How the observable whose extrema are looked for along the curve changes in a direction.
double ExtremumCurve::observable_rate(const BranchPoint& at, const Vector& direction) const {
  if (options_.extrema_of.empty()) return 0;
  const Index which = index_of(observable_names(problem_), options_.extrema_of.front());
  const Index last = problem_.size();
  Gradient gradient{Vector::Zero(last), Vector::Zero(at.parameters.size())};
  const double size = std::abs(problem_.observe(at.unknowns, at.parameters, at.regime, which, gradient));
  return (gradient.unknowns.dot(direction.head(last)) + gradient.parameters(parameter_) * direction(last)) /
         size;
}

/// Where a piece within a regime comes to a border, as the last row.
std::optional<Place> ExtremumCurve::meeting() {
  BranchPoint& last = curve_.points.back();
  const BasePoint at = split(last);
  const auto nearest = nearest_border(base_, problem_.active(), at, at.regime);
  if (!nearest || !(std::abs(nearest->distance) < within_reach)) return std::nullopt;
  if (base_.regime_beyond(at.regime, nearest->border) < 0) return std::nullopt;
  if (curve_.stop != Stop::left_regime) return meeting_beside(last, *nearest);
  last.type = PointType::regime_switch;
  last.arrival = last.tangent;
  return Place{at, at.regime, last.tangent, {}};
}

/// Whether the curve turns in its parameter between a point beside a border and the place on it where the
/// slope vanishes: then the extremum that leaves this place is another one. It leaves on the side on which
/// the slope on the border has another sign than inside, and is the first one inside.
bool ExtremumCurve::turns_between(const BasePoint& point, const NearestBorder& nearest,
                                  const BasePoint& beside, const BasePoint& place) {
  constexpr double same = 0.01;  // of the distance
  const double on_edge = slopes_.slope(beside, CornerSlopes::arriving);
  const auto first = slopes_.extremum_inside(beside, CornerSlopes::arriving);
  slopes_.begin(place, nearest.border);
  if (!first || on_edge * next_inside(place, CornerSlopes::arriving).slope > 0) return true;
  const auto there = nearest_border(base_, problem_.active(), *first, point.regime);
  return !(std::abs(there->distance / nearest.distance - 1) < same);
}

/// Where the slope vanishes on the border beside the last row.
std::optional<Place> ExtremumCurve::meeting_beside(const BranchPoint& last, const NearestBorder& nearest) {
  const Index active = problem_.active();
  const BasePoint from = split(last);
  Gradient gradient{Vector::Zero(problem_.size()), Vector::Zero(last.parameters.size())};
  const double border =
      problem_.border(last.unknowns, last.parameters, last.regime, nearest.border, &gradient);
  const Index n = problem_.size();
  const double rate =
      gradient.unknowns.dot(last.tangent.head(n)) + gradient.parameters(parameter_) * last.tangent(n);
  // A curve that touches the border comes to it twice as far on as one that crosses it.
  constexpr double sure = 10;
  const double most = std::clamp(sure * std::abs(border / rate), shortest_way, std::sqrt(within_reach));
  if (!std::isfinite(most)) return std::nullopt;
  BorderProblem edge(base_, active, nearest.border);
  const auto beside = locate(edge, from, options_.tolerance);
  if (!beside || !slopes_.begin(beside->point, nearest.border)) return std::nullopt;
  TraceOptions options = freely(most);
  options.max_points = 1000;
  options.events.push_back({before_vanishes, [&](const Vector& u, const Vector& p, int regime) {
                              return slopes_.slope(edge.split(u, p, regime), CornerSlopes::arriving);
                            }});
  options.stop_after.push_back({PointType::event, 1, before_vanishes});
  std::optional<BranchPoint> found;
  for (const bool up : {true, false}) {
    if (!edge.adapt(beside->point)) return std::nullopt;
    Branch way = trace_one_way(edge, guess_at(beside->point), up, options,
                               [&](const BranchPoint& point) { return point.arclength <= most; });
    if (way.points.empty() || way.points.back().type != PointType::event) continue;
    if (!found || way.points.back().arclength < found->arclength) found = way.points.back();
  }
  if (!found) return std::nullopt;
  const BasePoint at = refined(split(*found), nearest.border, CornerSlopes::arriving);
  const bool turns = turns_between(from, nearest, beside->point, at);
  if (turns && !add_fold(at, nearest.border, CornerSlopes::arriving)) return std::nullopt;
  if (!turns && !fill(nearest.border, at, value(from), value(at), CornerSlopes::arriving))
    return std::nullopt;
  BranchPoint corner = row(at, PointType::regime_switch);
  const Vector chord = way(curve_.points.back(), corner);
  corner.arrival = chord / steps(chord, corner).norm();
  // A parabola in between.
  if (!turns) corner.arrival = 2 * corner.arrival - curve_.points.back().tangent;
  corner.arrival /= steps(corner.arrival, corner).norm();
  corner.tangent = corner.arrival;
  const Vector arrival = corner.arrival;
  add(std::move(corner));
  if (told_to_end_) return std::nullopt;
  return Place{at, at.regime, arrival, {}};
}

/// Whether it has come back to its start, behind which it is cut.
bool ExtremumCurve::came_back() {
  constexpr double same = 1e-7;
  const BranchPoint& start = curve_.points.front();
  for (std::size_t i = std::max<std::size_t>(seen_, 1); seen_ > 0 && i < curve_.points.size(); ++i) {
    BranchPoint& point = curve_.points[i];
    if (point.regime != start.regime || !(steps(way(start, point), start).norm() < same)) continue;
    point.type = PointType::end;
    curve_.points.resize(i + 1);
    stop(Stop::closed_loop, "the branch came back to its start");
    return true;
  }
  seen_ = curve_.points.size();
  return false;
}

/// Adds the next piece; false where the curve has come to an end.
bool ExtremumCurve::go_on() {
  if (curve_.points.empty() || curve_.stop == Stop::closed_loop || came_back()) return false;
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
                        curve_.stop == Stop::no_value;
  if (!is_stuck) return false;
  if (const auto place = meeting()) return leave(*place);
  if (told_to_end_ || !near_ || curve_.stop != Stop::interrupted) return false;
  passes_ = true;
  const Guess guess{last.unknowns, last.parameters, last.regime, last.tangent};
  smooth(guess, true, 1);
  return true;
}

Branch ExtremumCurve::half(const BasePoint& start, bool corner, bool towards_to) {
  if (corner) {
    const bool up = towards_to == (options_.to > options_.from);
    for (const Ledge& ledge : ledges({start, std::nullopt, {}, std::nullopt})) {
      if ((ledge.direction(ledge.direction.size() - 1) > 0) != up) continue;
      along(ledge, std::nullopt);
      break;
    }
  } else {
    smooth(guess_at(start), towards_to, 0);
  }
  while (go_on()) curve_.checkpoint.reset();
  return std::move(curve_);
}

}  // namespace

Branch trace_extrema(ExtendedProblem& problem, const BasePoint& start, const TraceOptions& options,
                     const CurveWindow& window, const Observer& observer) {
  const long before = problem.evaluations();
  const auto nearest = nearest_border(problem.base(), problem.active(), start, start.regime);
  const bool corner = nearest && std::abs(nearest->distance) <= on_border;
  std::optional<LocatedPoint> located;
  if (corner) {
    BorderProblem edge(problem.base(), problem.active(), nearest->border);
    located = locate(edge, start, options.tolerance);
  } else {
    located = locate(problem, start, options.tolerance);
  }
  const long to_locate = problem.evaluations() - before;
  if (!located) {
    Branch none;
    none.explanation = "no special point of this kind was found next to the start";
    return none;
  }
  const TimeBudget time(options);
  std::string why_first_ended;
  Guess guess;
  problem.join(located->point, guess.unknowns, guess.parameters);
  guess.regime = start.regime;
  const auto half = [&](bool towards_to, const TraceOptions& rest) {
    return ExtremumCurve(problem, rest, window, observer).half(located->point, corner, towards_to);
  };
  Branch curve = trace_parts([&] { return half(true, options); },
                             [&] {
                               Branch first = half(false, time.rest());
                               why_first_ended = first.explanation;
                               return first;
                             },
                             guess);
  curve.work.evaluations += to_locate;
  return most_telling(std::move(curve), why_first_ended);
}

}  // namespace arcslip::continuation
