// A sine that travels: what the force is told for.

#include "arcslip/assembly/excitation.hpp"

namespace arcslip {

ExcitationKind travelling_excitation() {
  return {
      "travelling", "a sine that travels round the ring", {}, {}, [](const Excitation&, int h) -> Complex {
        return h == 1 ? 1 : 0;
      }};
}

}  // namespace arcslip
