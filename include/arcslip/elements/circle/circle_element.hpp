#pragma once

// The friction circle of circle_contact.hpp as an element of two coordinates, the sliding displacements x and
// y, or of three with the closing one g. Along g acts by what its normal force changes from rest, N -
// max(0, N_0), as in PressedElement, whose settings it has. Under a constant normal force it is odd.

#include "arcslip/elements/circle/circle_contact.hpp"
#include "arcslip/elements/pressed/pressed_element.hpp"

namespace arcslip {

/// Such an element. Its first state is the one in which it sticks and never comes apart.
class CircleElement final : public Element {
 public:
  using Settings = PressedElement::Settings;

  /// Throws std::invalid_argument of settings out of their range, or of a normal stiffness where it does not
  /// close.
  CircleElement(const Settings& settings, bool closes);

  Index coordinates() const override { return closes_ ? 3 : 2; }
  double reference_stiffness(Index coordinate = 0) const override;
  bool is_odd() const override { return !closes_; }
  bool may_rest() const override { return true; }
  std::vector<Reading> readings() const override { return PressedElement::names_of_readings(); }
  std::vector<MotionNumber> read(std::span<const int> orders, const HarmonicVector& x, double load,
                                 bool beyond, bool derivatives) const override;
  bool dissipates() const override { return true; }
  std::vector<ElementEvent> events(std::span<const int> orders) const override {
    return PressedElement::events(further_slip_events(orders), closes_ && settings_.normal.value > 0);
  }
  double event(Index /*which*/, std::span<const int> orders, const HarmonicVector& x,
               double load) const override {
    return PressedElement::least_press(settings_.at(load, 0), orders, x.tail(std::ssize(orders)));
  }
  bool has_border() const override { return true; }
  bool holds_mean(Index coordinate, bool beyond) const override {
    return coordinate < 2 ? !beyond : settings_.normal.value > 0;
  }
  std::string beyond() const override { return "slip"; }
  bool rests_beyond(double load) const override { return !(settings_.at(load, 0).normal_force > 0); }
  bool is_linear(bool beyond) const override { return !beyond && (!closes_ || settings_.normal.value > 0); }
  void force(std::span<const int> orders, const HarmonicVector& x, double load, bool beyond, bool derivatives,
             ElementForce& out) const override;
  MotionNumber border(std::span<const int> orders, const HarmonicVector& x, const Swing* known, double load,
                      bool beyond) const override;

  bool is_told_by_law() const override { return true; }
  DisturbedLaw disturbed(std::span<const int> orders, const HarmonicVector& x, double load,
                         bool beyond) const override {
    return circle_law(settings(load), orders, x, beyond, is_odd() && all_odd(orders) ? pi : two_pi);
  }

  /// At this load.
  PressedSettings settings(double load) const { return settings_.at(load, 0); }

 private:
  void force_at(std::span<const int> orders, const HarmonicVector& x, double load, double setting,
                bool beyond, bool derivatives, ElementForce& out) const;
  void second(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x, double load,
              bool beyond, const Way& way, ElementForce& change) const override;

  Settings settings_;
  bool closes_;
};

}  // namespace arcslip
