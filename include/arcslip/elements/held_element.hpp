#pragma once

// A contact that sticks for ever under a mean force of its own along its first coordinate, whatever the mean
// of its motion is: f = k x in all harmonics but the mean, for which the force is given.

#include <memory>
#include <string>

#include "arcslip/elements/element.hpp"

namespace arcslip {

/// Such a state of an element that has a `resting_force`; it tells nothing beside its force.
class HeldElement final : public Element {
 public:
  /// The force is that against the first coordinate.
  HeldElement(std::shared_ptr<const Element> element, double force)
      : element_(std::move(element)), force_(force) {}

  Index coordinates() const override { return element_->coordinates(); }
  double reference_stiffness(Index coordinate = 0) const override {
    return element_->reference_stiffness(coordinate);
  }
  bool takes_any_orders() const override { return element_->takes_any_orders(); }
  bool is_odd() const override { return false; }
  bool has_border() const override { return true; }
  std::string beyond() const override { return element_->beyond(); }
  bool forgets_mean() const override { return element_->forgets_mean(); }
  bool holds_mean(Index coordinate, bool beyond) const override {
    return coordinate > 0 && element_->holds_mean(coordinate, beyond);
  }
  double threshold(double load) const override { return element_->threshold(load); }
  double threshold_by_log_load() const override { return element_->threshold_by_log_load(); }
  /// Beyond its border nothing is held: not a number.
  void force(std::span<const int> orders, const HarmonicVector& x, double load, bool beyond, bool derivatives,
             ElementForce& out) const override;
  MotionNumber border(std::span<const int> orders, const HarmonicVector& x, const Swing* known, double load,
                      bool beyond) const override {
    return element_->border(orders, x, known, load, beyond);
  }
  std::optional<RestingForce> resting_force(std::span<const int> orders, const HarmonicVector& x,
                                            double load) const override {
    return element_->resting_force(orders, x, load);
  }

 private:
  /// Of solutions alone, which need none.
  void second(const ElementForce& /*at*/, std::span<const int> /*orders*/, const HarmonicVector& /*x*/,
              double /*load*/, bool /*beyond*/, const Way& /*way*/, ElementForce& /*change*/) const override;

  std::shared_ptr<const Element> element_;
  double force_;
};

}  // namespace arcslip
