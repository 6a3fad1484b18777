#include "arcslip/assembly/harmonic_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "arcslip/assembly/structures.hpp"
#include "arcslip/assembly/system.hpp"
#include "arcslip/assembly/whole_ring.hpp"
#include "arcslip/elements/idle.hpp"
#include "arcslip/motion/swing.hpp"

namespace arcslip {
namespace {

/// Of modes that deform a structure, the static compliance of one of its contact dofs.
double static_compliance(const ContactModes& structure, Index dof) {
  double sum = 0;
  for (const ContactMode& mode : structure.modes()) {
    if (!mode.is_rigid()) sum += std::norm(mode.shape(dof)) / (mode.frequency * mode.frequency);
  }
  return sum;
}

}  // namespace

std::string HarmonicSystem::name(Index order) const {
  const int h = orders[static_cast<std::size_t>(order)];
  const int common = std::gcd(h, periods());
  return common < periods() ? fmt::format("{}/{}", h / common, periods() / common)
                            : fmt::format("{}", h / common);
}

ContactSystem build_wave(const SystemParameters& parameters) {
  ContactSystem wave = structures_of(parameters).wave(parameters);
  add_influence(parameters, wave);
  return wave;
}

ContactSystem turned(ContactSystem system, const Complex& turn) {
  if (turn == 1.0) return system;
  system.base = system.base.turned(turn);
  for (ContactOutput& output : system.outputs) output.modes = output.modes.turned(turn);
  return system;
}

ContactSystem build_order(const SystemParameters& parameters, int h) {
  return turned(build_wave(in_order(parameters, h)), parameters.load_turn(h));
}

void check(const HarmonicSystem& system) {
  const auto refuse = [](const char* why) {
    throw std::invalid_argument(std::string("HarmonicSystem: ") + why);
  };
  const std::size_t count = system.orders.size();
  if (count < 1 || count > most_harmonics || system.base.size() != count || system.damper.size() != count)
    refuse("base and damper must be given in every harmonic");
  const Index contacts = std::ssize(system.contacts);
  for (std::size_t a = 0; a < count; ++a) {
    if (system.base[a].contacts() != contacts || system.damper[a].contacts() != contacts)
      refuse("base, damper and contacts must be as many");
  }
  for (const Coordinate& one : system.others) {
    if (!one.element) continue;
    if (one.element->coordinates() * std::ssize(system.orders) > most_harmonics)
      refuse("too many harmonics of an element");
    if (!all_odd(system.orders) && !one.element->takes_any_orders())
      refuse("an element takes odd harmonics alone");
    if (!one.element->is_odd() && place_of_mean(system.orders) == std::ssize(system.orders))
      refuse("an element that is not odd needs the harmonic 0");
  }
  for (const SectorContact& contact : system.contacts) {
    const bool rubs = contact.stiffness > 0 && contact.slip_per_preload > 0;
    if (!rubs && !(contact.stiffness == 0 && contact.slip_per_preload == never_slips))
      refuse("stiffness and slip threshold must be positive, or 0 and `never_slips` where nothing rubs");
  }
}

double usual_stiffness(const HarmonicSystem& system, const Coordinate& coordinate) {
  const double compliance = std::abs(coordinate.base) * static_compliance(system.base[0], coordinate.dof) +
                            std::abs(coordinate.damper) * static_compliance(system.damper[0], coordinate.dof);
  return compliance > 0 ? 1 / compliance : 1;
}

HarmonicSystem one_harmonic(ContactSystem system) {
  return {{1}, {std::move(system.base)}, {std::move(system.damper)}, std::move(system.contacts),
          0,   std::move(system.outputs)};
}

HarmonicSystem at_value(const HarmonicSystem& system, double value) {
  const SystemVariation variation = system.varied.value().at(value).here;
  HarmonicSystem other = system;
  other.varied.reset();
  for (ContactModes& base : other.base) base = base.varied(variation.base);
  for (ContactModes& damper : other.damper) damper = damper.varied(variation.damper);
  for (ContactOutput& output : other.outputs)
    output.modes = output.modes.varied(output.on_base ? variation.base : variation.damper);
  for (std::vector<ContactOutput>& of_order : other.outputs_of_orders)
    for (ContactOutput& output : of_order)
      output.modes = output.modes.varied(output.on_base ? variation.base : variation.damper);
  other.preload_growth = variation.preload_growth;
  other.base_loss_per_zeta.viscous *= variation.base_viscous;
  for (Index i = 0; i < std::ssize(other.contacts); ++i) {
    if (!system.varied->concerns(i)) continue;
    SectorContact& contact = other.contacts[static_cast<std::size_t>(i)];
    contact.stiffness *= variation.contact_stiffness;
    contact.slip_per_preload *= variation.slip_per_preload;
  }
  for (Coordinate& one : other.others) {
    if (one.follows_base) one.factor *= variation.others;
    if (one.varied) one.element = one.varied(value);
    one.varied = {};
  }
  return other;
}

SystemParameters in_order(const SystemParameters& parameters, int h) {
  SystemParameters wave = parameters;
  const int p = parameters.periods();
  const Complex share = h % p == 0 ? parameters.excitation.share(h / p) : 0;
  wave.force *= share.imag() == 0 ? share.real() : std::abs(share);
  if (h == p) return wave;
  wave.wave_number = h * parameters.first_wave() % parameters.elements;
  if (parameters.rotation.per_eta != 0) {
    if (h == 0 && structures_of(parameters).feels_rotation())
      throw std::invalid_argument(
          "the mean is not balanced beside engine_order, whose speed changes the stiffness at rest");
    wave.rotation.per_eta *= static_cast<double>(p) / std::max(h, 1);
  }
  wave.eta_low = h * parameters.eta_low / p;
  wave.eta_high = std::max(h, 1) * parameters.eta_high / p;
  wave.tells_lag = false;
  return wave;
}

HarmonicSystem build_harmonic_system(const SystemParameters& parameters) {
  HarmonicSystem system;
  for (const int h : parameters.harmonics) {
    if (h == parameters.periods()) {
      system = one_harmonic(build_order(parameters, h));
      system.orders = {h};
      continue;
    }
    ContactSystem of_order = build_order(parameters, h);
    system.orders.push_back(h);
    system.base.push_back(std::move(of_order.base));
    system.damper.push_back(std::move(of_order.damper));
    system.contacts = std::move(of_order.contacts);
    system.outputs_of_orders.resize(system.orders.size());
    system.outputs_of_orders.back() = std::move(of_order.outputs);
  }
  system.preload_growth = parameters.preload_growth;
  system.one_way = parameters.one_way;
  const PairLosses losses = structures_of(parameters).losses(parameters);
  system.base_loss_per_zeta = losses.base_per_zeta;
  system.base_loss_fixed = losses.base_fixed;
  if (const WholeRing* whole = structures_of(parameters).whole()) {
    system.sectors = whole->sectors();
    system.wave_number = parameters.wave_number;
    system.equal_peak = whole->make().equal_peak;
    for (const int h : parameters.harmonics)
      system.landmarks.push_back(whole->landmarks(in_order(parameters, h)));
  }
  if (!parameters.varied.empty()) system.varied = system_parameter(parameters, parameters.varied);
  system.others =
      other_coordinates(parameters, [&](const Coordinate& one) { return usual_stiffness(system, one); });
  return system;
}

}  // namespace arcslip
