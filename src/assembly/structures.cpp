#include "arcslip/assembly/structures.hpp"

#include <stdexcept>

#include "assembly/rings.hpp"

namespace arcslip {

const Structures& structures_of(const SystemParameters& system) {
  static const Rings rings;
  return system.structures ? *system.structures : rings;
}

/// All outputs of a part are seen by the same modes.
ContactModes Structures::seen(const SystemParameters& system, bool is_base) const {
  const ContactSystem wave = this->wave(system);
  const ContactModes& part = is_base ? wave.base : wave.damper;
  std::vector<ContactMode> modes = part.modes();
  const Index contacts = part.contacts();
  Index count = contacts;
  for (const ContactOutput& output : wave.outputs) {
    if (output.on_base != is_base || output.is_lag) continue;
    if (part.is_solved())
      throw std::invalid_argument("outputs of a structure that is solved for are seen one by one alone");
    for (std::size_t k = 0; k < modes.size(); ++k) {
      modes[k].shape.conservativeResize(count + 1);
      modes[k].shape(count) = output.modes.modes()[k].shape(contacts);
    }
    ++count;
  }
  return count == contacts ? part : ContactModes(count, std::move(modes), part.loss());
}

FrictionSystem Structures::one_contact(const SystemParameters& system) const {
  if (!is_one_contact(system))
    throw std::invalid_argument(
        "several contacts, or solves in place of modes, are no system of one contact");
  const ContactSystem wave = this->wave(system);
  const auto in_modes = [](const ContactModes& structure) {
    std::vector<Mode> modes;
    for (const ContactMode& mode : structure.modes())
      modes.push_back({mode.frequency, std::norm(mode.shape(0)), mode.shape(0) * mode.load, mode.influence});
    return ModalModel(std::move(modes), structure.loss());
  };
  const PairLosses losses = this->losses(system);
  return {.base = in_modes(wave.base),
          .damper = in_modes(wave.damper),
          .contact_stiffness = wave.contacts.front().stiffness,
          .slip_per_preload = wave.contacts.front().slip_per_preload,
          .base_loss_per_zeta = losses.base_per_zeta,
          .preload_growth = system.preload_growth,
          .base_loss_fixed = losses.base_fixed,
          .outputs = wave.outputs};
}

}  // namespace arcslip
