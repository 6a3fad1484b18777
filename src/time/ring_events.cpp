// Where elements change their phases.

#include <limits>

#include "arcslip/time/ring_motion.hpp"
#include "time/first_crossing.hpp"

namespace arcslip {
namespace {

constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();
constexpr double near = 1e-8;  // time of events told ahead, over the fastest rate

/// The square of a polynomial.
Vector square(const Vector& c) {
  Vector product = Vector::Zero(2 * c.size() - 1);
  for (Index i = 0; i < c.size(); ++i) product.segment(i, c.size()) += c(i) * c;
  return product;
}

/// The derivative of a polynomial.
Vector derivative(const Vector& c) {
  return c.tail(c.size() - 1)
      .cwiseProduct(Vector::LinSpaced(c.size() - 1, 1, static_cast<double>(c.size() - 1)));
}

}  // namespace

/// |k (r - z)|^2 - (mu N)^2 of a circle that sticks.
Vector RingMotion::excess(Index which, const RingState& state) const {
  const RingCircle& circle = *family(which).law->circle();
  double loose = 0;  // of forces
  double size = 0;
  Vector sum = Vector::Zero(2 * segment_.motion.cols() - 1);
  for (const Index number : {0, 1}) {
    const Index row = row_of(family(which), number) + node(which);
    Vector pull = circle.stiffness * segment_.motion.row(row).transpose();
    pull(0) -= circle.stiffness * state.memory(memory_place(which, number));
    sum += square(pull);
    loose += circle.stiffness * loose_(row);
    size += std::abs(pull(0));
  }
  Vector limit = Vector::Zero(segment_.motion.cols());
  if (family(which).closing >= 0) {
    const Index row = family(which).closing + node(which);
    limit = circle.friction * circle.normal_stiffness * segment_.motion.row(row).transpose();
    loose += circle.friction * circle.normal_stiffness * loose_(row);
  }
  limit(0) += circle.friction * circle.normal_force;
  sum -= square(limit);
  size += std::abs(limit(0));
  sum(0) -= size * (2 * loose + rounding * size);
  return sum;
}

/// -v of a circle that slips.
Vector RingMotion::opposite_slip(Index which) const {
  for (std::size_t i = 0; i < slips_.size(); ++i) {
    if (varying_.circles[i].element != which) continue;
    Vector opposite = -slips_[i].slip();
    for (const Index row : {family(which).sliding, family(which).across})
      opposite(0) -= loose_rate_(row + node(which));
    return opposite;
  }
  throw std::logic_error("RingMotion: a circle that does not slip");
}

/// What rises through zero at an event, in powers of the segment's scale. What sums of displacements and
/// velocities may be wrong by is no crossing.
Vector RingMotion::event_function(Index which, const RingEvent& event, const RingState& state) const {
  using Of = RingEvent::Of;
  if (event.of == Of::excess) return excess(which, state);
  if (event.of == Of::slip) return opposite_slip(which);
  Vector sum = Vector::Zero(segment_.motion.cols());
  double loose = 0;
  double loose_rate = 0;
  const auto add = [&](Index first, double part) {
    if (part == 0) return;
    const Index row = first + node(which);
    sum += part * segment_.motion.row(row).transpose();
    loose += std::abs(part) * loose_(row);
    loose_rate += std::abs(part) * loose_rate_(row);
  };
  add(family(which).sliding, event.sliding);
  add(family(which).closing, event.closing);
  if (event.of == Of::rate) {
    Vector rate = derivative(sum);
    rate(0) -= loose_rate;
    return rate;
  }
  if (event.of != Of::place) {
    const double time = (event.of == Of::place_ahead ? near : -near) / (rate_ * segment_.scale);
    sum.head(sum.size() - 1) += time * derivative(sum);
  }
  sum(0) -= loose + event.level + rounding * std::abs(event.level);
  return sum;
}

const std::vector<RingMotion::Crossing>& RingMotion::first_crossings(const RingState& state) {
  loose_ = rounding * (sizes_ * state.position.cwiseAbs());
  loose_rate_ = (rounding * segment_.scale) * (sizes_ * state.velocity.cwiseAbs());
  crossings_.clear();
  double first = 1;
  for (Index e = 0; e < elements(); ++e) {
    const auto& events = events_[static_cast<std::size_t>(e)];
    std::optional<Crossing> earliest;
    for (std::size_t k = 0; k < events.size(); ++k) {
      if (std::isinf(events[k].level)) continue;
      const auto ratio = first_crossing(event_function(e, events[k], state));
      if (!ratio || (earliest && *ratio >= earliest->ratio)) continue;
      earliest = Crossing{e, k, *ratio};
    }
    if (!earliest) continue;
    crossings_.push_back(*earliest);
    first = std::min(first, earliest->ratio);
  }
  std::erase_if(crossings_, [&](const Crossing& crossing) { return crossing.ratio > first * (1 + 1e-13); });
  for (Crossing& crossing : crossings_) crossing.ratio = first;
  return crossings_;
}

void RingMotion::take_events(RingState& state, RingObserver* observer) {
  for (const Crossing& crossing : crossings_) {
    const Index e = crossing.which;
    const RingPlace place = place_of(e, state.position, state.velocity);
    std::vector<double> memory = memory_of(e, state);
    const RingMemoryChanges changes =
        family(e).law->change(crossing.event, place, state.phase[static_cast<std::size_t>(e)], memory);
    for (std::size_t j = 0; j < memory.size(); ++j)
      state.memory(memory_place(e, static_cast<Index>(j))) = memory[j];
    refresh(e, state);
    ++count_.events;
    if (observer != nullptr) observer->change(e, changes, state);
  }
  if (!crossings_.empty()) gather();
}

}  // namespace arcslip
