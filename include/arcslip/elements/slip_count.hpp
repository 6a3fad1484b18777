#pragma once

// Where along a branch a further slip begins or ends within a period of a contact: there the derivatives of
// its force jump. What a function tells of it is, for the slips in one direction, least of
//
//   what the force lacks to its limit in this direction where it comes nearest to it within an arc of stick,
//   the way of each arc of slip,
//
// positive where the number of slips is even. It passes zero as a slip begins within an arc of stick. Where
// an arc of slip is divided by one of stick, as the motion there turns back, it jumps: nothing in the force
// does. The way of the slips without which there would be none in a period does not count.

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "arcslip/motion/swing.hpp"

namespace arcslip {

/// Such a function.
class SlipCount {
 public:
  /// An arc of stick comes so near to the limit, and an arc of slip goes so far.
  void stick(double lacking) {
    least_lacking_ = std::min(least_lacking_, lacking);
    ++pieces_;
  }
  void slip(double way) {
    shortest_ = std::min(shortest_, way);
    ++count_;
    ++pieces_;
  }

  int count() const { return count_; }

  /// How many of all these there are: the function is continuous as long as they stay as many.
  int pieces() const { return pieces_; }

  /// The function in a unit of the force, between -1 and 1; whether the way of slips counts.
  double value(double unit, bool with_ways) const {
    const double least = std::min(least_lacking_, with_ways ? shortest_ : unlimited) / unit;
    return count_ % 2 == 0 ? std::min(least, 1.0) : -std::min(least, 1.0);
  }

 private:
  static constexpr double unlimited = std::numeric_limits<double>::infinity();
  double least_lacking_ = unlimited;
  double shortest_ = unlimited;
  int count_ = 0;
  int pieces_ = 0;
};

/// These functions of a contact.
struct FurtherSlips {
  std::array<double, 2> functions{-1, -1};  ///< of slips forwards and backwards
  int piece = 0;                            ///< where it changes they may jump

  /// In a unit of the force.
  static FurtherSlips of(const std::array<SlipCount, 2>& slips, double unit, bool with_ways) {
    return {{slips[0].value(unit, with_ways), slips[1].value(unit, with_ways)},
            slips[0].pieces() + slips[1].pieces()};
  }

  /// Where nothing slips and the parts do not come apart: at the border of slip but for rounding, at which
  /// one slip each way begins.
  static FurtherSlips at_border() { return {{-1, -1}, 2}; }
};

/// What may begin or end within a period.
struct ElementEvent {
  std::string name;  ///< as "lift_off"
  std::optional<std::size_t> further_slips =
      {};  ///< which of FurtherSlips::functions tells of it, if one does
};

/// The events of further slips: forwards and backwards, of which under odd motions one tells all. In one
/// harmonic there is none.
inline std::vector<ElementEvent> further_slip_events(std::span<const int> orders) {
  if (orders.size() == 1) return {};
  if (all_odd(orders)) return {{"further_slip", 0}};
  return {{"further_slip_forwards", 0}, {"further_slip_backwards", 1}};
}

}  // namespace arcslip
