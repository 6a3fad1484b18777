#include "arcslip/time/ring_response.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>

#include "arcslip/dense.hpp"

namespace arcslip {
namespace {

/// Position, velocity and memory in one column.
Vector stacked(const RingState& state) {
  Vector all(2 * state.position.size() + state.memory.size());
  all << state.position, state.velocity, state.memory;
  return all;
}

RingState moved_by(const RingState& state, const Vector& step) {
  const Index coordinates = state.position.size();
  RingState sum = state;
  sum.position += step.head(coordinates);
  sum.velocity += step.segment(coordinates, coordinates);
  sum.memory += step.tail(state.memory.size());
  return sum;
}

/// A difference of states in units of displacement.
Vector scaled(const RingMotion& motion, const Vector& all) {
  const Index coordinates = motion.ring().coordinates();
  Vector same = all;
  same.segment(coordinates, coordinates) /= motion.frequency();
  return same;
}

/// Its length once it has been freed of drifts.
double length_without_drift(const RingMotion& motion, const Vector& all) {
  const Matrix drifts = neutral_drifts(motion);
  const Vector same = scaled(motion, all);
  return (same - drifts * (drifts.transpose() * same)).norm();
}

/// next - state. Of elements whose phase tells what their memory means, that of different ones is no
/// difference.
Vector difference(const RingMotion& motion, const RingState& state, const RingState& next) {
  Vector all = stacked(next) - stacked(state);
  for (Index e = 0; e < motion.elements(); ++e) {
    const RingLaw& law = *motion.family(e).law;
    const auto k = static_cast<std::size_t>(e);
    if (law.forgets_place() || state.phase[k] == next.phase[k]) continue;
    for (Index j = 0; j < law.memories(); ++j) all(2 * state.position.size() + motion.memory_place(e, j)) = 0;
  }
  return all;
}

/// How far G(s) = next is from s: a drift that goes on is no settled motion.
double step_length(const RingMotion& motion, const RingState& state, const RingState& next) {
  return scaled(motion, difference(motion, state, next)).norm();
}

double step_error(const RingMotion& motion, const RingState& state, const RingState& next) {
  return step_length(motion, state, next) / length_without_drift(motion, stacked(next));
}

constexpr double progress = 0.9;  // of a gap is left, at most, after a step that helps

/// The numbers in the state's memory of one kind of elements.
struct Block {
  Index first;
  Index count;
};
Block memory_block(const RingMotion& motion, std::size_t family) {
  const RingMotion::Family& one = motion.families()[family];
  return {one.memory, one.law->memories() * motion.ring().nodes()};
}

/// The solver of (I - dG/ds) delta = residual without drifts, along which the matrix is singular. Least
/// squares also hold where contacts so soft that they hardly stop a drift let it look settled but for its own
/// progress.
class NewtonStep {
 public:
  NewtonStep(const RingMotion& motion, StateDerivative here)
      : motion_(motion), moved_(std::move(here.moved)) {
    const Index size = here.derivative.rows();
    const Index coordinates = motion.ring().coordinates();
    const Matrix drifts = neutral_drifts(motion, false, moved_);
    Matrix equations(size + drifts.cols(), size);
    equations << Matrix::Identity(size, size) - here.derivative, drifts.transpose();
    for (std::size_t f = 0; f < moved_.size(); ++f) {
      if (moved_[f]) continue;
      const auto [first, count] = memory_block(motion, f);
      equations.middleRows(2 * coordinates + first, count).setZero();
      equations.middleCols(2 * coordinates + first, count).setZero();
      equations.block(2 * coordinates + first, 2 * coordinates + first, count, count).setIdentity();
    }
    equations.middleRows(coordinates, coordinates) /= motion.frequency();
    equations.middleCols(coordinates, coordinates) *= motion.frequency();
    constexpr double held = 1e-10;  // what elements hold only at times
    const bool may_drift = std::any_of(motion.families().begin(), motion.families().end(),
                                       [](const auto& one) { return !one.law->forgets_place(); });
    rows_ = equations.rows();
    solve_ = least_squares_of(equations, may_drift ? std::optional(held) : std::nullopt);
  }

  /// The state that `next` = G(state) makes of it: phases are those of the latter.
  RingState aligned(const RingState& state, const RingState& next) const {
    RingState base = state;
    for (Index e = 0; e < motion_.elements(); ++e) {
      const RingLaw& law = *motion_.family(e).law;
      const auto k = static_cast<std::size_t>(e);
      if (state.phase[k] == next.phase[k]) continue;
      base.phase[k] = next.phase[k];
      if (law.forgets_place()) continue;
      for (Index j = 0; j < law.memories(); ++j)
        base.memory(motion_.memory_place(e, j)) = next.memory(motion_.memory_place(e, j));
    }
    const Index nodes = motion_.ring().nodes();
    for (std::size_t f = 0; f < moved_.size(); ++f) {
      if (moved_[f]) continue;
      const auto [first, count] = memory_block(motion_, f);
      for (Index place = first; place < first + count; place += nodes)
        base.memory.segment(place, nodes).setConstant(base.memory.segment(place, nodes).mean());
    }
    return base;
  }

  Vector step(const RingState& base, const RingState& next) const {
    const Index coordinates = motion_.ring().coordinates();
    Vector residual = difference(motion_, base, next);
    for (std::size_t f = 0; f < moved_.size(); ++f) {
      const auto [first, count] = memory_block(motion_, f);
      if (!moved_[f]) residual.segment(2 * coordinates + first, count).setZero();
    }
    const Vector right = scaled(motion_, residual);
    const Index more = rows_ - right.size();
    Vector all(right.size() + more);
    all << right, Vector::Zero(more);
    Vector step = solve_(all);
    step.segment(coordinates, coordinates) *= motion_.frequency();
    return step;
  }

 private:
  const RingMotion& motion_;
  std::vector<bool> moved_;
  Index rows_ = 0;
  std::function<Vector(const Vector&)> solve_;
};

/// A state with G of it.
struct Round {
  RingState state;
  RingState next;
  double gap;  ///< between the two
};

Round round_of(RingMotion& motion, RingState state) {
  RingState next = next_state(motion, state);
  const double gap = step_length(motion, state, next);
  return {std::move(state), std::move(next), gap};
}

/// One that a step has led to, maybe to a state that no motion has: infinitely far from closing.
Round trial_of(RingMotion& motion, RingState state) {
  try {
    return round_of(motion, state);
  } catch (const std::runtime_error&) {
    return {state, state, std::numeric_limits<double>::infinity()};
  }
}

/// What a part of the step leads to (`trial`: all of it) after which the next step, by the same derivative,
/// is the shorter one: where the ring is hardly damped, G(s) - s is small far from s too, and grows on the
/// way to where it is 0. Near there it must fall, as derivatives on either side of an event differ. Where
/// events that short steps move leave no such part, the ring is marched for the n periods in which every node
/// takes every place.
Round nearer(RingMotion& motion, const NewtonStep& newton, const Round& here, const RingState& base,
             const Vector& step, Round trial) {
  constexpr double shortest = 1.0 / 128;
  constexpr double short_step = 1e-3;
  const double length = scaled(motion, step).norm();
  const bool is_near = length < short_step * length_without_drift(motion, stacked(here.next));
  const auto is_better = [&](double part) {
    if (is_near || !std::isfinite(trial.gap)) return trial.gap < progress * here.gap;
    const Vector next = newton.step(newton.aligned(trial.state, trial.next), trial.next);
    return scaled(motion, next).norm() < (1 - part / 4) * length;
  };
  for (double part = 1; part > shortest; part /= 2) {
    if (is_better(part)) return trial;
    trial = trial_of(motion, moved_by(base, part / 2 * step));
  }
  RingState marched = here.next;
  for (Index i = 1; i < motion.ring().nodes(); ++i) marched = next_state(motion, marched);
  return round_of(motion, std::move(marched));
}

/// Each node does what the next one did, of n < 0 the one before.
void turn(const Ring& ring, RingState& state) {
  state.position = ring.turned(state.position);
  state.velocity = ring.turned(state.velocity);
  state.memory = ring.moved_back(state.memory);
  const Index new_first = ring.wave_number < 0 ? ring.nodes() - 1 : 1;
  for (auto first = state.phase.begin(); first != state.phase.end(); first += ring.nodes())
    std::rotate(first, first + new_first, first + ring.nodes());
}

}  // namespace

RingState next_state(RingMotion& motion, const RingState& state, RingObserver* observer) {
  const Ring& ring = motion.ring();
  RingState next = state;
  motion.advance(next, motion.period() * ring.periods_of_turn(), observer);
  next.time = state.time;
  if (ring.wave_number != 0) turn(ring, next);
  return next;
}

StateDerivative next_derivative(RingMotion& motion, const RingState& state) {
  const Ring& ring = motion.ring();
  const Index coordinates = ring.coordinates();
  RingTangent tangent(motion);
  StateDerivative result{state, {}, {}};
  motion.advance(result.next, motion.period() * ring.periods_of_turn(), &tangent);
  const Matrix flow = tangent.at(result.next);
  result.moved = tangent.moved();
  result.next.time = state.time;
  if (ring.wave_number == 0) {
    result.derivative = flow;
    return result;
  }
  turn(ring, result.next);
  result.derivative.resize(flow.rows(), flow.cols());
  result.derivative.topRows(coordinates) = ring.turned(flow.topRows(coordinates));
  result.derivative.middleRows(coordinates, coordinates) =
      ring.turned(flow.middleRows(coordinates, coordinates));
  result.derivative.bottomRows(motion.memories()) = ring.moved_back(flow.bottomRows(motion.memories()));
  return result;
}

Matrix neutral_drifts(const RingMotion& motion, bool any_wave, const std::vector<bool>& moved) {
  const Ring& ring = motion.ring();
  const Index nodes = ring.nodes();
  const Index coordinates = ring.coordinates();
  std::vector<Index> holding;
  const auto hold = [&](Index first) {
    for (Index i = 0; i < nodes; ++i) holding.push_back(first + i);
  };
  for (std::size_t f = 0; f < motion.families().size(); ++f) {
    const RingMotion::Family& one = motion.families()[f];
    for (const Index first : {one.sliding, one.across}) {
      if (first >= 0 && (!one.law->forgets_place() || (!moved.empty() && !moved[f]))) hold(first);
    }
    if (one.closing >= 0 && !one.law->forgets_closing()) hold(one.closing);
  }
  Matrix drifts(2 * coordinates + motion.memories(), 0);
  for (Index wave = 0; 2 * wave <= (any_wave ? nodes : 0); ++wave) {
    std::vector<Index> rigid;
    for (Index c = 0; c < coordinates; ++c) {
      if (ring.stiffness(c) == 0 && ring.wave[static_cast<std::size_t>(c)] == wave) rigid.push_back(c);
    }
    if (rigid.empty()) continue;
    const Matrix free = kernel_of(Matrix(ring.motion(holding, rigid)));
    for (const auto& column : free.colwise()) {
      Vector drift = Vector::Zero(drifts.rows());
      for (Index k = 0; k < column.size(); ++k) drift(rigid[static_cast<std::size_t>(k)]) = column(k);
      for (const RingMotion::Family& one : motion.families()) {
        if (!one.law->forgets_place()) continue;
        for (Index j = 0; j < one.law->memories(); ++j) {
          drift.segment(2 * coordinates + one.memory + j * nodes, nodes) =
              ring.motion.middleRows(RingMotion::row_of(one, j), nodes) * drift.head(coordinates);
        }
      }
      drifts.conservativeResize(Eigen::NoChange, drifts.cols() + 1);
      drifts.rightCols(1) = drift;
    }
  }
  if (drifts.cols() == 0) return drifts;
  return orthonormal(drifts);
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
  constexpr double well = 0.3;  // of the gap is left by a step good enough: derivatives cost tens of them
  constexpr double rounding = 1e-10;  // below which no step helps that does not do so at once
  Round here = round_of(motion, std::move(guess));
  const auto error = [&] { return step_error(motion, here.state, here.next); };
  std::optional<NewtonStep> newton;
  SettledMotion result{{}, error(), 0, false};
  bool is_last = false;  // a step more, as the one before was not of the last derivative
  while ((result.error > tolerance || is_last) && result.rounds < rounds) {
    const bool is_new = !newton;
    if (is_new) newton.emplace(motion, next_derivative(motion, here.state));
    const RingState base = newton->aligned(here.state, here.next);
    const Vector step = newton->step(base, here.next);
    Round trial = trial_of(motion, moved_by(base, step));
    const bool is_good = trial.gap < well * here.gap;
    if (is_good || trial.gap < progress * here.gap) {
      here = std::move(trial);
    } else if (is_new && !is_last) {
      if (result.error < rounding) break;
      here = nearer(motion, *newton, here, base, step, std::move(trial));
    }
    if (!is_good && !is_last) newton.reset();
    result.error = error();
    is_last = newton && !is_new && !is_last && result.error <= tolerance;
    ++result.rounds;
  }
  result.state = std::move(here.state);
  result.settled = result.error <= tolerance;
  return result;
}

}  // namespace arcslip
