#pragma once

// The first zero of a smooth function on an interval, from values and slopes at some places, so that no pair
// of zeros is stepped over that these leave room for.
//
// Between two places the function is taken for the cubic with its values and slopes there. Once such a cubic
// has foretold a value in between it is relied upon in both halves; until then, and wherever it comes near
// zero between its ends, the interval is divided.

#include <functional>
#include <optional>
#include <span>

namespace arcslip::continuation {

/// A function at one place; its slope may be nan, for unknown.
struct Node {
  double s;      ///< the place
  double value;  ///< there
  double slope;  ///< by s
};

/// Where a function vanishes: nowhere, at s, or unknown for want of values.
struct Zero {
  /// Whether there is a zero, none, or no telling.
  enum class State { found, absent, failed };
  State state = State::absent;  ///< only where it is `found` s counts
  double s = 0;                 ///< where it vanishes
  bool touches = false;         ///< there, and keeps its sign
};

/// How many zeros there are, where the values tell.
enum class Zeros { none, one, unclear };

/// How many zeros the cubic has between two places that are none, by a margin of half the values there.
Zeros zeros_between(const Node& a, const Node& b);

/// Where the cubic between two places with values of opposite sign has a zero.
double zero_of_cubic(const Node& a, const Node& b);

/// What `first_zero` finds.
struct FirstZero {
  /// `none` is surely none; for the others see `first_zero`.
  enum class Kind { none, change, touch, unclear, unknown };
  Kind kind = Kind::none;  ///< of the zero
  Node before{};           ///< the zero lies between these two: at a change of sign it is the only one,
  Node behind{};           ///< at a touch there are two closer together than `least`
};

/// The first zero between a and b. `at` evaluates the function in between, or returns nothing where that
/// fails: then the search ends as `unknown`. It ends as `unclear` if a hundred places do not tell. Nothing
/// closer together than `least` is told apart.
FirstZero first_zero(const Node& a, const Node& b, const std::function<std::optional<Node>(double s)>& at,
                     double least);

/// Whether a smooth function may vanish twice in a step on which its sign stays, by its values at the end of
/// the step, at the beginning, and at up to three points before, at falling `places`. Without two points
/// before it may.
bool may_vanish_twice(std::span<const double> places, std::span<const double> values);

/// The same by the logarithms of values of one sign: of a function that grows or fades by orders of
/// magnitude.
bool logarithm_may_fall(std::span<const double> places, std::span<const double> logarithms);

}  // namespace arcslip::continuation
