#pragma once

// The matrix G of turned_flow.hpp: the linear flow over the angle after which each node does what the one
// before it has done, with nodes and waves turned back.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "arcslip/dense.hpp"
#include "arcslip/time/turned_flow.hpp"
#include "time/law_schedule.hpp"
#include "time/own_velocity.hpp"
#include "time/turned_series.hpp"

namespace arcslip {

/// What moves a coordinate of a node by which the wave's phase has been turned.
template <class Scalar>
Scalar motion_of(const TurnedFlow::Coordinate& coordinate, Complex wave) {
  using Part = TurnedFlow::Coordinate::Part;
  if constexpr (std::is_same_v<Scalar, Complex>) {
    return wave;
  } else {
    if (coordinate.part == Part::whole) return wave.real();
    return std::numbers::sqrt2 * (coordinate.part == Part::real ? wave.real() : -wave.imag());
  }
}

/// Of velocities in the state.
inline double scale_of(const TurnedFlow::Coordinate& one, double eta) {
  return std::max(one.mode.frequency, eta);
}

/// Flow of (p, v, m), p' = scale v, and the matrix G.
template <class Scalar>
class TurnedMap {
 public:
  using Part = TurnedFlow::Coordinate::Part;
  using Slot = LawSchedule::Slot;
  using Interval = LawSchedule::Interval;
  using Row = Eigen::Matrix<Scalar, 1, Eigen::Dynamic>;

  /// `laws`: of each element, over `turn`; the elements act in the rows of the modes' shapes one after the
  /// other.
  TurnedMap(const std::vector<TurnedFlow::Coordinate>& coordinates, Index nodes, double turn, double eta,
            std::span<const DisturbedLaw> laws)
      : coordinates_(coordinates),
        nodes_(nodes),
        turn_(turn),
        eta_(eta),
        laws_(laws),
        schedule_(laws, nodes, turn) {
    for (const DisturbedLaw& law : laws) {
      first_.push_back(rows_);
      rows_ += law.coordinates;
    }
    motion_.resize(nodes * rows_, size());
    scale_.resize(size());
    for (Index column = 0; column < size(); ++column) {
      const TurnedFlow::Coordinate& one = coordinates[static_cast<std::size_t>(column)];
      scale_(column) = scale_of(one, eta);
      for (Index node = 0; node < nodes; ++node) {
        const Complex lag = std::polar(1.0, -turned(one) * static_cast<double>(node));
        for (Index i = 0; i < rows_; ++i)
          motion_(node * rows_ + i, column) = motion_of<Scalar>(one, lag * one.mode.shape(i));
      }
    }
  }

  Dense<Scalar> turned_map() {
    const std::vector<Slot>* slots = &schedule_.intervals().front().slots;
    Dense<Scalar> state =
        Dense<Scalar>::Identity(2 * size() + std::ssize(*slots), 2 * size() + std::ssize(*slots));
    for (const Interval& interval : schedule_.intervals()) {
      if (&interval != &schedule_.intervals().front()) change(*slots, interval.slots, state);
      slots = &interval.slots;
      pass(interval, state);
    }
    change(*slots, schedule_.behind(), state);
    turn_back(state);
    return state;
  }

  /// Rigid motions that nothing resists: those that no element feels, with their velocities, `common`, and
  /// those that all memories follow.
  Dense<Scalar> drifts(bool common_count) const {
    const std::vector<Slot>& slots = schedule_.intervals().front().slots;
    std::vector<Index> rigid;
    for (Index i = 0; i < size(); ++i) {
      if (coordinates_[static_cast<std::size_t>(i)].mode.frequency == 0) rigid.push_back(i);
    }
    if (rigid.empty()) return Dense<Scalar>(2 * size() + std::ssize(slots), 0);
    const Dense<Scalar> moved = motion_(Eigen::all, rigid);
    const auto [felt, resisted] = resistance(moved);
    const auto count = std::ssize(rigid);
    const Dense<Scalar> common = common_count ? kernel_of(felt) : Dense<Scalar>(count, 0);
    const Dense<Scalar> free = kernel_of(resisted);
    Dense<Scalar> found = Dense<Scalar>::Zero(2 * size() + std::ssize(slots), free.cols() + common.cols());
    for (Index i = 0; i < count; ++i) {
      found.row(rigid[static_cast<std::size_t>(i)]).head(free.cols()) = free.row(i);
      found.row(size() + rigid[static_cast<std::size_t>(i)]).tail(common.cols()) = common.row(i);
    }
    Index place = 2 * size();
    for (const Slot& slot : slots) {
      const double phase = schedule_.intervals().front().begin +
                           schedule_.offset(schedule_.intervals().front(), slot.element, slot.node);
      const Dense<Scalar> all = followed(slot.element, rows_of(moved, slot.element, slot.node), phase);
      found.row(place++).head(free.cols()) = all.row(static_cast<Index>(slot.memory)) * free;
    }
    return found;
  }

  /// The velocity of the response, of which harmonics that differ by 2 M are one wave, at the first phase.
  /// Memories rest.
  Dense<Scalar> velocity(std::span<const StickPattern> elements) const {
    Dense<Scalar> found =
        Dense<Scalar>::Zero(2 * size() + std::ssize(schedule_.intervals().front().slots), 1);
    const int half = turn_ < two_pi ? 1 : 2;  // orders count halves
    const int highest = static_cast<int>(elements.front().free_force.front().size()) - 1;
    const int turns = 2 / half * static_cast<int>(nodes_);
    for (Index i = 0; i < size(); ++i) {
      const TurnedFlow::Coordinate& one = coordinates_[static_cast<std::size_t>(i)];
      if (one.part == Part::imaginary) continue;
      Complex p = 0;
      Complex v = 0;
      const int order = one.order / half;
      for (int h = order - turns * ((order + highest) / turns); h <= highest; h += turns) {
        const Complex part = own_velocity(one.mode, h, eta_, elements) *
                             std::polar(1.0, h * schedule_.intervals().front().begin);
        p += part;
        v += Complex(0, h * eta_ / scale_(i)) * part;
      }
      if (one.part == Part::whole) {
        found(i) = 0.5 * p.real() * std::numbers::sqrt2;
        found(size() + i) = 0.5 * v.real() * std::numbers::sqrt2;
      } else {
        found(i) = p.real();
        found(i + 1) = p.imag();
        found(size() + i) = v.real();
        found(size() + i + 1) = v.imag();
      }
    }
    return found;
  }

  /// Relative error that rounding may have left in an eigenvalue of modulus 1.
  double rounding() const { return 64 * std::numeric_limits<double>::epsilon() * (1 + rate_); }

 private:
  Index size() const { return std::ssize(coordinates_); }
  double turned(const TurnedFlow::Coordinate& one) const {
    return one.order * pi / static_cast<double>(nodes_);
  }
  auto rows_of(const Dense<Scalar>& all, std::size_t element, Index node) const {
    return all.middleRows(node * rows_ + first_[element], laws_[element].coordinates);
  }

  /// What the memories of an element are at its phase after motions that stay, row by row.
  Dense<Scalar> followed(std::size_t element, const Dense<Scalar>& moved, double phase) const {
    const std::vector<DisturbedLaw::Memory>& all = laws_[element].memories;
    Dense<Scalar> kept = Dense<Scalar>::Zero(std::ssize(all), moved.cols());
    // Each is told by earlier ones, but for where the turn begins.
    for (int round = 0; round < 2; ++round) {
      for (std::size_t i = 0; i < all.size(); ++i) {
        const Vector set = all[i].rest ? all[i].rest(phase) : all[i].set;
        Row row = set.transpose().template cast<Scalar>() * moved;
        if (all[i].rest) {
          kept.row(static_cast<Index>(i)) = row;
          continue;
        }
        for (const auto& [of, part] : all[i].of) row += part * kept.row(of);
        kept.row(static_cast<Index>(i)) = row;
      }
    }
    return kept;
  }

  /// The motions that elements feel, and the forces against them once memories have followed.
  std::pair<Dense<Scalar>, Dense<Scalar>> resistance(const Dense<Scalar>& moved) const {
    std::vector<Row> felt;
    std::vector<Row> resisted;
    for (std::size_t e = 0; e < laws_.size(); ++e) {
      for (Index node = 0; node < nodes_; ++node) {
        const Dense<Scalar> own = rows_of(moved, e, node);
        const Dense<Scalar> kept = followed(e, own, 0);
        if (laws_[e].viscous != 0) felt.push_back(own.row(0));
        for (const DisturbedLaw::Piece& piece : laws_[e].pieces) {
          Dense<Scalar> forces = piece.stiffness.template cast<Scalar>() * own;
          for (Index i = 0; i < own.rows(); ++i) {
            if (!piece.stiffness.isZero(0) || piece.varying) felt.push_back(own.row(i));
          }
          for (const auto& [memory, force] : piece.held)
            forces += force.template cast<Scalar>() * kept.row(memory);
          for (Index i = 0; i < forces.rows(); ++i) resisted.push_back(forces.row(i));
          if (!piece.varying || piece.varying->pace > 0) continue;  // memory that moves on follows
          Row way = own.row(0);
          if (piece.from >= 0) way -= kept.row(piece.from);
          resisted.push_back(piece.varying->bound * way);
        }
      }
    }
    const auto stacked = [&](const std::vector<Row>& rows) {
      Dense<Scalar> all(std::ssize(rows), moved.cols());
      for (std::size_t i = 0; i < rows.size(); ++i) all.row(static_cast<Index>(i)) = rows[i];
      return all;
    };
    return {stacked(felt), stacked(resisted)};
  }

  /// Of (p, v, m) in an interval, but for what varies, which is told apart.
  Dense<Scalar> generator(const Interval& interval, TurnedSeries<Scalar>& varying) const {
    const Index n = size();
    const Index all = 2 * n + std::ssize(interval.slots);
    const auto scale = scale_.template cast<Scalar>().asDiagonal();
    Dense<Scalar> rates = Dense<Scalar>::Zero(all, all);
    for (Index i = 0; i < n; ++i) {
      const Oscillator& mode = coordinates_[static_cast<std::size_t>(i)].mode;
      rates(i, n + i) = scale_(i);
      rates(n + i, n + i) = -mode.damping;
      add_stiffness(i, -mode.stiffness() / scale_(i), rates);
    }
    for (std::size_t e = 0; e < laws_.size(); ++e) {
      for (Index node = 0; node < nodes_; ++node) {
        const DisturbedLaw::Piece& piece = schedule_.piece(interval, e, node);
        const auto moved = rows_of(motion_, e, node);
        const Dense<Scalar> push = pushed(moved);
        if (laws_[e].viscous != 0)
          rates.block(n, n, n, n).noalias() -= laws_[e].viscous * push * moved * scale;
        if (!piece.stiffness.isZero(0))
          rates.block(n, 0, n, n).noalias() -= push * (piece.stiffness.template cast<Scalar>() * moved);
        for (const auto& [memory, force] : piece.held) {
          rates.col(place(interval, e, static_cast<std::size_t>(memory), node)).segment(n, n) -=
              push * force.template cast<Scalar>();
        }
        if (!piece.varying) continue;
        const Index from =
            piece.from < 0 ? -1 : place(interval, e, static_cast<std::size_t>(piece.from), node);
        varying.add(*piece.varying, node * rows_ + first_[e], laws_[e].coordinates,
                    schedule_.offset(interval, e, node), from);
      }
    }
    return rates;
  }

  /// What the motion of a coordinate does to v of its wave, of two conjugate ones both parts.
  void add_stiffness(Index i, const Complex& by_motion, Dense<Scalar>& rates) const {
    const Part part = coordinates_[static_cast<std::size_t>(i)].part;
    if constexpr (std::is_same_v<Scalar, Complex>) {
      rates(size() + i, i) += by_motion;
    } else {
      rates(size() + i, i) += by_motion.real();
      if (part == Part::real) rates(size() + i, i + 1) -= by_motion.imag();
      if (part == Part::imaginary) rates(size() + i, i - 1) += by_motion.imag();
    }
  }

  /// What unit forces do to v.
  template <class Moved>
  Dense<Scalar> pushed(const Moved& moved) const {
    return (scale_ * static_cast<double>(nodes_)).cwiseInverse().template cast<Scalar>().asDiagonal() *
           moved.adjoint();
  }

  Index place(const Interval& interval, std::size_t element, std::size_t memory, Index node) const {
    const Slot wanted{element, memory, node};
    const auto found = std::find_if(interval.slots.begin(), interval.slots.end(),
                                    [&](const Slot& one) { return same(one, wanted); });
    return 2 * size() + (found - interval.slots.begin());
  }

  /// Takes the state over an interval.
  void pass(const Interval& interval, Dense<Scalar>& state) {
    TurnedSeries<Scalar> varying(motion_);
    const Dense<Scalar> rates = generator(interval, varying) * (interval.width / eta_);
    const double norm = rates.cwiseAbs().colwise().sum().maxCoeff();
    rate_ += norm;
    if (varying.empty()) {
      const Dense<Scalar> flow = exponential(rates);
      state.topRows(2 * size()) = (flow.topRows(2 * size()) * state).eval();
      return;
    }
    const double flexibility = 1 / (scale_.minCoeff() * eta_ * static_cast<double>(nodes_));
    const auto steps = static_cast<double>(varying.steps(interval.width, norm, flexibility));
    const double width = interval.width / steps;
    const Dense<Scalar> of_step = rates / steps;
    const auto push = [&](const Dense<Scalar>& moved) { return Dense<Scalar>(pushed(moved) / eta_); };
    for (double i = 0; i < steps; ++i) varying.step(interval.begin + i * width, width, of_step, push, state);
  }

  /// Memories that are set come, those that are kept no longer go.
  void change(const std::vector<Slot>& from, const std::vector<Slot>& to, Dense<Scalar>& state) const {
    const Index n = size();
    const auto old = [&](const Slot& wanted) {
      const auto found =
          std::find_if(from.begin(), from.end(), [&](const Slot& one) { return same(one, wanted); });
      return found == from.end() ? Index{-1} : 2 * n + (found - from.begin());
    };
    Dense<Scalar> next(2 * n + std::ssize(to), state.cols());
    next.topRows(2 * n) = state.topRows(2 * n);
    for (Index i = 0; i < std::ssize(to); ++i) {
      const Slot& slot = to[static_cast<std::size_t>(i)];
      if (!slot.is_set) {
        next.row(2 * n + i) = state.row(old(slot));
        continue;
      }
      const DisturbedLaw::Memory& memory = laws_[slot.element].memories[slot.memory];
      const Row set =
          memory.set.transpose().template cast<Scalar>() * rows_of(motion_, slot.element, slot.node);
      next.row(2 * n + i) = set * state.topRows(n);
      for (const auto& [of, part] : memory.of)
        next.row(2 * n + i) += part * state.row(old({slot.element, static_cast<std::size_t>(of), slot.node}));
    }
    state.swap(next);
  }

  /// Each node takes the place of the one behind it.
  void turn_back(Dense<Scalar>& state) const {
    for (Index i = 0; i < size(); ++i) {
      const TurnedFlow::Coordinate& one = coordinates_[static_cast<std::size_t>(i)];
      const Complex factor = std::polar(1.0, -turned(one));
      for (const Index place : {i, size() + i}) {
        if constexpr (std::is_same_v<Scalar, Complex>) {
          state.row(place) *= factor;
        } else if (one.part == Part::whole) {
          state.row(place) *= factor.real();
        } else if (one.part == Part::real) {
          const Eigen::RowVectorXd real = state.row(place);
          const Eigen::RowVectorXd imaginary = state.row(place + 1);
          state.row(place) = factor.real() * real - factor.imag() * imaginary;
          state.row(place + 1) = factor.real() * imaginary + factor.imag() * real;
        }
      }
    }
    if (coordinates_.empty() || coordinates_.front().order % 2 == 0) return;
    for (std::size_t i = 0; i < schedule_.behind().size(); ++i) {
      if (schedule_.behind()[i].node == 0) state.row(2 * size() + static_cast<Index>(i)) *= -1;
    }
  }

  const std::vector<TurnedFlow::Coordinate>& coordinates_;
  Index nodes_;
  double turn_;
  double eta_;
  std::span<const DisturbedLaw> laws_;
  LawSchedule schedule_;
  std::vector<Index> first_;  // coordinate of each element
  Index rows_ = 0;            // of a node
  Dense<Scalar> motion_;      // of the coordinates, node by node
  Vector scale_;
  double rate_ = 0;
};

}  // namespace arcslip
