#pragma once

// The settled course of a contact that is pressed together by a normal force which varies:
//
//   n(theta) = N_0 + k_n g(theta),   N = max(0, n),   f = k_t r - A,   |f| <= mu N,
//
// with r the sliding displacement, g the closing one, both periodic, and A = k_t times the slider's place.
// While the parts touch, A lies between k_t r - mu n and k_t r + mu n, rests inside and is taken along by
// these bounds: at the first in slip forwards, at the second in slip backwards. Both are monotone between the
// zeros of
//
//   n,   k_t r' - mu n',   k_t r' + mu n',
//
// which cut the period into cells; in each there is at most one onset of slip. Apart, f = 0; where the parts
// touch again A = k_t r.
//
// A period takes A to its value clipped between two bounds, so that one period settles it. Where it never
// slips any A between them is settled: that one is taken that remains as the motion grows in proportion from
// rest without friction, which is A nearest to zero.

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "arcslip/elements/slip_count.hpp"
#include "arcslip/motion/periodic_motion.hpp"

namespace arcslip {

/// Numbers of such a contact.
struct PressedSettings {
  double friction = 0;              ///< mu >= 0
  double tangential_stiffness = 1;  ///< k_t > 0
  double normal_stiffness = 0;      ///< k_n >= 0
  double normal_force = 0;          ///< N_0, where g = 0; of either sign
};

/// n = N_0 + k_n g, pressing where it is positive.
PeriodicMotion pressing_motion(const PressedSettings& settings, const PeriodicMotion& closing);

/// What a contact does over a period, arc by arc.
class PressedArcs {
 public:
  /// State.
  enum class Phase { stick, slip, apart };

  /// Which course is meant: the one there is, or that of one side of the border between both, continued
  /// smoothly for a corrector that steps beyond it. That in which it sticks has n in place of N; that in
  /// which it slips has, where it would stick, A at one bound after the other. Of one that nothing else holds
  /// A rests at 0, or it drifts: in whatever direction its sliding displacement does, or where that has no
  /// drift to the side on which it begins to slip from rest, one bound takes A along.
  enum class Course { any, sticks, slips, rests, drifts };

  /// An arc in theta.
  struct Arc {
    double begin;            ///< theta
    double width;            ///< of theta
    Phase phase;             ///< what it does
    int direction = 0;       ///< of slip, the sign of f; else 0
    double offset = 0;       ///< of stick: A
    double anchor = 0;       ///< of stick: theta at which A was set, where it drifts none behind `begin`
    bool is_set = false;     ///< of stick: false where A = 0 from rest
    double by_press = 0;     ///< of stick: dA/dn at the anchor, beside dA/d(k_t r) = 1
    bool was_apart = false;  ///< of stick: whether A was set as the parts touched, else as slip ended
  };

  /// Sliding and closing displacement. Throws std::invalid_argument of settings out of their range.
  PressedArcs(const PressedSettings& settings, const PeriodicMotion& sliding, const PeriodicMotion& closing,
              Course course = Course::any);

  /// Those of a period, one behind the other.
  const std::vector<Arc>& arcs() const { return arcs_; }

  /// n, that is N where it is not negative.
  const PeriodicMotion& press() const { return press_; }

  /// Where the sliding displacement turns back.
  std::vector<double> turns() const { return turns_ ? *turns_ : sliding_.derivative().zeros(); }

  /// Whether it sticks all the time.
  bool is_stuck() const { return arcs_.size() == 1 && arcs_.front().phase == Phase::stick; }

  /// A place of the period with the bounds of A there.
  struct Node {
    double angle;  ///< theta
    double low;    ///< k_t r - mu n
    double high;   ///< k_t r + mu n
  };

  /// Where the lower bound is highest and the upper one lowest, and the other way round.
  const Node& highest_low() const { return *std::max_element(nodes_.begin(), nodes_.end(), lower_low); }
  const Node& lowest_high() const { return *std::min_element(nodes_.begin(), nodes_.end(), lower_high); }
  const Node& lowest_low() const { return *std::min_element(nodes_.begin(), nodes_.end(), lower_low); }
  const Node& highest_high() const { return *std::max_element(nodes_.begin(), nodes_.end(), lower_high); }

  /// min (k_t r + mu n) - max (k_t r - mu n): it sticks where this is positive, and slips or comes apart
  /// where it is negative.
  double room() const { return lowest_high().high - highest_low().low; }

  /// Where nothing drifts.
  FurtherSlips further_slips() const;

  /// k_t r_0 - A at the ends of what A may be as it sticks.
  double least_mean_force() const { return mean_of_sliding() - lowest_high().high; }
  double greatest_mean_force() const { return mean_of_sliding() - highest_low().low; }

 private:
  double mean_of_sliding() const {
    return settings_.tangential_stiffness * sliding_.coefficients()(0).real();
  }
  static bool lower_low(const Node& a, const Node& b) { return a.low < b.low; }
  static bool lower_high(const Node& a, const Node& b) { return a.high < b.high; }
  struct Cell {
    Node begin;
    Node end;
    double width;
    bool touches;
    bool forwards;   // `low` rises
    bool backwards;  // `high` falls
  };
  void cut();
  void pass(bool record);
  void settle();
  void settle_drifting();
  void stay_against_drift(bool forwards);
  void join_ends();
  void stay_stuck(bool at_zero);
  void slip_no_way();
  void touch(const Cell& cell);
  void hold(const Node& node, int direction);
  void stick(const Cell& cell);
  double onset(const Cell& cell, int direction) const;
  void add(double begin, double width);
  void count_lacking(const Arc& arc, std::array<SlipCount, 2>& counts) const;

  PressedSettings settings_;
  PeriodicMotion sliding_;
  PeriodicMotion press_;
  PeriodicMotion low_;
  PeriodicMotion high_;
  std::optional<std::vector<double>> turns_;  // where they are known
  std::vector<Node> nodes_;
  std::vector<Cell> cells_;
  std::vector<Arc> arcs_;
  Arc now_{0, 0, Phase::stick};
  bool records_ = false;
};

/// The part of a period that arcs of it are in a phase.
double fraction_of(std::span<const PressedArcs::Arc> arcs, PressedArcs::Phase phase);

}  // namespace arcslip
