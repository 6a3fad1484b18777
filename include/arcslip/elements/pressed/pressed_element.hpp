#pragma once

// The contact of pressed_contact.hpp as an element of two coordinates, the sliding displacement r and the
// closing one g. Displacements are told from a rest in which it holds the equilibrium with its normal force
// max(0, N_0), so that along g acts what this changes by: N - max(0, N_0). N_0 has a part that is
// proportional to the load.

#include <array>

#include "arcslip/elements/element.hpp"
#include "arcslip/elements/jet.hpp"
#include "arcslip/elements/pressed/contact_readings.hpp"

namespace arcslip {

/// Such an element. Its first state is the one in which it sticks and never comes apart.
class PressedElement final : public Element {
 public:
  /// Numbers of it.
  struct Settings {
    Jet friction;          ///< mu >= 0
    Jet tangential;        ///< k_t > 0
    Jet normal;            ///< k_n >= 0
    Jet normal_force;      ///< N_0 without load
    Jet normal_per_load;   ///< and what the load adds to it, per load
    double reference = 1;  ///< the stiffness by which the normal force is measured where k_n = 0, > 0

    /// Of the setting that is continued, 0 if none is.
    double scale() const {
      return setting_scale(std::array{friction, tangential, normal, normal_force, normal_per_load});
    }

    /// The settings with so much added to the one that is continued.
    PressedSettings at(double load, double setting) const;

    /// Of these the rates by ln(load), which is that of N_0, and by the setting that is continued.
    double by_log_load(double load, double setting) const;
    std::array<double, PressedForce::settings> rates(double load, double setting = 0) const;
  };

  /// Throws std::invalid_argument of settings out of their range.
  explicit PressedElement(const Settings& settings);

  Index coordinates() const override { return 2; }
  double reference_stiffness(Index coordinate = 0) const override;
  bool is_odd() const override { return false; }
  bool may_rest() const override { return true; }
  std::optional<RestingForce> resting_force(std::span<const int> orders, const HarmonicVector& x,
                                            double load) const override;
  std::vector<Reading> readings() const override { return names_of_readings(); }
  std::vector<MotionNumber> read(std::span<const int> orders, const HarmonicVector& x, double load,
                                 bool beyond, bool derivatives) const override;
  bool dissipates() const override { return true; }
  std::vector<ElementEvent> events(std::span<const int> orders) const override {
    return events(is_alone_ ? std::vector<ElementEvent>{} : further_slip_events(orders),
                  settings_.normal.value > 0);
  }
  double event(Index /*which*/, std::span<const int> orders, const HarmonicVector& x,
               double load) const override {
    return least_press(settings(load), orders, x.tail(std::ssize(orders)));
  }
  bool has_border() const override { return true; }
  std::string beyond() const override { return "slip"; }
  bool rests_beyond(double load) const override;
  bool holds_mean(Index coordinate, bool beyond) const override {
    return coordinate == 0 ? !beyond : settings_.normal.value > 0;
  }
  std::shared_ptr<const Element> alone() const override;
  bool is_linear(bool beyond) const override { return !beyond && settings_.normal.value > 0; }
  void force(std::span<const int> orders, const HarmonicVector& x, double load, bool beyond, bool derivatives,
             ElementForce& out) const override;
  DisturbedLaw disturbed(std::span<const int> orders, const HarmonicVector& x, double load,
                         bool beyond) const override;
  MotionNumber border(std::span<const int> orders, const HarmonicVector& x, const Swing* known, double load,
                      bool beyond) const override;

  /// The least of N_0 + k_n g, over the sizes of both: negative where the parts come apart.
  static double least_press(const PressedSettings& settings, std::span<const int> orders,
                            const Eigen::Ref<const HarmonicVector>& closing);

  /// The events of further slips and of what may lift off.
  static std::vector<ElementEvent> events(std::vector<ElementEvent> further_slips, bool lifts_off) {
    if (lifts_off) further_slips.push_back({"lift_off"});
    return further_slips;
  }

  /// The least or greatest of max(0, N_0 + k_n g) over a motion of which g is this coordinate, or none.
  static MotionNumber extreme_press(const Settings& settings, std::span<const int> orders,
                                    const HarmonicVector& x, double load, Index closing, bool greatest);

  /// What a contact with such settings tells whose closing displacement is this coordinate, or none.
  static std::vector<Reading> names_of_readings() {
    return {{"T_max", true}, {"N_min", true}, {"N_max", true}, {"slip"}, {"apart"}};
  }
  static std::vector<MotionNumber> told(const Settings& settings, const ContactReadings& found,
                                        std::span<const int> orders, const HarmonicVector& x, double load,
                                        Index closing);

  /// Its numbers under a load.
  PressedSettings settings(double load) const { return settings_.at(load, 0); }

 private:
  void set_derivatives(const PressedForce& found, std::span<const int> orders, double load, double setting,
                       ElementForce& out) const;
  void second(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x, double load,
              bool beyond, const Way& way, ElementForce& change) const override;
  PressedArcs::Course course(bool beyond) const {
    using Course = PressedArcs::Course;
    if (is_alone_) return beyond ? Course::drifts : Course::rests;
    return beyond ? Course::slips : Course::sticks;
  }

  Settings settings_;
  bool is_alone_ = false;
};

}  // namespace arcslip
