#pragma once

// Which of M nodes stick when, node k being where node 0 is pi k/M earlier: over the angle pi/M, after which
// each node does what the one before it has done.

#include <span>
#include <vector>

#include "arcslip/time/stick_pattern.hpp"

namespace arcslip {

class StickSchedule {
 public:
  /// A stretch of stick of one contact of one node.
  struct Slot {
    std::size_t contact;
    std::size_t arc;
    Index node;

    friend auto operator<=>(const Slot&, const Slot&) = default;
  };

  /// What sticks stays the same for an angle `width`.
  struct Interval {
    double begin;  ///< phase of node 0
    double width;
    std::vector<Slot> sticking;  ///< ascending; of contacts that slip at times
  };

  /// Begins where something ceases to stick, if anything does.
  StickSchedule(std::span<const StickPattern> contacts, Index nodes);

  const std::vector<Interval>& intervals() const { return intervals_; }

  /// What sticks behind the last interval: in this order the slots that, one node before, are those of the
  /// first one.
  const std::vector<Slot>& behind() const { return behind_; }

 private:
  std::vector<Slot> sticking(std::span<const StickPattern> contacts, double angle) const;

  Index nodes_;
  std::vector<Interval> intervals_;
  std::vector<Slot> behind_;
};

/// Where, between the ends of an interval, the law of a smooth element of some node changes, with these ends.
std::vector<double> law_changes(const StickSchedule::Interval& interval, std::span<const StickPattern> others,
                                Index nodes);

}  // namespace arcslip
