#include "arcslip/assembly/resonances.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "arcslip/assembly/system.hpp"

namespace arcslip {

std::vector<Resonance> resonances(const ContactSystem& wave) {
  std::vector<Resonance> all;
  const auto add = [&](const char* part, const ContactModes& structure) {
    std::vector<Resonance> own;
    if (structure.turning_modes() != nullptr) {
      for (const JoinedMode& mode : joined_modes({&structure}, Vector::Zero(structure.contacts())))
        all.push_back({part, mode.frequency, mode.damping});
      return;
    }
    for (const ContactMode& mode : structure.modes()) {
      const double eta = std::sqrt(mode.influence.square(mode.frequency));
      const double losses = structure.loss().part(eta, mode.frequency) + mode.influence.part(eta).imag();
      own.push_back({part, eta, eta > 0 ? losses / (2 * eta * eta) : 0});
    }
    std::sort(own.begin(), own.end(), [](const auto& a, const auto& b) { return a.eta < b.eta; });
    all.insert(all.end(), own.begin(), own.end());
  };
  add("base", wave.base);
  add("damper", wave.damper);
  for (const JoinedMode& mode : joined_modes({&wave.base, &wave.damper}, contact_springs(wave.contacts)))
    all.push_back({"stuck", mode.frequency, mode.damping});
  return all;
}

std::vector<Resonance> resonances(const SystemParameters& system, const ContactSystem& wave) {
  const bool is_ring = system.structures == nullptr;
  std::vector<Resonance> own;
  std::map<std::string, int> counts;
  for (const Resonance& one : resonances(wave)) {
    const int most = one.part == "stuck" ? 2 : 1;
    if (is_ring && ++counts[one.part] > most) continue;
    own.push_back(one);
  }
  return own;
}

double locking_preload(const ContactSystem& wave, const std::vector<double>& etas) {
  const auto count = std::ssize(wave.contacts);
  const Vector springs = contact_springs(wave.contacts);
  double highest = 0;
  for (const double eta : etas) {
    ContactReceptance at = wave.base.at(eta);
    wave.damper.add(eta, at);
    ContactMatrix joined = at.compliance * springs.asDiagonal();
    joined.diagonal().array() += 1;
    invert(joined);
    const ContactVector relative = joined * at.free;
    for (Index i = 0; i < count; ++i) {
      const double slip = wave.contacts[static_cast<std::size_t>(i)].slip_per_preload;
      highest = std::max(highest, std::abs(relative(i)) / slip);
    }
  }
  return highest;
}

}  // namespace arcslip
