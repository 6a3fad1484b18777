#pragma once

// A contact point: a spring of stiffness k in series with a slider that yields at the displacement S, which
// is proportional to the load [Jenkins]. In slip the force follows from the motion by HysteresisLoop; it
// sticks where its amplitude A = max |x(t)| is at most S. Under motions with even orders it is the contact of
// pressed_contact.hpp under a constant normal force, and A half of the motion's range; where nothing else
// holds the mean, it sticks up to max |x(t)| and drifts beyond.

#include "arcslip/elements/element.hpp"
#include "arcslip/elements/pressed/pressed_contact.hpp"

namespace arcslip {

/// A spring in series with a slider.
class Jenkins final : public Element {
 public:
  /// Throws std::invalid_argument where stiffness or S/load is not positive.
  Jenkins(double stiffness, double slip_per_load);

  double reference_stiffness(Index /*coordinate*/ = 0) const override { return stiffness_; }
  bool has_border() const override { return true; }
  bool forgets_mean() const override { return !is_alone_; }
  bool holds_mean(Index /*coordinate*/, bool slips) const override { return !slips; }
  std::shared_ptr<const Element> alone() const override;
  std::string beyond() const override { return "slip"; }
  bool is_linear(bool slips) const override { return !slips; }
  bool may_rest() const override { return true; }
  std::optional<RestingForce> resting_force(std::span<const int> orders, const HarmonicVector& x,
                                            double load) const override;
  std::vector<ElementEvent> events(std::span<const int> orders) const override {
    return is_alone_ ? std::vector<ElementEvent>{} : further_slip_events(orders);
  }
  std::vector<Reading> readings() const override { return {{"T_max", true}, {"slip"}}; }
  std::vector<MotionNumber> read(std::span<const int> orders, const HarmonicVector& x, double load,
                                 bool slips, bool derivatives) const override;
  void force(std::span<const int> orders, const HarmonicVector& x, double load, bool slips, bool derivatives,
             ElementForce& out) const override;

  VaryingStiffness stiffness_in_time(std::span<const int> /*orders*/,
                                     const HarmonicVector& /*x*/) const override {
    return {{stiffness_}};
  }

  DisturbedLaw disturbed(std::span<const int> orders, const HarmonicVector& x, double load,
                         bool slips) const override;
  bool in_two_phases(const TwoPhases& phases, double load, const ComplexVector& x, double ratio,
                     bool derivatives, LineForce& out) const override;
  double threshold(double load) const override { return slip_per_load_ * load; }
  double threshold_by_log_load() const override { return 1; }

 private:
  void force_of_any(std::span<const int> orders, const HarmonicVector& x, double load, bool slips,
                    bool derivatives, ElementForce& out) const;
  static void set_derivatives(const PressedForce& found, double limit, ElementForce& out);
  void second_of_any(std::span<const int> orders, const HarmonicVector& x, double load, bool slips,
                     const Way& way, ElementForce& change) const;
  void second(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x, double load,
              bool slips, const Way& way, ElementForce& change) const override;
  PressedArcs::Course course(bool slips) const;

  double stiffness_;
  double slip_per_load_;
  bool is_alone_ = false;
};

}  // namespace arcslip
