#pragma once

// Growth of small disturbances of a travelling response, at a cost that does not depend on N. A disturbance
// that travels with the response, node i as node 1 with the delay (i - 1) nT/N,
//
//   delta r(t) = Re sum_h rho_h(t) e^{jhwt},   rho_h(t) = rho_h e^{lambda t},   lambda = 2 pi sigma
//
// meets in each harmonic the modes of base and damper at the propagation constant h a, with s_k and d_k of
// contact_modes.hpp at j eta -> sigma + jh eta, and in friction the exact derivative of the loop's force:
//
//   rho_h = -sum_k s_k s_k^H K f_h/d_k(sigma + jh eta)
//   f_h = (2/pi) sum_arcs int (delta r(theta) - x(theta)) e^{-jh theta} dtheta,   half of it for h = 0
//   sigma x + eta dx/dtheta = 0 on each arc of stick,   x = delta r where it begins
//
// as the slider rests while its contact sticks. A smooth element, whose stiffness varies as the response's
// motion x passes in its coordinate, has
//
//   f_h = sum_l c_{h-l} delta x_l + c_{h+l} conj(delta x_l),   k(theta) = sum_n c_n e^{jn theta}:
//
// half of it for h = 0. With sliders given by their values at Chebyshev points of each arc,
// the exponents sigma are the eigenvalues of one real matrix, and converge faster than any power of the
// number of points. Response and loop being odd, odd and even h do not mix. The matrix of the response's own
// harmonics is singular exactly where the Jacobian of their balance is.
//
// These h stand for as many waves, of h n and -h n lengths: where the ring has no more of them, several
// exponents would stand for the same multiplier, and turned_flow.hpp has each once.

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/time/ring_waves.hpp"
#include "arcslip/time/stick_pattern.hpp"

namespace arcslip {

/// Of one response's system; may be asked at any eta and pattern of stick.
class DisturbanceFlow {
 public:
  /// Of disturbances in the harmonics of `system`, all odd or all even, of a response with harmonics up to
  /// `highest`. Throws as oscillators() does.
  DisturbanceFlow(const HarmonicSystem& system, int highest);

  /// `elements`: of each contact, then of each further coordinate.
  /// sigma, in any order: a disturbance grows by |mu| = e^{2 pi Re sigma/eta} in a period. Real parts within
  /// rounding of 0 are 0. Sliders of contacts that do not slip are constants of the motion and left out, as
  /// is the neutral drift of base against damper as rigid bodies where all contacts slip, and the velocity of
  /// a motion that no load drives.
  ComplexVector exponents(double eta, std::span<const StickPattern> elements) const;

  /// The wave round a ring that the disturbance with this exponent mostly is, as disturbed_wave.hpp says.
  Index wave_of(const Complex& exponent, double eta, std::span<const StickPattern> elements,
                const RingWaves& ring) const;

 private:
  struct Coordinate {
    Oscillator mode;
    Index order;      ///< position of h
    Index place = 0;  ///< of its state
  };
  Index parts(Index order) const { return orders_[static_cast<std::size_t>(order)] == 0 ? 1 : 2; }
  Matrix drifts(Index size, std::span<const StickPattern> elements) const;
  Matrix velocity(Index size, double eta, std::span<const StickPattern> elements) const;

  Matrix matrix(double eta, std::span<const StickPattern> elements) const;
  ComplexMatrix relative_motion(Index size) const;
  struct Flow;
  void add_sliders(double eta, Index contact, const StickPattern& pattern, Index first, Flow& flow) const;
  void add_stiffness(Index coordinate, const VaryingStiffness& stiffness, Flow& flow) const;
  void add_modes(double eta, Flow& flow) const;

  std::vector<int> orders_;
  Vector springs_;  ///< k of each contact, 0 of further coordinates
  Index contacts_;
  std::vector<Coordinate> coordinates_;
  Index modal_states_ = 0;
  Vector places_;      ///< Chebyshev points from -1 to 1
  Vector weights_;     ///< of the values there in the integral
  Matrix derivative_;  ///< of the polynomial through them
};

}  // namespace arcslip
