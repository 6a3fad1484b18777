#pragma once

// Forced response that knows its stability: the exponents of disturbances (disturbance_flow.hpp) in its own
// harmonics and in the even ones between them are the eigenvalues that the engine counts along the branch. A
// real one of odd harmonics crosses zero at a fold, a pair crosses the imaginary axis where a vibration with
// a second frequency branches off.

#include "arcslip/disturbance_flow.hpp"
#include "arcslip/problems/harmonic_response.hpp"
#include "arcslip/system.hpp"

namespace arcslip::problems {

class FloquetResponse : public HarmonicResponse {
 public:
  /// `system` also in even harmonics is `even`. Throws std::invalid_argument as HarmonicResponse and
  /// DisturbanceFlow do.
  FloquetResponse(const HarmonicSystem& system, const HarmonicSystem& even);

  /// sigma of DisturbanceFlow, lambda = 2 pi sigma.
  bool eigenvalues(const Vector& u, const Vector& p, int regime, ComplexVector& values) const override;

  continuation::PointType pair_crossing() const override { return continuation::PointType::neimark_sacker; }

 private:
  DisturbanceFlow odd_;
  DisturbanceFlow even_;
};

/// Harmonics 0, 2, ... of disturbances, up to about the highest one of the response.
std::vector<int> even_orders(const SystemParameters& parameters);

/// The model in these. Throws SectorError.
HarmonicSystem build_even_system(const SystemParameters& parameters);

}  // namespace arcslip::problems
