#pragma once

// The base without damper, to which studies compare: its highest amplitude Y_nd_max at the first contact dof
// in a window of eta, and the damping with which it would be as low as with a damper.

#include "arcslip/problems/ridges/preload_study.hpp"
#include "arcslip/structure/contact_modes.hpp"

namespace arcslip::problems {

/// The amplitude |y_0| of the first contact of a base that nothing touches: u - ln |y_0(eta)| = 0 with the
/// one unknown u = ln Y and the parameter eta.
class FreeResponse : public continuation::Problem {
 public:
  /// The base with its load.
  explicit FreeResponse(ContactModes base) : base_(std::move(base)) {}

  Index size() const override { return 1; }
  std::vector<std::string> parameter_names() const override { return {"eta"}; }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override;
  std::vector<continuation::Observable> observables() const override { return {{"Y", true}}; }
  void observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
               Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const continuation::Regime& regime, Index which,
                 continuation::Gradient& gradient) const override;
  std::vector<double> landmarks(Index parameter, double from, double to) const override;

  /// The solution.
  continuation::Guess guess(double eta) const;

 private:
  ContactModes base_;
};

/// The highest amplitude of the base alone in the window, its ends included. Throws std::runtime_error where
/// it cannot be traced.
Peak free_peak(const ContactModes& base, const PreloadRange& range,
               const continuation::TraceOptions& options);

/// That of one contact, whose base may have cubic springs.
Peak free_peak(FrictionSystem system, const PreloadRange& range, const continuation::TraceOptions& options);

/// zeta_B of the base alone, which is zeta with the highest peak `free`, whose highest peak would be Y; nan
/// where none has.
double equivalent_damping(const FrictionSystem& system, double zeta, const PreloadRange& range,
                          const Peak& free, double Y, const continuation::TraceOptions& options);

}  // namespace arcslip::problems
