#pragma once

// The matrix G of turned_flow.hpp: the linear flow over the angle after which each node does what the one
// before it has done, with nodes and waves turned back.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include "arcslip/time/turned_flow.hpp"
#include "time/kernel.hpp"
#include "time/own_velocity.hpp"
#include "time/stick_schedule.hpp"

namespace arcslip {

template <class Scalar>
using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

/// What moves a contact of node k, of phase -pi k/M.
template <class Scalar>
Scalar motion(const TurnedFlow::Coordinate& coordinate, Complex wave) {
  if constexpr (std::is_same_v<Scalar, Complex>) {
    return wave;
  } else {
    if (coordinate.part == TurnedFlow::Coordinate::Part::whole) return wave.real();
    return std::numbers::sqrt2 *
           (coordinate.part == TurnedFlow::Coordinate::Part::real ? wave.real() : -wave.imag());
  }
}

inline double scale_of(const TurnedFlow::Coordinate& one, double eta) {
  return std::max(one.mode.frequency, eta);
}

/// Flow of (p, v, x), p' = scale v, and the matrix G.
template <class Scalar>
class TurnedMap {
 public:
  TurnedMap(const std::vector<TurnedFlow::Coordinate>& coordinates, Index nodes, const Vector& springs,
            double eta, std::span<const StickPattern> elements)
      : coordinates_(coordinates),
        nodes_(nodes),
        springs_(springs / static_cast<double>(nodes)),
        eta_(eta),
        elements_(elements),
        contacts_(elements.first(static_cast<std::size_t>(springs.size()))),
        others_(elements.subspan(static_cast<std::size_t>(springs.size()))),
        schedule_(contacts_, nodes) {
    const auto size = std::ssize(coordinates);
    relative_.resize(nodes * springs.size(), size);
    other_motion_.resize(nodes * std::ssize(others_), size);
    scale_.resize(size);
    for (Index column = 0; column < size; ++column) {
      const TurnedFlow::Coordinate& one = coordinates[static_cast<std::size_t>(column)];
      scale_(column) = scale_of(one, eta);
      for (Index node = 0; node < nodes; ++node) {
        const Complex lag = std::polar(1.0, -turned(one) * static_cast<double>(node));
        for (Index i = 0; i < springs.size(); ++i)
          relative_(node * springs.size() + i, column) = motion<Scalar>(one, lag * one.mode.shape(i));
        for (Index i = 0; i < std::ssize(others_); ++i) {
          other_motion_(node * std::ssize(others_) + i, column) =
              motion<Scalar>(one, lag * one.mode.shape(springs.size() + i));
        }
      }
    }
  }

  Dense<Scalar> turned_map() {
    const auto size = std::ssize(coordinates_);
    const std::vector<StickSchedule::Slot>* sticking = &schedule_.intervals().front().sticking;
    Dense<Scalar> state =
        Dense<Scalar>::Identity(2 * size + std::ssize(*sticking), 2 * size + std::ssize(*sticking));
    for (const StickSchedule::Interval& interval : schedule_.intervals()) {
      change(*sticking, interval.sticking, state);
      sticking = &interval.sticking;
      const Dense<Scalar> rates = generator(*sticking) * (interval.width / eta_);
      rate_ += rates.cwiseAbs().colwise().sum().maxCoeff();
      pass(interval, rates, state);
    }
    change(*sticking, schedule_.behind(), state);
    turn_back(state);
    return state;
  }

  /// Rigid motions that nothing resists: that no contact feels, with their velocities, and where all contacts
  /// slip those that all sliders follow. Further elements hold what they feel, unless they are at rest.
  Dense<Scalar> drifts() const {
    const auto size = std::ssize(coordinates_);
    const std::vector<StickSchedule::Slot>& sticking = schedule_.intervals().front().sticking;
    const bool all_slip =
        std::all_of(contacts_.begin(), contacts_.end(), [](const StickPattern& one) { return one.slips; });
    std::vector<Index> rigid;
    for (Index i = 0; i < size; ++i) {
      if (coordinates_[static_cast<std::size_t>(i)].mode.frequency == 0) rigid.push_back(i);
    }
    std::vector<Index> holding;
    for (Index row = 0; row < other_motion_.rows(); ++row) {
      if (others_[static_cast<std::size_t>(row % std::ssize(others_))].stiffness.bound() > 0)
        holding.push_back(row);
    }
    const Dense<Scalar> held = other_motion_(holding, rigid);
    Dense<Scalar> felt(relative_.rows() + held.rows(), std::ssize(rigid));
    felt << relative_(Eigen::all, rigid), held;
    const Dense<Scalar> common = others_.empty() ? Dense<Scalar>(std::ssize(rigid), 0) : kernel_of(felt);
    const Dense<Scalar> free = all_slip ? kernel_of(held) : common;
    Dense<Scalar> found = Dense<Scalar>::Zero(2 * size + std::ssize(sticking), free.cols() + common.cols());
    for (std::size_t i = 0; i < rigid.size(); ++i) {
      found.row(rigid[i]).head(free.cols()) = free.row(static_cast<Index>(i));
      found.row(size + rigid[i]).tail(common.cols()) = common.row(static_cast<Index>(i));
    }
    Index slider = 2 * size;
    for (const StickSchedule::Slot& slot : sticking) found.row(slider++) = row(slot) * found.topRows(size);
    return found;
  }

  /// The velocity of the response, of which harmonics that differ by 2 M are one wave, at the first phase.
  /// Sliders rest.
  Dense<Scalar> velocity() const {
    const auto size = std::ssize(coordinates_);
    Dense<Scalar> found =
        Dense<Scalar>::Zero(2 * size + std::ssize(schedule_.intervals().front().sticking), 1);
    const int highest = static_cast<int>(elements_.front().free_force.size()) - 1;
    const int turns = 2 * static_cast<int>(nodes_);
    for (Index i = 0; i < size; ++i) {
      const TurnedFlow::Coordinate& one = coordinates_[static_cast<std::size_t>(i)];
      if (one.part == TurnedFlow::Coordinate::Part::imaginary) continue;
      Complex p = 0;
      Complex v = 0;
      for (int h = one.order - turns * ((one.order + highest) / turns); h <= highest; h += turns) {
        const Complex part = own_velocity(one.mode, h, eta_, elements_) *
                             std::polar(1.0, h * schedule_.intervals().front().begin);
        p += part;
        v += Complex(0, h * eta_ / scale_(i)) * part;
      }
      if (one.part == TurnedFlow::Coordinate::Part::whole) {
        found(i) = 0.5 * p.real() * std::numbers::sqrt2;
        found(size + i) = 0.5 * v.real() * std::numbers::sqrt2;
      } else {
        found(i) = p.real();
        found(i + 1) = p.imag();
        found(size + i) = v.real();
        found(size + i + 1) = v.imag();
      }
    }
    return found;
  }

  /// Relative error that rounding may have left in an eigenvalue of modulus 1.
  double rounding() const { return 64 * std::numeric_limits<double>::epsilon() * (1 + rate_); }

 private:
  double turned(const TurnedFlow::Coordinate& one) const {
    return one.order * pi / static_cast<double>(nodes_);
  }

  auto row(const StickSchedule::Slot& slot) const {
    return relative_.row(slot.node * springs_.size() + static_cast<Index>(slot.contact));
  }

  /// Takes the state over an interval, in which `rates` are those of springs that do not vary: where others
  /// do, by Taylor series, of which a step's terms exceed their sum by so little that no digit is lost.
  void pass(const StickSchedule::Interval& interval, const Dense<Scalar>& rates, Dense<Scalar>& state) const {
    if (others_.empty()) {
      const auto size = 2 * std::ssize(coordinates_);
      const Dense<Scalar> flow = rates.exp();
      state.topRows(size) = (flow.topRows(size) * state).eval();
      return;
    }
    const std::vector<double> ends = law_changes(interval, others_, nodes_);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      const double part = (ends[i + 1] - ends[i]) / interval.width;
      pass(ends[i], ends[i + 1] - ends[i], rates * part, state);
    }
  }

  void pass(double begin, double angle, const Dense<Scalar>& rates, Dense<Scalar>& state) const {
    constexpr double longest = 4;  // step, of the fastest rate
    double fastest = rates.cwiseAbs().colwise().sum().maxCoeff();
    for (const StickPattern& other : others_) {
      fastest += other.stiffness.bound() * other_motion_.squaredNorm() / scale_.minCoeff() * angle /
                 (eta_ * static_cast<double>(nodes_));
    }
    const auto steps = std::max(Index{1}, static_cast<Index>(std::ceil(fastest / longest)));
    const double width = angle / static_cast<double>(steps);
    const Dense<Scalar> of_step = rates / static_cast<double>(steps);
    for (Index i = 0; i < steps; ++i) step(begin + static_cast<double>(i) * width, width, of_step, state);
  }

  /// The series of one step from a phase of node 0 on.
  void step(double phase, double width, const Dense<Scalar>& rates, Dense<Scalar>& state) const {
    constexpr double nothing = 1e-18;
    const auto size = std::ssize(coordinates_);
    const Dense<Scalar> push = (width / (eta_ * static_cast<double>(nodes_))) *
                               (scale_.cwiseInverse().asDiagonal() * other_motion_.adjoint());
    std::vector<Dense<Scalar>> motions;  // terms of those of the coordinates
    std::vector<Vector> stiffness;       // terms of the springs
    Dense<Scalar> term = state;
    double last = 1;
    for (Index m = 0;; ++m) {
      motions.push_back(other_motion_ * term.topRows(size));
      stiffness.push_back(stiffness_term(phase, width, m));
      Dense<Scalar> forces = stiffness.back().asDiagonal() * motions.front();
      for (std::size_t j = 1; j < motions.size(); ++j)
        forces += stiffness[motions.size() - 1 - j].asDiagonal() * motions[j];
      term = (rates * term).eval();
      term.middleRows(size, size).noalias() -= push * forces;
      term /= static_cast<double>(m + 1);
      state += term;
      const double part = term.norm() / state.norm();
      if (!(part + last > nothing)) return;
      last = part;
    }
  }

  /// The m-th term of the Taylor series of all springs' stiffness over a step.
  Vector stiffness_term(double phase, double width, Index m) const {
    const auto count = std::ssize(others_);
    Vector terms = Vector::Zero(nodes_ * count);
    for (Index node = 0; node < nodes_; ++node) {
      const double here = phase - pi * static_cast<double>(node) / static_cast<double>(nodes_);
      for (Index i = 0; i < count; ++i) {
        terms(node * count + i) = others_[static_cast<std::size_t>(i)].stiffness.term(here, width, m);
      }
    }
    return terms;
  }

  /// Of (p, v, x) while these slots stick, as do the contacts that never slip.
  Dense<Scalar> generator(const std::vector<StickSchedule::Slot>& sticking) const {
    const auto size = std::ssize(coordinates_);
    Dense<Scalar> rates =
        Dense<Scalar>::Zero(2 * size + std::ssize(sticking), 2 * size + std::ssize(sticking));
    for (Index i = 0; i < size; ++i) {
      const Oscillator& mode = coordinates_[static_cast<std::size_t>(i)].mode;
      rates(i, size + i) = scale_(i);
      rates(size + i, i) = -mode.frequency * mode.frequency / scale_(i);
      rates(size + i, size + i) = -mode.damping;
    }
    const auto spring = [&](const auto& moved, double stiffness, Index slider) {
      const Eigen::Matrix<Scalar, Eigen::Dynamic, 1> push =
          stiffness * scale_.cwiseInverse().cast<Scalar>().cwiseProduct(moved.adjoint());
      rates.block(size, 0, size, size).noalias() -= push * moved;
      if (slider >= 0) rates.col(slider).segment(size, size) += push;
    };
    for (Index i = 0; i < springs_.size(); ++i) {
      if (contacts_[static_cast<std::size_t>(i)].slips) continue;
      for (Index node = 0; node < nodes_; ++node)
        spring(relative_.row(node * springs_.size() + i), springs_(i), -1);
    }
    Index slider = 2 * size;
    for (const StickSchedule::Slot& slot : sticking)
      spring(row(slot), springs_(static_cast<Index>(slot.contact)), slider++);
    return rates;
  }

  /// Sliders of what begins to stick come, those of what ceases to stick go.
  void change(const std::vector<StickSchedule::Slot>& from, const std::vector<StickSchedule::Slot>& to,
              Dense<Scalar>& state) const {
    const auto size = std::ssize(coordinates_);
    Dense<Scalar> next(2 * size + std::ssize(to), state.cols());
    next.topRows(2 * size) = state.topRows(2 * size);
    for (Index i = 0; i < std::ssize(to); ++i) {
      const StickSchedule::Slot& slot = to[static_cast<std::size_t>(i)];
      const auto old = std::find(from.begin(), from.end(), slot);
      if (old == from.end()) {
        next.row(2 * size + i) = row(slot) * state.topRows(size);
      } else {
        next.row(2 * size + i) = state.row(2 * size + (old - from.begin()));
      }
    }
    state.swap(next);
  }

  /// Each node takes the place of the one behind it.
  void turn_back(Dense<Scalar>& state) const {
    const auto size = std::ssize(coordinates_);
    for (Index i = 0; i < size; ++i) {
      const TurnedFlow::Coordinate& one = coordinates_[static_cast<std::size_t>(i)];
      const Complex factor = std::polar(1.0, -turned(one));
      for (const Index place : {i, size + i}) {
        if constexpr (std::is_same_v<Scalar, Complex>) {
          state.row(place) *= factor;
        } else if (one.part == TurnedFlow::Coordinate::Part::whole) {
          state.row(place) *= factor.real();
        } else if (one.part == TurnedFlow::Coordinate::Part::real) {
          const Eigen::RowVectorXd real = state.row(place);
          const Eigen::RowVectorXd imaginary = state.row(place + 1);
          state.row(place) = factor.real() * real - factor.imag() * imaginary;
          state.row(place + 1) = factor.real() * imaginary + factor.imag() * real;
        }
      }
    }
    if (coordinates_.empty() || coordinates_.front().order % 2 == 0) return;
    for (std::size_t i = 0; i < schedule_.behind().size(); ++i) {
      if (schedule_.behind()[i].node == 0) state.row(2 * size + static_cast<Index>(i)) *= -1;
    }
  }

  const std::vector<TurnedFlow::Coordinate>& coordinates_;
  Index nodes_;
  Vector springs_;
  double eta_;
  std::span<const StickPattern> elements_;
  std::span<const StickPattern> contacts_;
  std::span<const StickPattern> others_;
  StickSchedule schedule_;
  Dense<Scalar> relative_;      // node by node, its contacts
  Dense<Scalar> other_motion_;  // node by node, its further coordinates
  Vector scale_;
  double rate_ = 0;
};

}  // namespace arcslip
