#pragma once

// The damper driven by a base that moves as if alone: friction acts on the damper and not back on the base.
//
//   y = y_0(eta),   R |1 + k phi(R/S) c_D(eta)| = |y_0(eta)|,   u = -k c_D phi r,   S = (P + P_2 eta^2)
//   K*/K_FD
//
// It is the coupled response, see forced_response.hpp, without the base's compliance c_B. The error of that
// is of the order of |k phi c_B/(1 + k phi c_D)|: small where the damper is much lighter than the base and
// eta is not near the base's own resonance [paper, section 1].

#include "arcslip/problems/response/forced_response.hpp"

namespace arcslip::problems {

/// The equations above.
class OneWayResponse : public ForcedResponse {
 public:
  /// The system with both sides; its base becomes unyielding.
  explicit OneWayResponse(FrictionSystem system);
};

}  // namespace arcslip::problems
