#include "arcslip/assembly/influence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "arcslip/assembly/structures.hpp"

namespace arcslip {
namespace {

/// Of 0 .. N - 1.
Index within_ring(Index wave, Index nodes) { return (wave % nodes + nodes) % nodes; }

/// e^{-jka}, exact where it is 1, -1, j or -j, and of opposite neighbours exactly conjugate.
Complex phase_of_neighbour(Index neighbour, Index wave, Index nodes) {
  const Index turns = within_ring(neighbour * wave, nodes);
  if (2 * turns > nodes) return std::conj(phase_of_neighbour(-neighbour, wave, nodes));
  constexpr Complex quarters[] = {{1, 0}, {0, -1}, {-1, 0}};
  if (4 * turns % nodes == 0) return quarters[4 * turns / nodes];
  return std::polar(1.0, -two_pi * static_cast<double>(turns) / static_cast<double>(nodes));
}

/// The modes with what acts on them.
template <class Mode>
std::vector<Mode> influenced(std::vector<Mode> modes, const SystemParameters& parameters) {
  const Influence& influence = *parameters.influence;
  const double rate = structures_of(parameters).circular_frequency();
  const auto acts_on = [&](std::size_t k) {
    const auto& chosen = influence.modes;
    return chosen.empty() || std::count(chosen.begin(), chosen.end(), static_cast<Index>(k)) > 0;
  };
  for (std::size_t k = 0; k < modes.size(); ++k) {
    if (!acts_on(k)) continue;
    modes[k].influence = parameters.influence_factor *
                         influence.on(modes[k].frequency, parameters.wave_number, parameters.elements, rate);
  }
  return modes;
}

ContactModes influenced(const ContactModes& structure, const SystemParameters& parameters) {
  if (structure.is_solved())
    throw std::invalid_argument(
        "influence coefficients act on modes, and the base is solved for without them");
  return {structure.contacts(), influenced(structure.modes(), parameters), structure.loss()};
}

template <class System>
void add_to_outputs(const SystemParameters& parameters, System& wave) {
  for (ContactOutput& output : wave.outputs) {
    if (output.on_base) output.modes = influenced(output.modes, parameters);
  }
}

}  // namespace

bool Influence::is_complex() const {
  return std::any_of(coefficients.begin(), coefficients.end(),
                     [](const Coefficient& one) { return one.value.imag() != 0; });
}

Complex Influence::coefficient(Index wave, Index nodes) const {
  const Index forward = within_ring(wave, nodes);
  const Index least = std::min(forward, nodes - forward);
  const bool turns = forward != least && !is_complex();  // exactly the conjugate then
  Complex sum = 0;
  for (const Coefficient& one : coefficients)
    sum += one.value * phase_of_neighbour(one.neighbour, turns ? least : forward, nodes);
  return turns ? std::conj(sum) : sum;
}

double Influence::zeta(Index wave, Index nodes) const {
  const Index forward = within_ring(wave, nodes);
  const auto find = [&](Index wanted, bool both) -> std::optional<double> {
    for (const WaveDamping& one : damping) {
      if ((!both || one.wave >= 0) && within_ring(one.wave, nodes) == wanted) return one.zeta;
    }
    return std::nullopt;
  };
  if (const auto own = find(forward, false)) return *own;
  return find(within_ring(-wave, nodes), true).value_or(0);
}

Influence Influence::other_way() const {
  Influence other = *this;
  for (Coefficient& one : other.coefficients) one.neighbour *= -1;
  other.damping.clear();
  for (const auto& [wave, ratio] : damping) {
    other.damping.push_back({-wave, ratio});
    const auto is_opposite = [wave = wave](const WaveDamping& one) { return one.wave == -wave; };
    if (wave > 0 && std::none_of(damping.begin(), damping.end(), is_opposite))
      other.damping.push_back({wave, ratio});
  }
  return other;
}

ModeInfluence Influence::on(double frequency, Index wave, Index nodes, double rate) const {
  const double own = zeta(wave, nodes);
  const double back = zeta(-wave, nodes);
  const double square = frequency * frequency;
  ModeInfluence found{coefficient(wave, nodes) / (rate * rate), (own + back) * frequency};
  if (found.stiffness != 0.0 && !(frequency > 0))
    throw std::invalid_argument(fmt::format(
        "influence coefficients push the base in {} waves, as a body that nothing holds: expected "
        "a sum of them that is 0 there",
        wave));
  found.stiffness -= Complex(0, (own - back) * square);
  return found;
}

void add_influence(const SystemParameters& parameters, ContactSystem& wave) {
  if (!parameters.influence) return;
  wave.base = influenced(wave.base, parameters);
  add_to_outputs(parameters, wave);
}

void add_influence(const SystemParameters& parameters, FrictionSystem& wave) {
  if (!parameters.influence) return;
  wave.base = ModalModel(influenced(wave.base.modes(), parameters), wave.base.loss());
  add_to_outputs(parameters, wave);
}

}  // namespace arcslip
