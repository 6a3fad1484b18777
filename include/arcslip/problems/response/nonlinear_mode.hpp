#pragma once

// A travelling-wave mode of base, damper and sliding contacts, without excitation [extended periodic motion:
// M. Krack, Nonlinear modal analysis of nonconservative systems, Comput. Struct. 154 (2015) 59]. Damping
// proportional to mass, -2 zeta w* M on both structures, replaces what is lost and keeps the motion periodic:
//
//   x_h + C_h(eta, zeta) f_h(x) = 0,   d_k(h eta) = ... - 2 j zeta h eta^2 in each mode of C_h.
//
// eta is then the mode's frequency and zeta its damping ratio at the amplitude R of the first contact's first
// harmonic. Where zeta = 0 the motion needs no help: a limit cycle.
//
// Unknowns: eta, zeta, then Re and Im of all harmonics of all coordinates but that one, in the order of
// HarmonicResponse. Parameters: R, P and, if it may be continued, a further one of the system.
//
// Where other modes are far, the forced response near the mode follows from it: with the mode's motion in
// the structures' modal coordinates, q = a psi, |psi| = 1, and the load l,
//
//   a |eta^2 - W^2 + 2 j zeta eta W| = F |psi^H l|,   which peaks at the force F = 2 zeta eta^2 a/|psi^H l|.

#include <array>
#include <optional>

#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/problems/response/free_vibration.hpp"

namespace arcslip::problems {

/// The equations above.
class NonlinearMode : public FreeVibration {
 public:
  /// Positions of R, P and a further parameter of the system, and of the first two unknowns.
  enum Parameter : Index { amplitude, preload, further };
  enum Unknown : Index { frequency, damping };
  /// Observables in this order; `force` is that whose response, synthesised from the mode, peaks here, in
  /// units of the system's own.
  enum Quantity : Index { eta, zeta, S, R_over_S, Y, U, dissipated, force };

  /// Throws std::invalid_argument where base, damper and contacts differ in number.
  explicit NonlinearMode(HarmonicSystem system);

  std::vector<std::string> parameter_names() const override { return names_with_varied({"R", "P"}); }
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override;

  /// The modes of small motions, at about this frequency, amplitude and preload: with the stiffness that
  /// elements then have. Their `relative` is x_1 of all coordinates.
  std::vector<JoinedMode> small_modes(double eta_value, double R_value, double preload_value) const;

  /// A guess of the mode whose frequency in stick is nearest to `eta_value`, at this R and P; R must be so
  /// small that all contacts stick. Throws std::invalid_argument where it is not.
  continuation::Guess guess(double eta_value, double R_value, double preload_value) const;

  /// The same at these parameters, and at any R: one at which contacts slip is reached from a smaller one.
  /// Throws Unfinished where max_seconds or go_on of the limits end the search.
  continuation::Guess guess(double eta_value, const Vector& parameters,
                            const continuation::TraceOptions& limits) const;

  /// The excitation frequencies at which the response to `force` times the load, synthesised from the mode at
  /// this point, has its amplitude; none above the peak.
  std::optional<std::array<double, 2>> flanks(const Vector& u, const Vector& p,
                                              const continuation::Regime& regime, double force) const;

 protected:
  double synthesised_force(const Vector& u, const Vector& p,
                           const continuation::Regime& regime) const override;

 private:
  struct Modal {
    double amplitude;  // a
    double load;       // |psi^H l|
  };
  Modal modal(const Vector& u, const Vector& p, const continuation::Regime& regime) const;
};

}  // namespace arcslip::problems
