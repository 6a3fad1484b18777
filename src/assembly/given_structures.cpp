#include "arcslip/assembly/given_structures.hpp"

#include <stdexcept>

namespace arcslip {

ContactModes GivenStructures::part(const GivenPart& part, Index wave, double force) const {
  std::vector<ContactMode> modes;
  if (part.modes) modes = part.modes(wave);
  const auto answer = [respond = part.response, wave](double eta, double load) {
    ContactReceptance response = respond(wave, eta);
    response.free *= load;
    response.free_eta *= load;
    return response;
  };
  return ContactModes(contacts_, std::move(modes), {}).solved_by(answer, force);
}

ContactSystem GivenStructures::wave(const SystemParameters& system) const {
  if (system.tells_lag)
    throw std::invalid_argument(
        "a structure given by its responses tells no lag, as it does not tell where its load acts");
  const ContactModes held(contacts_, {}, {});
  return {part(base_, system.wave_number, system.force),
          damper_ ? part(*damper_, system.wave_number, 0) : held, system.contacts};
}

}  // namespace arcslip
