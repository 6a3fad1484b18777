#include "arcslip/harmonic_system.hpp"

#include <cmath>

#include "arcslip/sector_pair.hpp"
#include "arcslip/system.hpp"

namespace arcslip {
namespace {

ContactModes one_contact(const ModalModel& model) {
  std::vector<ContactMode> modes;
  for (const Mode& mode : model.modes()) {
    const double shape = std::sqrt(mode.residue);
    modes.push_back({mode.frequency, ContactVector::Constant(1, shape),
                     shape > 0 ? mode.load_residue / shape : Complex(0)});
  }
  return {1, std::move(modes), model.loss()};
}

ContactSystem contact_system(const SystemParameters& parameters) {
  if (parameters.sectors) return build_contact_system(parameters);
  const FrictionSystem system = build_system(parameters);
  return {one_contact(system.base),
          one_contact(system.damper),
          {{system.contact_stiffness, system.slip_per_preload}},
          system.outputs};
}

}  // namespace

HarmonicSystem build_harmonic_system(const SystemParameters& parameters, int highest) {
  HarmonicSystem system;
  system.preload_growth = parameters.preload_growth;
  for (int h = 1; h <= highest; h += 2) {
    SystemParameters wave = parameters;
    wave.wave_number = h * parameters.wave_number % parameters.elements;
    wave.eta_low = h * parameters.eta_low;
    wave.eta_high = h * parameters.eta_high;
    if (h > 1) wave.force = 0;
    ContactSystem of_order = contact_system(wave);
    system.orders.push_back(h);
    system.base.push_back(std::move(of_order.base));
    system.damper.push_back(std::move(of_order.damper));
    if (h > 1) continue;
    system.contacts = std::move(of_order.contacts);
    system.outputs = std::move(of_order.outputs);
  }
  return system;
}

}  // namespace arcslip
