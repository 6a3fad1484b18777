#pragma once

// What is known of a system before its contacts slip: where base and damper resonate alone and where as they
// are stuck to each other, and the preloads that keep them so.

#include <string>
#include <vector>

#include "arcslip/assembly/harmonic_system.hpp"

namespace arcslip {

/// A natural frequency of the undamped structure, contacts free or stuck, without elements beside them.
struct Resonance {
  std::string part;  ///< "base", "damper", or "stuck": both joined by their contacts' springs
  double eta;        ///< where it is
  double damping;    ///< damping ratio, to the first order in the losses; 0 at eta = 0
};

/// Those of base, damper and the stuck whole under their wave, part by part, each in ascending order.
std::vector<Resonance> resonances(const ContactSystem& wave);

/// Those of `system`, whose wave it is: of rods and beams without the second modes of each, which are those
/// of their elements.
std::vector<Resonance> resonances(const SystemParameters& system, const ContactSystem& wave);

/// Which harmonic that no load acts in has a resonance of the stuck whole without damping here, as a clause;
/// empty if none has, and of whole rings. While the contacts stick, its motion is any that they bear.
std::string undamped_resonance(const SystemParameters& system, double eta);

/// The highest preload at which a contact slips at one of these eta, of contacts whose preload does not grow
/// with eta, in the first harmonic of linear structures; 0 without load.
double locking_preload(const ContactSystem& wave, const std::vector<double>& etas);

}  // namespace arcslip
