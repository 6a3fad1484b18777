#pragma once

// The linear flow of turned_map.hpp where laws vary with theta, as Taylor series.

#include <algorithm>
#include <vector>

#include "arcslip/elements/disturbed_law.hpp"

namespace arcslip {

template <class Scalar>
using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

/// Of (p, v, m), with the n of p.
template <class Scalar>
class TurnedSeries {
 public:
  /// `motion`: rows of the motions of all coordinates, by p.
  explicit TurnedSeries(const Dense<Scalar>& motion) : motion_(motion) {}

  /// A law that varies, of the motion of `count` rows from `row` on and of the memory that is at `from` in
  /// the state, or -1; its phase is that of node 0 and `phase`.
  void add(const VaryingLaw& law, Index row, Index count, double phase, Index from) {
    all_.push_back({&law, row, count, phase, from, rows_, memories_});
    rows_ += count;
    if (from >= 0) ++memories_;
  }

  bool empty() const { return all_.empty(); }

  /// Into how many steps an angle has to be cut, lest terms exceed their sum by so much that digits are lost;
  /// `constant`: what constant rates come to in it, `flexibility`: of a unit force at a unit motion.
  Index steps(double width, double constant, double flexibility) const {
    constexpr double longest = 4;
    double fastest = constant;
    double turns = 0;
    for (const Varying& one : all_) {
      const double size = 1 + motion_.middleRows(one.row, one.count).squaredNorm();
      fastest += (one.law->bound * size * flexibility + one.law->pace) * width;
      turns = std::max(turns, one.law->rate * width);
    }
    return std::max(Index{1}, static_cast<Index>(std::ceil(std::max(fastest, turns) / longest)));
  }

  /// One of them, from a phase of node 0 on: `rates` are the constant ones, over the step, `pushed` is what
  /// forces against rows of motions do to v in a unit of theta.
  template <class Pushed>
  void step(double phase, double width, const Dense<Scalar>& rates, const Pushed& pushed,
            Dense<Scalar>& state) const {
    constexpr double nothing = 1e-18;
    const Index n = motion_.cols();
    Dense<Scalar> moved(rows_, n);
    for (const Varying& one : all_)
      moved.middleRows(one.first, one.count) = motion_.middleRows(one.row, one.count);
    const std::vector<Coupling> couplings = couplings_of(phase, width);
    const Dense<Scalar> push = width * pushed(moved);
    std::vector<Dense<Scalar>> ways;  // terms of motions, then of memories, each in a column
    const Index slots = state.rows() - 2 * n;
    const Eigen::Matrix<Scalar, Eigen::Dynamic, 1> turns = rates.block(0, n, n, n).diagonal();
    Dense<Scalar> forces;
    Dense<Scalar> next;
    Dense<Scalar> term = state;
    double last = 1;
    for (Index m = 0; m < most_terms; ++m) {
      Dense<Scalar>& way = ways.emplace_back(term.cols(), rows_ + memories_);
      way.leftCols(rows_).noalias() = term.topRows(n).transpose() * moved.transpose();
      for (const Varying& one : all_) {
        if (one.from >= 0) way.col(rows_ + one.memory) = term.row(one.from).transpose();
      }
      next.setZero(term.rows(), term.cols());
      forces.setZero(term.cols(), rows_);
      for (const Coupling& one : couplings) {
        for (Index j = std::max(Index{0}, m + 1 - one.terms.size()); j <= m; ++j) {
          const auto by = ways[static_cast<std::size_t>(j)].col(one.way);
          const double part = one.terms(m - j);
          if (part == 0) continue;
          if (one.force >= 0) {
            forces.col(one.force) += part * by;
          } else {
            next.row(one.memory) += part * by.transpose();
          }
        }
      }
      next.topRows(n) = turns.asDiagonal() * term.middleRows(n, n);
      next.middleRows(n, n).noalias() = rates.block(n, 0, n, 2 * n) * term.topRows(2 * n);
      if (m == 0)  // memories that constant forces remember rest, so that only their first term is there
        next.middleRows(n, n).noalias() += rates.block(n, 2 * n, n, slots) * term.bottomRows(slots);
      next.middleRows(n, n).noalias() -= push * forces.transpose();
      term.swap(next);
      term /= static_cast<double>(m + 1);
      state += term;
      const double part = term.norm() / state.norm();
      if (!(part + last > nothing)) return;
      last = part;
    }
  }

 private:
  static constexpr Index most_terms = 64;  // of e^z, |z| <= 8, far more than rounding leaves

  struct Varying {
    const VaryingLaw* law;
    Index row;
    Index count;
    double phase;
    Index from;
    Index first;   // of its rows among those of all that vary
    Index memory;  // the same of its memory
  };

  /// How a coefficient that varies acts.
  struct Coupling {
    Index force;   // on which row, or -1
    Index memory;  // or on the rate of which memory, in the state
    Index way;     // by a row or, behind these, a memory
    Vector terms;
  };

  std::vector<Coupling> couplings_of(double phase, double width) const {
    std::vector<Coupling> all;
    for (const Varying& one : all_) {
      const Matrix terms = one.law->terms(phase + one.phase, width);
      for (Index i = 0; i < terms.cols(); ++i) {
        const auto [row, column] = one.law->places[static_cast<std::size_t>(i)];
        if (one.from < 0 && std::max(row, column) >= one.count) continue;
        const Index way = column < one.count ? one.first + column : rows_ + one.memory;
        if (row < one.count) {
          all.push_back({one.first + row, -1, way, terms.col(i)});
        } else {
          all.push_back({-1, one.from, way, width * terms.col(i)});
        }
      }
    }
    return all;
  }

  const Dense<Scalar>& motion_;
  std::vector<Varying> all_;
  Index rows_ = 0;
  Index memories_ = 0;
};

}  // namespace arcslip
