// Pads that press on arcs of the ring and travel: within each wavelength one that pushes evenly over a part w
// of it and, half a wavelength away, one that pulls. Its Fourier series has the odd harmonics sin(h pi w)/h.

#include <cmath>

#include "arcslip/assembly/excitation.hpp"
#include "arcslip/types.hpp"

namespace arcslip {

ExcitationKind arcs_excitation() {
  return {"arcs",
          "even pressure on travelling arcs, one that pushes and one that pulls in each wavelength; F is the "
          "amplitude of the first harmonic",
          {{"width", 0.5, 0, 0.5, false, "w of an arc, over the wavelength; 0.5 is a square wave", false}},
          {},
          [](const Excitation& load, int h) -> Complex {
            const double angle = pi * load.settings[0];
            return h % 2 == 0 ? 0 : std::sin(h * angle) / (h * std::sin(angle));
          }};
}

}  // namespace arcslip
