#include "arcslip/elements/pressed/pressed_arcs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "arcslip/motion/swing.hpp"
#include "motion/bracketed_newton.hpp"

namespace arcslip {
namespace {

/// a x + b y.
PeriodicMotion combined(double a, const PeriodicMotion& x, double b, const PeriodicMotion& y) {
  ComplexVector sum = ComplexVector::Zero(std::max(x.highest(), y.highest()) + 1);
  sum.head(x.highest() + 1) += a * x.coefficients();
  sum.head(y.highest() + 1) += b * y.coefficients();
  return PeriodicMotion(std::move(sum)).drifting(a * x.drift() + b * y.drift());
}

}  // namespace

PeriodicMotion pressing_motion(const PressedSettings& settings, const PeriodicMotion& closing) {
  ComplexVector press = settings.normal_stiffness * closing.coefficients();
  press(0) += settings.normal_force;
  return PeriodicMotion(std::move(press));
}

PressedArcs::PressedArcs(const PressedSettings& settings, const PeriodicMotion& sliding,
                         const PeriodicMotion& closing, Course course)
    : settings_(settings),
      sliding_(sliding),
      press_(pressing_motion(settings, closing)),
      low_(combined(settings.tangential_stiffness, sliding, -settings.friction, press_)),
      high_(combined(settings.tangential_stiffness, sliding, settings.friction, press_)) {
  if (!(settings.tangential_stiffness > 0 && settings.friction >= 0 && settings.normal_stiffness >= 0))
    throw std::invalid_argument(
        "PressedArcs: the tangential stiffness must be positive, friction and normal stiffness not negative");
  cut();
  if (course == Course::sticks || course == Course::rests) {
    stay_stuck(course == Course::rests);
  } else if (course == Course::drifts) {
    settle_drifting();
  } else if (course == Course::slips && room() >= 0) {
    slip_no_way();
  } else {
    settle();
  }
}

/// A second period is the settled one.
void PressedArcs::settle() {
  if (cells_.front().touches) {
    if (nodes_.front().low > 0)
      hold(nodes_.front(), 1);
    else if (nodes_.front().high < 0)
      hold(nodes_.front(), -1);
  }
  pass(false);
  pass(true);
  join_ends();
}

/// What goes on over the end of the period is one arc.
void PressedArcs::join_ends() {
  Arc& first = arcs_.front();
  const Arc& last = arcs_.back();
  if (arcs_.size() > 1 && first.phase == last.phase && first.direction == last.direction &&
      first.anchor == last.anchor) {
    first.begin = last.begin - two_pi;
    first.width += last.width;
    arcs_.pop_back();
  }
}

/// From a bound that all before it has not passed on, so that here, too, a second period is the settled one:
/// with A so much further as the period takes the sliding displacement. Where it would stick but for one side
/// A goes that way, or none against a drift that a corrector tries.
void PressedArcs::settle_drifting() {
  const auto swing = [](const PeriodicMotion& bound) {
    const PeriodicMotion still = bound.drifting(0);
    return Swing::at(still, still.derivative().zeros());
  };
  const double low = swing(low_).greatest.value;
  const double high = swing(high_).least.value;
  const bool is_one_sided = high >= low;
  const double drift = low_.drift();
  const bool forwards = is_one_sided || drift == 0 ? low >= -high : drift > 0;
  if (is_one_sided && (forwards ? drift < 0 : drift > 0)) return stay_against_drift(forwards);
  hold(nodes_.front(), forwards ? 1 : -1);
  pass(false);
  now_.offset -= two_pi * drift;
  pass(true);
  join_ends();
  if (is_stuck()) arcs_.front().begin = arcs_.front().anchor;
  for (Arc& arc : arcs_) {
    if (arc.anchor > arc.begin) arc.anchor -= two_pi;
  }
}

/// From where the bound is farthest for a whole period.
void PressedArcs::stay_against_drift(bool forwards) {
  const auto nearer = [&](const Node& a, const Node& b) {
    const double way = low_.drift() * (b.angle - a.angle);
    return forwards ? b.low - a.low > way : b.high - a.high < way;
  };
  const Node& far = *std::max_element(nodes_.begin(), nodes_.end(), nearer);
  hold(far, forwards ? 1 : -1);
  records_ = true;
  add(far.angle, two_pi);
}

/// At all zeros, or at 0 where nothing moves.
void PressedArcs::cut() {
  std::vector<double> angles;
  if (press_.coefficients().tail(press_.highest()).isZero(0)) {  // both bounds turn where the sliding does
    turns_ = sliding_.derivative().zeros();
    angles = *turns_;
  } else {
    angles = press_.zeros();
    for (const PeriodicMotion* bound : {&low_, &high_}) {
      const std::vector<double> turns = bound->derivative().zeros();
      angles.insert(angles.end(), turns.begin(), turns.end());
    }
    std::sort(angles.begin(), angles.end());
    angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  }
  if (angles.empty()) angles.push_back(0);
  for (const double angle : angles) nodes_.push_back({angle, low_.value(angle), high_.value(angle)});
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const bool is_last = i + 1 == nodes_.size();
    Node end = nodes_[is_last ? 0 : i + 1];
    if (is_last) {
      end.low += two_pi * low_.drift();
      end.high += two_pi * high_.drift();
    }
    const double width = end.angle - nodes_[i].angle + (is_last ? two_pi : 0);
    const double middle = nodes_[i].angle + 0.5 * width;
    cells_.push_back({nodes_[i], end, width, press_.value(middle) > 0, low_.at(middle).first > 0,
                      high_.at(middle).first < 0});
  }
}

void PressedArcs::pass(bool record) {
  records_ = record;
  for (const Cell& cell : cells_) {
    if (!cell.touches) {
      now_ = {0, 0, Phase::apart};
      add(cell.begin.angle, cell.width);
      continue;
    }
    const bool goes_on = now_.direction > 0 ? cell.forwards : cell.backwards;
    if (now_.phase == Phase::apart) {
      touch(cell);
    } else if (now_.phase == Phase::slip && !goes_on) {
      hold(cell.begin, now_.direction);
    }
    if (now_.phase == Phase::slip) {
      add(cell.begin.angle, cell.width);
    } else {
      stick(cell);
    }
  }
}

/// With A as near to zero as its bounds let it be. Beyond the border they have changed places, which at the
/// border of a motion without mean they may do by rounding.
void PressedArcs::stay_stuck(bool at_zero) {
  constexpr double rounding = 1e-13;
  const double zero = rounding * (std::abs(highest_high().high) + std::abs(lowest_low().low));
  const double low = highest_low().low;
  const double high = lowest_high().high;
  if (!at_zero && std::min(low, high) > zero)
    hold(highest_low(), 1);
  else if (!at_zero && std::max(low, high) < -zero)
    hold(lowest_high(), -1);
  records_ = true;
  add(0, two_pi);
}

/// From where the lower bound has taken A to where the upper one does, and back.
void PressedArcs::slip_no_way() {
  records_ = true;
  const double way = std::remainder(lowest_high().angle - highest_low().angle, two_pi);
  const double width = way < 0 ? way + two_pi : way;
  hold(highest_low(), 1);
  add(now_.anchor, width);
  hold(lowest_high(), -1);
  add(now_.anchor, two_pi - width);
}

/// After having been apart.
void PressedArcs::touch(const Cell& cell) {
  const double angle = cell.begin.angle;
  if (cell.forwards || cell.backwards) {
    now_ = {0, 0, Phase::slip, cell.forwards ? 1 : -1};
    return;
  }
  const double stiffness = settings_.tangential_stiffness;
  const PeriodicMotion::Local slid = sliding_.at(angle);
  const double closes = press_.at(angle).first;
  now_ = {0,
          0,
          Phase::stick,
          0,
          stiffness * slid.value,
          angle,
          true,
          closes > 0 ? -stiffness * slid.first / closes : 0,
          true};
}

/// At the end of slip.
void PressedArcs::hold(const Node& node, int direction) {
  now_ = {0,
          0,
          Phase::stick,
          0,
          direction > 0 ? node.low : node.high,
          node.angle,
          true,
          -direction * settings_.friction};
}

/// Where the bound that slip in this direction begins at reaches A; behind the cell where it does not.
double PressedArcs::onset(const Cell& cell, int direction) const {
  const bool forwards = direction > 0;
  const PeriodicMotion& bound = forwards ? low_ : high_;
  const double excess = (forwards ? cell.end.low : cell.end.high) - now_.offset;
  if (!((forwards ? cell.forwards : cell.backwards) && direction * excess > 0))
    return std::numeric_limits<double>::infinity();
  return bracketed_newton(
      [&](double step) {
        const PeriodicMotion::Local at = bound.at(cell.begin.angle + step);
        return std::pair(at.value - now_.offset, at.first);
      },
      0.5 * cell.width, 0.0, cell.width, forwards);
}

void PressedArcs::stick(const Cell& cell) {
  const double forwards = onset(cell, 1);
  const double backwards = onset(cell, -1);
  const double until = std::min({forwards, backwards, cell.width});
  add(cell.begin.angle, until);
  if (std::isinf(forwards) && std::isinf(backwards)) return;
  now_ = {0, 0, Phase::slip, forwards <= backwards ? 1 : -1};
  add(cell.begin.angle + until, cell.width - until);
}

/// What goes on in the same way is the same arc.
void PressedArcs::add(double begin, double width) {
  if (!records_ || !(width > 0)) return;
  if (!arcs_.empty() && arcs_.back().phase == now_.phase && arcs_.back().direction == now_.direction &&
      arcs_.back().anchor == now_.anchor) {
    arcs_.back().width += width;
    return;
  }
  arcs_.push_back(now_);
  arcs_.back().begin = begin;
  arcs_.back().width = width;
}

/// Between its ends, at none of which A was set.
void PressedArcs::count_lacking(const Arc& arc, std::array<SlipCount, 2>& counts) const {
  constexpr double same = 1e-12;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    const double way = node.angle - arc.begin;
    const bool is_inside = way - two_pi * std::floor(way / two_pi) < arc.width;
    if (!is_inside || std::abs(std::remainder(node.angle - arc.anchor, two_pi)) < same) continue;
    const Cell& before = cells_[(i + cells_.size() - 1) % cells_.size()];
    const Cell& behind = cells_[i];
    if (before.forwards && !behind.forwards) counts[0].stick(arc.offset - node.low);
    if (before.backwards && !behind.backwards) counts[1].stick(node.high - arc.offset);
  }
}

FurtherSlips PressedArcs::further_slips() const {
  std::array<SlipCount, 2> counts;
  bool comes_apart = false;
  for (std::size_t i = 0; i < arcs_.size(); ++i) {
    const Arc& arc = arcs_[i];
    const Arc& before = arcs_[(i + arcs_.size() - 1) % arcs_.size()];
    const Arc& behind = arcs_[(i + 1) % arcs_.size()];
    comes_apart = comes_apart || arc.phase == Phase::apart;
    if (arc.phase == Phase::stick) count_lacking(arc, counts);
    if (arc.phase != Phase::slip || before.phase != Phase::stick) continue;
    counts[arc.direction > 0 ? 0 : 1].slip(behind.phase == Phase::stick
                                               ? std::abs(behind.offset - before.offset)
                                               : std::numeric_limits<double>::infinity());
  }
  const auto is_slip = [](const Arc& arc) { return arc.phase == Phase::slip; };
  if (!comes_apart && std::none_of(arcs_.begin(), arcs_.end(), is_slip)) return FurtherSlips::at_border();
  const bool with_ways = comes_apart || counts[0].count() + counts[1].count() > 2;
  const double unit = std::abs(highest_high().high) + std::abs(lowest_low().low);
  return FurtherSlips::of(counts, unit, with_ways);
}

double fraction_of(std::span<const PressedArcs::Arc> arcs, PressedArcs::Phase phase) {
  double sum = 0;
  for (const PressedArcs::Arc& arc : arcs) sum += arc.phase == phase ? arc.width : 0;
  return sum / two_pi;
}

}  // namespace arcslip
