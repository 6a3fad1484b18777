#pragma once

// The observables whose extrema are looked for, and the borders, as smooth functions along a branch.

#include <algorithm>
#include <cmath>
#include <vector>

#include "arcslip/continuation/path/step.hpp"
#include "arcslip/continuation/problem/problem.hpp"

namespace arcslip::continuation {

/// The tracked observables first, then the borders. Keeps the problem by reference.
class Monitors {
 public:
  /// `parameter` is the position of the active one, `tracked` are the observables'.
  Monitors(const Problem& problem, Index parameter, std::vector<Index> tracked);

  /// Values at a point and slopes along `slope`, n + 1, in units of the scale.
  void look(const CurvePoint& point, const Vector& scale, const Vector& slope, std::vector<Monitor>& out);

  /// A border's value at a point, with its gradient in units of the scale.
  double border(const CurvePoint& point, int border, const Vector& scale, Vector& gradient);

  /// By how much the last bits of a point change what has this slope there.
  double rounding(const CurvePoint& point, double slope) const;

  /// The observables whose extrema are looked for, and their number.
  const std::vector<Index>& tracked() const { return tracked_; }
  Index tracked_count() const { return static_cast<Index>(tracked_.size()); }

  /// What changes of a tracked observable are measured in, where it has this value.
  double size_of(std::size_t observable, double value) const {
    return std::max(observed_[observable].scale, std::abs(value));
  }

  /// The same of a step: where it vanishes, no less than a small part of its reach.
  double size_between(std::size_t observable, const Monitor& from, const Monitor& to) const {
    constexpr double small = 1e-2;
    return std::max(small * std::max(from.reach, to.reach),
                    size_of(observable, std::max(std::abs(from.value), std::abs(to.value))));
  }

  /// What a step may leave open.
  struct Limits {
    double change;   ///< of an observable, relative
    double bend;     ///< of a change, by which the mean of the end slopes may miss it
    double shallow;  ///< of a value: how good it is
  };

  /// How far values and slopes where a step begins and at s are from those of a curve without more in
  /// between: at most 1 where they fit one, and about as s.
  double roughness(const Step& step, double s, const std::vector<Monitor>& at_s, const Limits& limits) const;

 private:
  const Problem& problem_;
  Index parameter_;
  std::vector<Index> tracked_;
  std::vector<Observable> observed_;  // those tracked
  Gradient gradient_;
};

}  // namespace arcslip::continuation
