// A jet that stands still and past which the ring turns: it presses evenly on a part w of each wavelength,
// that is of one turn where the load has one wave. Its Fourier series has all harmonics, those of a point
// force times sin(h pi w)/(h pi w), and half of that as its mean.

#include <cmath>

#include "arcslip/assembly/excitation.hpp"

namespace arcslip {

ExcitationKind jet_excitation() {
  return {
      "jet",
      "even pressure on one arc of each wavelength, in all harmonics with the mean: of a jet past which the "
      "ring turns; F is the amplitude of a narrow one's harmonics",
      {{"width", 0, 0, 1, false, "w of the arc, over the wavelength; 0 is a point"}},
      {},
      [](const Excitation& load, int h) -> Complex {
        const double angle = pi * h * load.settings[0];
        if (h == 0) return 0.5;
        return angle == 0 ? 1 : std::sin(angle) / angle;
      },
      [](const Excitation&) { return false; }};
}

}  // namespace arcslip
