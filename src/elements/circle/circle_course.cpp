#include "elements/circle/circle_course.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/dense.hpp"
#include "elements/circle/circle_changes.hpp"
#include "motion/bracketed_newton.hpp"
#include "motion/isolated_zeros.hpp"

namespace arcslip {
namespace {

constexpr std::size_t most_arcs = 2000;  // of a period

}  // namespace

CircleCourse::CircleCourse(const CircleMotion& motion, Complex guess, double begin)
    : motion_(motion), begin_(begin), width_(SlipPanel::widest(std::max(1, motion.highest()))) {
  const PeriodicMotion& press = motion.press();
  const std::vector<double> zeros = press.zeros();
  std::vector<std::pair<double, double>> contacts;  // where the parts touch, begin and end
  for (std::size_t i = 0; i < zeros.size(); ++i) {
    const bool is_last = i + 1 == zeros.size();
    const double end = is_last ? zeros.front() + two_pi : zeros[i + 1];
    if (press.value(0.5 * (zeros[i] + end)) > 0) contacts.emplace_back(zeros[i], end);
  }
  if (contacts.size() == zeros.size()) {  // never apart, or always
    if (press.value(begin) > 0)
      settle(guess);
    else
      arcs_.push_back({Phase::apart, begin, two_pi, 0, {}});
    return;
  }
  begins_apart_ = true;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    pass_contact(contacts[i].first, contacts[i].second, std::nullopt);
    const double next = i + 1 < contacts.size() ? contacts[i + 1].first : contacts[0].first + two_pi;
    if (next > contacts[i].second)
      arcs_.push_back({Phase::apart, contacts[i].second, next - contacts[i].second, 0, {}});
  }
  if (is_endless_) arcs_.clear();
}

/// By Newton's method for A = A + what a period moves it by; now and then by a period alone.
void CircleCourse::settle(Complex guess) {
  constexpr int most_rounds = 80;
  constexpr int alone = 8;
  constexpr double settled = 1e-13;
  constexpr double as_far_as_rounding_lets = 1e-9;
  pass(guess);
  Complex offset = guess + moved_;
  double last = std::numeric_limits<double>::infinity();
  for (int round = 1; round < most_rounds; ++round) {
    pass(offset);
    if (is_endless_) break;
    const Eigen::Matrix2d by_offset = Eigen::Matrix2d::Identity() - offset_by_offset(motion_, *this);
    const Eigen::Vector2d step = solution_of(by_offset, {moved_.real(), moved_.imag()});
    const double way = step.norm() / motion_.size();
    if (way <= settled || (way <= as_far_as_rounding_lets && way > 0.5 * last)) return;
    last = way;
    const bool is_near = step.allFinite() && way < 1 && round % alone != 0;
    offset += is_near ? Complex(step(0), step(1)) : moved_;
  }
  arcs_.clear();
}

void CircleCourse::pass(Complex offset) {
  arcs_.clear();
  slips_ = {};
  moved_ = 0;
  pass_contact(begin_, begin_ + two_pi, offset);
}

/// While the parts touch, with the slider at a place or, after having been apart, at none.
void CircleCourse::pass_contact(double begin, double end, std::optional<Complex> offset) {
  constexpr double same = 1e-9;
  double at = begin;
  Complex rests = 0;
  std::optional<double> direction = std::nullopt;  // of slip
  const CircleMotion::Local first = motion_.at(begin);
  if (offset) {
    rests = *offset;
    const Complex force = first.centre - rests;
    if (std::abs(force) >= first.radius) {
      const double phase = std::arg(force);
      rests = first.centre - first.radius * std::polar(1.0, phase);
      moved_ += rests - *offset;
      if (std::real(first.rate * std::polar(1.0, -phase)) > first.radius_rate) direction = phase;
    }
  } else if (std::abs(first.rate) > first.radius_rate) {
    direction = std::arg(first.rate);
  } else {
    rests = first.centre;
  }
  while (at < end && arcs_.size() < most_arcs) {
    SlipCount* begins = nullptr;
    if (!direction) {
      const double until = leaves(at, end, rests);
      arcs_.push_back({Phase::stick, at, until - at, rests, {}});
      if (until >= end) return;
      const Complex force = motion_.at(until).centre - rests;
      direction = std::arg(force);
      const bool goes_on = until - at < same;  // slip, but for rounding
      begins = goes_on ? nullptr : &slips_along(force);
      at = until;
    }
    at = slip(at, end, !offset, *direction);
    const Arc& arc = arcs_.back();
    if (!arc.panels.empty()) direction = arc.panels.back().phase(panel_nodes - 1);
    const CircleMotion::Local here = motion_.at(at);
    const Complex before = rests;
    rests = here.centre - here.radius * std::polar(1.0, *direction);
    if (begins && !arc.panels.empty())
      begins->slip(at < end ? std::abs(rests - before) : std::numeric_limits<double>::infinity());
    direction.reset();
  }
  if (at < end) is_endless_ = true;
}

/// Where the force reaches the circle, or the end. It falls from there at first where slip has ended.
/// Extremes of the excess are looked for one part of the period after the other, as stick may be short. It
/// begins with a slope of 0, near which others may be rounding: what comes near to the circle there is none
/// that is yet to reach it.
double CircleCourse::leaves(double begin, double end, Complex offset) {
  constexpr double rounding = 1e-15;
  constexpr double same = 1e-9;
  constexpr double beside = 1e-6;  // above the root of rounding
  constexpr double part = two_pi / 8;
  const PeriodicMotion slope = motion_.excess(offset, 0).derivative();
  const auto slope_at = [&](double theta) {
    const PeriodicMotion::Local here = slope.at(theta);
    return std::pair(here.value, here.first);
  };
  const auto excess = [&](double theta) {  // by its terms: of long ways the coefficients cancel
    const CircleMotion::Local here = motion_.at(theta);
    const Complex pull = here.centre - offset;
    return std::pair(std::norm(pull) - here.radius * here.radius,
                     2 * (dot(pull, here.rate) - here.radius * here.radius_rate));
  };
  double bound = 0;  // of the slope's second derivative
  for (Index h = 1; h < slope.coefficients().size(); ++h)
    bound += std::pow(static_cast<double>(h), 2) * std::abs(slope.coefficients()(h));
  const double zero = rounding * motion_.size() * motion_.size();
  double last = begin;
  std::vector<double> turns;
  for (double from = begin; from < end; from += part) {
    turns.clear();
    if (bound > 0) {
      isolate_zeros(slope_at, bound, {from, from + part}, [&](double theta) {
        if (theta > begin + same && theta < end) turns.push_back(theta);
      });
    }
    if (from + part >= end) turns.push_back(end);
    for (const double turn : turns) {
      if (excess(turn).first > zero) {
        if (excess(last).first >= 0) return last;
        return bracketed_newton(excess, 0.5 * (last + turn), last, turn, true);
      }
      if (turn > begin + beside && turn < end && slope.at(turn).first < 0) {
        const CircleMotion::Local here = motion_.at(turn);
        const Complex force = here.centre - offset;
        slips_along(force).stick(std::max(0.0, here.radius - std::abs(force)));
      }
      last = turn;
    }
  }
  return end;
}

/// Up to where v falls to 0, from nearly there, by Newton's method to rounding.
SlipPanel CircleCourse::stopped(SlipPanel::Reach reach, double phase) const {
  constexpr int steps = 3;
  SlipPanel panel = SlipPanel::resolved(motion_, reach, phase);
  for (int i = 0; i < steps; ++i) {
    const double change = panel.after_stop();
    if (!(std::abs(change) > 1e-16 && std::abs(change) < 1e-3 * reach.width)) break;
    reach.width -= change;
    panel = SlipPanel::resolved(motion_, reach, phase);
  }
  return panel;
}

/// Of slip, as wide as resolves it; towards lift-off in the logarithm of the way that is left unless all of
/// it is smooth.
SlipPanel CircleCourse::next(double begin, double end, bool lifts, double phase) {
  constexpr double shares = 0.998;  // of that way
  const double rest = end - begin;
  const bool is_last = width_ >= rest;
  const double widest = SlipPanel::widest(std::max(1, motion_.highest()));
  SlipPanel::Reach reach{begin, std::min({width_, widest, rest}), {}};
  double wider = 1;
  auto panel = SlipPanel::solved(motion_, reach, phase, wider);
  if (!panel && lifts && is_last) {
    if (rest < SlipPanel::smallest * 10) return SlipPanel::resolved(motion_, {begin, rest, {}}, phase);
    reach = {begin, shares * rest, end};
    panel = SlipPanel::solved(motion_, reach, phase, wider);
    for (; !panel; panel = SlipPanel::solved(motion_, reach, phase, wider))
      reach = reach.up_to(std::min(wider, 0.8));
  }
  for (; !panel; panel = SlipPanel::solved(motion_, reach, phase, wider))
    reach.width = std::max(std::min(wider, 0.8) * reach.width, SlipPanel::smallest);
  width_ = std::min(wider * reach.width, widest);
  return *panel;
}

/// Adds an arc of slip and returns where it ends.
double CircleCourse::slip(double begin, double end, bool lifts, double phase) {
  Arc& arc = arcs_.emplace_back(Arc{Phase::slip, begin, 0, 0, {}});
  double at = begin;
  while (at < end) {
    SlipPanel panel = next(at, end, lifts, phase);
    const std::optional<double> stops = panel.stop();
    if (stops && panel.reach.up_to(*stops).width <= SlipPanel::smallest) break;
    if (stops) panel = stopped(panel.reach.up_to(*stops), phase);
    for (Index j = 0; j < panel_nodes; ++j)
      moved_ += panel.weight(j) * panel.slip(j) * std::polar(1.0, panel.phase(j));
    at = panel.reach.width < end - at ? at + panel.reach.width : end;
    phase = panel.phase(panel_nodes - 1);
    arc.panels.push_back(std::move(panel));
    if (stops) break;
  }
  arc.width = at - begin;
  return at;
}

FurtherSlips CircleCourse::further_slips() const {
  const auto is_slip = [](const Arc& arc) { return arc.phase == Phase::slip; };
  if (!begins_apart_ && std::none_of(arcs_.begin(), arcs_.end(), is_slip)) return FurtherSlips::at_border();
  const bool with_ways = begins_apart_ || slips_[0].count() + slips_[1].count() > 2;
  return FurtherSlips::of(slips_, motion_.size(), with_ways);
}

double CircleCourse::fraction(Phase phase) const {
  double sum = 0;
  for (const Arc& arc : arcs_) sum += arc.phase == phase ? arc.width : 0;
  return sum / two_pi;
}

}  // namespace arcslip
