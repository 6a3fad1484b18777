#include "arcslip/elements/hysteresis_loop.hpp"

#include <cmath>
#include <tuple>
#include <utility>

#include "arcslip/motion/arc_integrals.hpp"
#include "motion/bracketed_newton.hpp"

namespace arcslip {
namespace {

constexpr Complex j{0, 1};

}  // namespace

HysteresisLoop::HysteresisLoop(const OddMotion& motion, double slip_threshold)
    : motion_(motion), slip_threshold_(slip_threshold) {
  march();
}

/// How far beyond a turning point the motion has changed by `room`.
double HysteresisLoop::way_to_slip(const OddMotion::Departure& departure, double longest, double room) {
  const double guess = std::sqrt(2 * std::abs(room / departure.bend()));
  return bracketed_newton(
      [&](double step) {
        const OddMotion::Departure::Way way = departure.after(step);
        return std::pair(way.change - room, way.slope);
      },
      guess < longest ? guess : 0.5 * longest, 0.0, longest, room > 0);
}

void HysteresisLoop::march() {
  const Angles found = motion_.turning_points();
  int first = 0;
  for (int i = 0; i < found.count; ++i) {
    const double here = std::abs(motion_.value(found[i]));
    if (here > amplitude_) std::tie(amplitude_, first) = std::pair(here, i);
  }
  const double lead = motion_.value(found[first]) > 0 ? 0 : pi;  // shifts the largest to a maximum
  const auto turn = [&](int i) {
    const int place = first + i;
    return place < found.count ? found[place] + lead : found[place - found.count] + pi + lead;
  };
  begin_ = turn(0);

  double force = slip_threshold_;
  double anchor = begin_;
  double before = 1;
  bool sticking = true;
  for (int i = 0; i < found.count; ++i) {
    const double longest = turn(i + 1) - turn(i);
    const OddMotion::Departure departure(motion_, turn(i));
    const double change = departure.after(longest).change;
    const double sign = change > 0 ? 1 : -1;
    const double room = sign * slip_threshold_ - force;
    const double way = std::abs(change) - std::abs(room);
    sticking = way <= 0;
    if (sticking) {
      force += change;
      if (i + 1 < found.count) further_.stick(-way);
      continue;
    }
    stick_[sticks_++] = {anchor, turn(i) - anchor + way_to_slip(departure, longest, room), before, sign};
    before = sign;
    slipped_ += way;
    ++slips_;
    further_.slip(way);
    force = sign * slip_threshold_;
    anchor = turn(i + 1);
  }
  if (sticking) stick_[sticks_++] = {anchor, begin_ + pi - anchor, before, 0};
  if (sticking) further_.slip(0);  // at the border itself
  mismatch_ = force + slip_threshold_;
}

void HysteresisLoop::force(HarmonicVector& harmonics) const {
  const std::span<const int> orders = motion_.orders();
  const HarmonicVector& r = motion_.coefficients();
  const Index count = r.size();
  harmonics.resize(count);
  for (Index a = 0; a < count; ++a)
    harmonics(a) = mismatch_ * std::polar(1.0, -orders[static_cast<std::size_t>(a)] * begin_);
  for (std::size_t arc = 0; arc < sticks_; ++arc) {
    const ArcIntegrals integral(stick_[arc].begin, stick_[arc].width, 2 * highest_order(orders));
    for (Index b = 0; b < count; ++b) {
      const int l = orders[static_cast<std::size_t>(b)];
      const Complex velocity = 0.5 * l * j * r(b);
      for (Index a = 0; a < count; ++a) {
        const int h = orders[static_cast<std::size_t>(a)];
        harmonics(a) += velocity * integral[l - h] + std::conj(velocity * integral[l + h]);
      }
    }
  }
  for (Index a = 0; a < count; ++a) harmonics(a) *= -j * (2 / (pi * orders[static_cast<std::size_t>(a)]));
}

void HysteresisLoop::derivative(ComplexMatrix& linear, ComplexMatrix& conjugate) const {
  const std::span<const int> orders = motion_.orders();
  const Index count = motion_.coefficients().size();
  linear.setZero(count, count);
  conjugate.setZero(count, count);
  for (std::size_t arc = 0; arc < sticks_; ++arc) {
    const ArcIntegrals integral(stick_[arc].begin, stick_[arc].width, 2 * highest_order(orders));
    for (Index b = 0; b < count; ++b) {
      const int l = orders[static_cast<std::size_t>(b)];
      const Complex turn = std::polar(1.0, l * stick_[arc].begin);
      for (Index a = 0; a < count; ++a) {
        const int h = orders[static_cast<std::size_t>(a)];
        linear(a, b) += integral[l - h] - turn * integral[-h];
        conjugate(a, b) += std::conj(integral[l + h] - turn * integral[h]);
      }
    }
  }
  linear *= 1 / pi;
  conjugate *= 1 / pi;
}

void HysteresisLoop::second(const HarmonicVector& motion, double threshold, ComplexMatrix& linear,
                            ComplexMatrix& conjugate) const {
  const std::span<const int> orders = motion_.orders();
  const Index count = motion.size();
  const OddMotion change(orders, motion);
  linear.setZero(count, count);
  conjugate.setZero(count, count);
  for (std::size_t arc = 0; arc < sticks_; ++arc) {
    const auto [begin, width, before, behind] = stick_[arc];
    const ArcIntegrals integral(begin, width, highest_order(orders));
    const double shift = change.slopes(begin).first / motion_.slopes(begin).second;
    const double end = begin + width;
    const double slip = behind == 0 ? 0
                                    : (change.change(begin, width) + (before - behind) * threshold) /
                                          motion_.slopes(end).first;
    for (Index b = 0; b < count; ++b) {
      const double l = orders[static_cast<std::size_t>(b)];
      const Complex turn = std::polar(1.0, l * begin);
      const Complex way = std::polar(1.0, l * end) - turn;
      for (Index a = 0; a < count; ++a) {
        const int h = orders[static_cast<std::size_t>(a)];
        const Complex fades = slip * std::polar(1.0, -h * end);
        linear(a, b) += j * l * turn * shift * integral[-h] - way * fades;
        conjugate(a, b) += std::conj(j * l * turn) * shift * integral[-h] - std::conj(way) * fades;
      }
    }
  }
  linear *= 1 / pi;
  conjugate *= 1 / pi;
}

}  // namespace arcslip
