#include "arcslip/time/ring_response.hpp"

#include <algorithm>
#include <cmath>

#include "arcslip/structure/spectrum.hpp"
#include "time/law_series.hpp"

namespace arcslip {
namespace {

/// Position, velocity and slider in one column.
Vector stacked(const RingState& state) {
  Vector all(2 * state.position.size() + state.slider.size());
  all << state.position, state.velocity, state.slider;
  return all;
}

RingState moved(const RingState& state, const Vector& step) {
  const Index coordinates = state.position.size();
  RingState sum = state;
  sum.position += step.head(coordinates);
  sum.velocity += step.segment(coordinates, coordinates);
  sum.slider += step.tail(state.slider.size());
  return sum;
}

/// Rows of `sliders` moved one node back.
Matrix turned_back(const Matrix& sliders) {
  Matrix next(sliders.rows(), sliders.cols());
  next.topRows(sliders.rows() - 1) = sliders.bottomRows(sliders.rows() - 1);
  next.bottomRows(1) = sliders.topRows(1);
  return next;
}

/// A difference of states in units of displacement.
Vector scaled(const RingMotion& motion, const Vector& all) {
  const Index coordinates = motion.ring().coordinates();
  Vector same = all;
  same.segment(coordinates, coordinates) /= motion.frequency();
  return same;
}

/// Its length once it has been freed of the drift.
double length_without_drift(const RingMotion& motion, const Vector& all) {
  const Vector drift = neutral_drift(motion.ring());
  const Vector same = scaled(motion, all);
  return (same - drift * drift.dot(same)).norm();
}

/// How far G(s) = next is from s: a drift that goes on is no settled motion.
double step_length(const RingMotion& motion, const RingState& state, const RingState& next) {
  return scaled(motion, stacked(next) - stacked(state)).norm();
}

double step_error(const RingMotion& motion, const RingState& state, const RingState& next) {
  return step_length(motion, state, next) / length_without_drift(motion, stacked(next));
}

/// delta of (I - dG/ds) delta = residual, without a drift, along which the matrix is singular. Least squares
/// also hold where contacts so soft that they hardly stop a drift let it look settled but for its own
/// progress.
Vector newton_step(const RingMotion& motion, const Matrix& derivative, const Vector& residual) {
  const Index size = residual.size();
  Matrix equations(size + 1, size);
  equations << Matrix::Identity(size, size) - derivative, neutral_drift(motion.ring()).transpose();
  Vector right(size + 1);
  right << scaled(motion, residual), 0;
  const Index coordinates = motion.ring().coordinates();
  equations.middleRows(coordinates, coordinates) /= motion.frequency();
  equations.middleCols(coordinates, coordinates) *= motion.frequency();
  // What further elements hold only at times may drift as well.
  constexpr double held = 1e-10;
  Vector step =
      motion.ring().others.empty() ? least_squares(equations, right) : least_squares(equations, right, held);
  step.segment(coordinates, coordinates) *= motion.frequency();
  return step;
}

/// One round of Newton's method. Where an event that a short step moves keeps G(s) from coming nearer to s,
/// the ring is marched instead, for the n periods in which every node takes every place.
RingState improved(RingMotion& motion, const RingState& state, const StateDerivative& here) {
  constexpr int most_halvings = 6;
  constexpr double progress = 0.9;
  const double gap = step_length(motion, state, here.next);
  const Vector step = newton_step(motion, here.derivative, stacked(here.next) - stacked(state));
  RingState base = state;
  base.slip = here.next.slip;
  double part = 1;
  for (int halving = 0; halving <= most_halvings; ++halving, part /= 2) {
    RingState trial = moved(base, part * step);
    if (step_length(motion, trial, next_state(motion, trial)) < progress * gap) return trial;
  }
  RingState marched = here.next;
  for (Index i = 1; i < motion.ring().nodes(); ++i) marched = next_state(motion, marched);
  return marched;
}

}  // namespace

RingTangent::RingTangent(const RingMotion& motion)
    : ring_(motion.ring()), rate_(motion.ring().fastest_rate()) {
  const Index coordinates = ring_.coordinates();
  const Index nodes = ring_.nodes();
  const Matrix all = Matrix::Identity(2 * coordinates + nodes, 2 * coordinates + nodes);
  position_ = all.topRows(coordinates);
  velocity_ = all.middleRows(coordinates, coordinates);
  slider_ = all.bottomRows(nodes);
}

/// Terms of df/dx of a further element in a step's own length: nodes x (order + 1).
Matrix RingTangent::slopes(std::size_t element, const RingSegment& segment, Index order) const {
  const Matrix& x = segment.other[element];
  LawSeries law(ring_.others[element].law(), segment.zones[element], order);
  Matrix all(ring_.nodes(), order + 1);
  double power = 1;
  for (Index m = 0; m <= order; ++m, power *= segment.length / segment.scale) {
    law.take(m < x.cols() ? Vector(power * x.col(m)) : Vector::Zero(ring_.nodes()));
    all.col(m) = law.slope();
  }
  return all;
}

void RingTangent::follow(const RingSegment& segment, const RingState& state) {
  const double h = segment.length;
  if (h == 0) return;
  const Index order = series_order(rate_ * h) + (ring_.others.empty() ? 0 : segment.position.cols());
  std::vector<Matrix> stiffness;
  for (std::size_t e = 0; e < ring_.others.size(); ++e) stiffness.push_back(slopes(e, segment, order));
  std::vector<std::vector<Matrix>> motions(stiffness.size());  // terms of those of further elements
  const Matrix sticking = sticking_rows(ring_, state.slip);
  const double k = ring_.contact_stiffness;
  Matrix sliders(sticking.rows(), slider_.cols());
  Index row = 0;
  for (Index i = 0; i < ring_.nodes(); ++i) {
    if (state.slip[i] == 0) sliders.row(row++) = slider_.row(i);
  }
  Matrix now = position_;
  Matrix next = h * velocity_;
  Matrix rate = next;  // h times the velocity
  position_ += next;
  for (Index m = 0; m + 2 <= order; ++m) {
    const auto up = static_cast<double>(m + 1);
    Matrix spring = sticking * now;
    if (m == 0) spring -= sliders;
    Matrix force = -(ring_.stiffness.asDiagonal() * now);
    force -= (up / h) * (ring_.damping.asDiagonal() * next);
    force.noalias() -= k * sticking.transpose() * spring;
    for (std::size_t e = 0; e < stiffness.size(); ++e) {
      const Matrix& motion = ring_.others[e].motion;
      motions[e].push_back(motion * now);
      for (Index j = 0; j <= m; ++j)
        force -= motion.transpose() *
                 (stiffness[e].col(m - j).asDiagonal() * motions[e][static_cast<std::size_t>(j)]);
    }
    now.swap(next);
    next = force * (h * h / (up * (up + 1)));
    position_ += next;
    rate += (up + 1) * next;
  }
  velocity_ = rate / h;
}

void RingTangent::change(Index contact, const RingState& state) {
  if (state.slip[contact] == 0) slider_.row(contact).noalias() = ring_.relative.row(contact) * position_;
}

Matrix RingTangent::at(const RingState& state) const {
  const Index coordinates = ring_.coordinates();
  Matrix all(2 * coordinates + ring_.nodes(), position_.cols());
  all << position_, velocity_, slider_;
  for (Index i = 0; i < ring_.nodes(); ++i) {
    if (state.slip[i] != 0) all.row(2 * coordinates + i) = ring_.relative.row(i) * position_;
  }
  return all;
}

Vector neutral_drift(const Ring& ring) {
  Vector drift = Vector::Zero(2 * ring.coordinates() + ring.nodes());
  if (!ring.drift) return drift;
  drift(*ring.drift) = 1;
  drift.tail(ring.nodes()) = ring.relative.col(*ring.drift);
  return drift.normalized();
}

RingState next_state(RingMotion& motion, const RingState& state, RingObserver* observer) {
  const Ring& ring = motion.ring();
  RingState next = state;
  motion.advance(next,
                 motion.period() * static_cast<double>(ring.wave_number) / static_cast<double>(ring.nodes()),
                 observer);
  next.time = state.time;
  next.position = ring.turn * next.position;
  next.velocity = ring.turn * next.velocity;
  next.slider = turned_back(next.slider);
  std::rotate(next.slip.begin(), next.slip.begin() + 1, next.slip.end());
  return next;
}

StateDerivative next_derivative(RingMotion& motion, const RingState& state) {
  const Ring& ring = motion.ring();
  const Index coordinates = ring.coordinates();
  RingTangent tangent(motion);
  StateDerivative result{next_state(motion, state, &tangent), {}};
  RingState unturned = result.next;
  std::rotate(unturned.slip.rbegin(), unturned.slip.rbegin() + 1, unturned.slip.rend());
  const Matrix flow = tangent.at(unturned);
  result.derivative.resize(flow.rows(), flow.cols());
  result.derivative.topRows(coordinates).noalias() = ring.turn * flow.topRows(coordinates);
  result.derivative.middleRows(coordinates, coordinates).noalias() =
      ring.turn * flow.middleRows(coordinates, coordinates);
  result.derivative.bottomRows(ring.nodes()) = turned_back(flow.bottomRows(ring.nodes()));
  for (Index i = 0; i < ring.nodes(); ++i) {
    if (state.slip[i] != 0) result.derivative.col(2 * coordinates + i).setZero();
  }
  return result;
}

double state_distance(const RingMotion& motion, const RingState& a, const RingState& b) {
  const Vector reference = stacked(b);
  return length_without_drift(motion, stacked(a) - reference) / length_without_drift(motion, reference);
}

SettledMotion march_until_settled(RingMotion& motion, RingState state, double tolerance, int rounds) {
  SettledMotion result{std::move(state), 0, 0, false};
  while (result.rounds < rounds && !result.settled) {
    RingState next = next_state(motion, result.state);
    result.error = step_error(motion, result.state, next);
    result.settled = result.error <= tolerance;
    result.state = std::move(next);
    ++result.rounds;
  }
  return result;
}

SettledMotion shoot(RingMotion& motion, RingState guess, double tolerance, int rounds) {
  SettledMotion result{std::move(guess), 0, 0, false};
  StateDerivative here = next_derivative(motion, result.state);
  result.error = step_error(motion, result.state, here.next);
  while (result.error > tolerance && result.rounds < rounds) {
    result.state = improved(motion, result.state, here);
    here = next_derivative(motion, result.state);
    result.error = step_error(motion, result.state, here.next);
    ++result.rounds;
  }
  result.settled = result.error <= tolerance;
  return result;
}

}  // namespace arcslip
