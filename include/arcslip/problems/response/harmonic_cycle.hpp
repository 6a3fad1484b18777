#pragma once

// Self-excited vibration in several harmonics, contacts and with further elements: a base with negative
// damping zeta_B, held by friction; see limit_cycle.hpp, which is this in one harmonic of one contact,
//
//   x_h + C_h(eta; zeta_B) f_h(x) = 0.
//
// Unknowns: eta, the amplitude R of the first contact's first harmonic, then Re and Im of all other harmonics
// of all coordinates, in the order of HarmonicResponse. Parameters: zeta_B, P. Where nothing slips any
// more the branch ends: what is stuck loses nothing to friction.

#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/problems/response/free_vibration.hpp"

namespace arcslip::problems {

/// The equations above.
class HarmonicCycle : public FreeVibration {
 public:
  /// Positions of zeta_B, P and, if it may be continued, a further parameter of the system.
  enum Parameter : Index { zeta, preload, further };
  /// Positions of the first two.
  enum Unknown : Index { eta, amplitude };

  /// The base's damping in `system` is replaced by the parameter zeta_B; its kind is kept. Throws
  /// std::invalid_argument where base, damper and contacts differ in number.
  explicit HarmonicCycle(HarmonicSystem system);

  std::vector<std::string> parameter_names() const override { return names_with_varied({"zeta_B", "P"}); }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override;
  std::optional<continuation::Regime> regime_beyond(const continuation::Regime& regime,
                                                    int border) const override;

  /// A cycle at (zeta_B, P): where a nonlinear mode, followed from stick over its amplitude, has no damping.
  /// One at which the damping rises with the amplitude comes before one at which it falls, then the lowest
  /// mode. Throws std::invalid_argument if none is found, Unfinished where max_seconds or go_on of the limits
  /// end the search.
  continuation::Guess guess(double zeta_value, double preload_value,
                            const continuation::TraceOptions& limits = {}) const;

  /// The same at these parameters.
  continuation::Guess guess(const Vector& parameters, const continuation::TraceOptions& limits = {}) const;

 private:
  struct Found;
  void add_cycles(const HarmonicSystem& damped, const JoinedMode& mode, double zeta_value,
                  double preload_value, const continuation::TraceOptions& limits,
                  std::vector<Found>& found) const;

  double zeta_scale_ = 0;
};

}  // namespace arcslip::problems
