#include "arcslip/assembly/resonances.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "arcslip/assembly/structures.hpp"
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

std::string undamped_resonance(const SystemParameters& system, double eta) {
  constexpr double near = 1e-6;       // of eta: where a branch stands still before it
  constexpr double undamped = 1e-12;  // damping ratio: rounding
  if (structures_of(system).whole() != nullptr) return {};
  const HarmonicSystem harmonics = build_harmonic_system(system);
  const Vector springs = contact_springs(harmonics.contacts);
  for (Index a = 1; a < std::ssize(harmonics.orders); ++a) {
    const auto i = static_cast<std::size_t>(a);
    const int h = harmonics.orders[i];
    if (h == 0) continue;
    const double place = harmonics.multiple(a) * eta;
    for (const JoinedMode& mode : joined_modes({&harmonics.base[i], &harmonics.damper[i]}, springs)) {
      const bool is_here = std::abs(mode.frequency - place) <= near * place;
      if (!is_here || std::abs(mode.damping) > undamped || !harmonics.base[i].at(place).free.isZero(0))
        continue;
      const Index waves = system.first_wave() * h % system.elements;
      const std::string wave = system.elements > 1
                                   ? fmt::format(", the wave {} of {} sectors,",
                                                 std::min(waves, system.elements - waves), system.elements)
                                   : "";
      return fmt::format(
          "the harmonic {}{} resonates without damping at eta = {:.10g} while contacts stick, so that its "
          "motion is not determined there",
          harmonics.name(a), wave, mode.frequency / harmonics.multiple(a));
    }
  }
  return {};
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
