#pragma once

// Z(eta) = K + j w* C - w*^2 M with w* = 2 pi eta, for any damping, and what the contact dof sees of it by
// linear solves. ModalModel gives the same for proportional damping, faster and for any N; this is the
// general route and the check on the other.

#include "arcslip/structure/modal_model.hpp"

namespace arcslip {

/// Reduced matrices in double precision, J x J each; the load has J entries.
struct DynamicStiffness {
  /// M, C, K and F.
  ComplexMatrix mass;
  ComplexMatrix damping;
  ComplexMatrix stiffness;
  ComplexVector load;

  /// Z(eta), J x J.
  ComplexMatrix at(double eta) const;

  /// y = Z^{-1} f, J entries.
  ComplexVector solve(double eta, const ComplexVector& force) const;

  /// Compliance and free response at `contact_dof`. The derivatives are -x_l^T (dZ/deta) x_r with the left
  /// solve x_l = Z^{-T} e and the right ones; the two differ, for Z is not complex symmetric.
  ContactResponse contact_response(double eta, Index contact_dof) const;
};

/// The matrices of `structure` with C = (damping/2 pi) K.
DynamicStiffness dynamic_stiffness(const ReducedStructure& structure, double damping);

}  // namespace arcslip
