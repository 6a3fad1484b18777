#pragma once

// How the response to forcing, one contact dof and one harmonic, changes with eta and with each of the
// system's groups. With theta any of these, c = c_B + c_D, q = 1 + k phi c, t = ln(R/S), phi' = d phi/dt:
//
//   (1 + Re[k phi' c/q]) d ln R = Re[dy_0/y_0] - Re[k phi dc/q] + Re[k phi' c/q] d ln S
//   d ln Y = d ln R + Re[(k phi dc_D + k phi' c_D dt)/(1 + k phi c_D)],   dt = d ln R - d ln S

#include "arcslip/elements/contact.hpp"
#include "arcslip/problems/ridges/preload_study.hpp"

namespace arcslip::problems {

/// Derivatives of the logarithms of both amplitudes and of R/S.
struct AmplitudeSlopes {
  double log_R;      ///< ln R
  double log_Y;      ///< ln Y
  double log_ratio;  ///< ln(R/S)
};

/// The response at one point (eta, P), where R is known.
class ResponseSlopes {
 public:
  /// `slip` tells on which side of the border the law is taken. Keeps nothing of the system.
  ResponseSlopes(const FrictionSystem& system, double eta, double preload, double log_R, bool slip);

  /// Stuck, with that preload at which R = S: below 0 where P_2 eta^2 alone would hold the contact.
  static ResponseSlopes on_border(const FrictionSystem& system, double eta);

  /// The slipping response of a passive system, by Newton's method from ln(R/S) = `near` >= 0: on the border
  /// where it would not slip.
  static ResponseSlopes in_slip(const FrictionSystem& system, double eta, double preload, double near);

  /// On the border the same place on the side of slip.
  ResponseSlopes slipping() const;

  /// P, ln R, ln Y and ln(R/S) of the point.
  double preload() const { return preload_; }
  double log_R() const { return log_R_; }
  double log_Y() const { return log_Y_; }
  double log_ratio() const { return log_R_ - threshold_.value; }  ///< ln(R/S)

  /// d/d eta at fixed preload.
  AmplitudeSlopes by_eta() const;

  /// Logarithmic sensitivities of Y at fixed eta.
  PeakSensitivity sensitivity() const;

  /// Those of Y on the corner R = S, which moves in eta; from the side of stick.
  PeakSensitivity corner_sensitivity() const;

 private:
  ResponseSlopes(const FrictionSystem& system, double eta);

  void set(double preload, const LogThreshold& threshold, double log_R, bool slip);

  /// What changes with a parameter.
  struct Change {
    Complex base;          ///< dc_B
    Complex damper;        ///< dc_D
    double log_free;       ///< d ln|y_0|
    double log_threshold;  ///< d ln S
  };

  AmplitudeSlopes slopes(const Change& change) const;
  Change along_eta() const;

  /// `slope_of` gives d ln Y for a change.
  template <class SlopeOf>
  PeakSensitivity all(const SlopeOf& slope_of) const;

  double eta_;
  double preload_;
  double k_;
  ContactResponse base_;
  ContactResponse damper_;
  LogThreshold threshold_;
  double log_R_;
  double log_Y_;
  Complex phi_;
  Complex phi_log_;
};

}  // namespace arcslip::problems
