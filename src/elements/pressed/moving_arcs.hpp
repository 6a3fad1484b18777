#pragma once

// Forces of pressed_contact.hpp beside a motion, over arcs that stay as many as they are there, one behind
// the other in the same order, and whose ends and offsets go as fast as they do there. By steps along this
// second derivatives are those of one side wherever an arc is born or lost, and there is none to step across.

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "arcslip/elements/element.hpp"
#include "arcslip/elements/pressed/pressed_contact.hpp"

namespace arcslip {

/// How fast motions and settings change.
struct PressedChange {
  ComplexVector sliding;                            ///< r_h
  ComplexVector closing;                            ///< g_h
  std::array<double, PressedForce::settings> by{};  ///< each setting
};

/// Forces beside a motion.
class MovingArcs {
 public:
  /// As for pressed_force.
  MovingArcs(const PressedSettings& settings, std::span<const int> orders, const ComplexVector& sliding,
             const ComplexVector& closing, PressedArcs::Course course, PressedChange change);

  /// So many steps further, with derivatives.
  PressedForce at(double steps) const;

  /// Adds how `linear`, `conjugate`, `by_log_load` and `by_setting` change per step, by `filled`, which has
  /// them of a force so many steps further. What else changes does so at most at this pace.
  void add_change(double pace,
                  const std::function<ElementForce(const PressedForce& force, double steps)>& filled,
                  ElementForce& change) const;

 private:
  /// How fast what describes an arc goes, beside its phase.
  struct Rate {
    double begin = 0;
    double end = 0;
    double anchor = 0;
    double offset = 0;
    double by_press = 0;
  };
  double pace() const;
  PressedSettings settings_at(double steps) const;

  PressedSettings settings_;
  std::span<const int> orders_;
  ComplexVector sliding_;
  ComplexVector closing_;
  PressedArcs::Course course_;
  PressedChange change_;
  std::vector<PressedArcs::Arc> arcs_;
  std::vector<Rate> rates_;
};

}  // namespace arcslip
