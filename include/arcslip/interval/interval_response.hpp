#pragma once

// Enclosures of the contact law and of the response of a modal model, for whole intervals of their arguments.
//
// With x = S/R the law of contact.hpp is Re phi = (8/pi) int_0^x sqrt(s (1 - s)) ds, which a series with its
// remainder encloses for x <= 1/2; the rest follows from Re phi(x) + Re phi(1 - x) = 1. The numbers of a
// modal model, rounded to double, are taken as they are.

#include "arcslip/interval/interval.hpp"
#include "arcslip/structure/modal_model.hpp"

namespace arcslip {

/// The contact law over an interval of S/R.
struct EnclosedCoefficient {
  ComplexInterval phi;      ///< as in contact.hpp
  ComplexInterval phi_log;  ///< d phi/d ln(R/S)
  ComplexInterval slope;    ///< d(R phi)/dR = phi + phi_log, in which most of both cancels where R/S is large
};

/// For x = S/R > 0. Where x may lie on either side of 1, derivatives hold those of stick and slip; as phi is
/// continuous and each piece smooth up to the border, its differences are then still those that the mean
/// value theorem allows.
EnclosedCoefficient enclose_coefficient(const Interval& x);

/// The response over an interval of eta, as ContactResponse has it at one.
struct EnclosedResponse {
  ComplexInterval compliance;      ///< c
  ComplexInterval compliance_eta;  ///< dc/deta
  ComplexInterval free;            ///< y_0
  ComplexInterval free_eta;        ///< dy_0/deta
};

/// Throws NoEnclosure where a resonance without damping is not excluded.
EnclosedResponse enclose_response(const ModalModel& model, const Interval& eta);

}  // namespace arcslip
