#pragma once

// Which laws the elements of M nodes obey and what they remember, node k being where node 0 is turn k/M
// earlier: over the angle turn/M, after which each node does what the one before it has done.

#include <span>
#include <vector>

#include "arcslip/elements/disturbed_law.hpp"

namespace arcslip {

class LawSchedule {
 public:
  /// A memory of an element of one node.
  struct Slot {
    std::size_t element;
    std::size_t memory;
    Index node;
    bool is_set = false;  ///< just where the interval begins

    friend bool same(const Slot& a, const Slot& b) {
      return a.element == b.element && a.memory == b.memory && a.node == b.node;
    }
  };

  /// All laws stay the same for an angle `width`.
  struct Interval {
    double begin;  ///< phase of node 0
    double width;
    std::vector<Slot> slots;  ///< that are kept, those of each element in the order of its memories
  };

  /// `turn`: pi or 2 pi.
  LawSchedule(std::span<const DisturbedLaw> laws, Index nodes, double turn);

  const std::vector<Interval>& intervals() const { return intervals_; }

  /// What is kept behind the last interval: in this order the slots that, one node before, are those of the
  /// first one.
  const std::vector<Slot>& behind() const { return behind_; }

  /// The law of an element of a node in the middle of an interval.
  const DisturbedLaw::Piece& piece(const Interval& interval, std::size_t element, Index node) const;

  /// What has to be added to the phase of node 0 in an interval for that at which a node has this law, among
  /// the pieces over the first turn.
  double offset(const Interval& interval, std::size_t element, Index node) const;

  /// The phase of a node where that of node 0 is `angle`.
  double phase(double angle, Index node) const {
    return angle - turn_ * static_cast<double>(node) / static_cast<double>(nodes_);
  }

 private:
  std::vector<Slot> kept(double begin, double width) const;

  std::span<const DisturbedLaw> laws_;
  Index nodes_;
  double turn_;
  std::vector<Interval> intervals_;
  std::vector<Slot> behind_;
};

}  // namespace arcslip
