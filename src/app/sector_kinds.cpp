#include "app/sector_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/sectors/chain_sector.hpp"
#include "arcslip/sectors/lowest_frequency.hpp"

namespace arcslip {
namespace {

SectorCase shared(const PairOptions& options, Index sectors) {
  if (options.wave_number > sectors / 2) {
    throw SectorKindError(fmt::format("--wave-number: expected at most half of the {} sectors, got {}",
                                      sectors, options.wave_number));
  }
  SectorCase result;
  result.wave_number = options.wave_number;
  result.sectors = sectors;
  result.force = options.force;
  result.preload = options.preload;
  result.base_damping.zeta = options.base_damping;
  result.damper_damping.zeta = options.damper_damping;
  return result;
}

/// Whether the base moves as a rigid body with this wave number. Elements keep a little stiffness against it.
bool moves_freely(const SectorCase& result, double lowest) {
  if (result.wave_number > 1) return false;
  return lowest < 0.02 * lowest_frequency(result.base, 2, std::max<Index>(result.sectors, 4));
}

/// Looks a tenth beyond the frequencies of the base alone and of the pair without slip.
void set_window(const PairOptions& options, SectorCase& result) {
  const Index n = result.wave_number;
  const double alone = lowest_frequency(result.base, n, result.sectors);
  const double held =
      lowest_frequency(joined(result.base, result.damper, result.contact_stiffness), n, result.sectors);
  const bool given = options.eta_from && options.eta_to;
  if (!given && moves_freely(result, alone)) {
    throw SectorKindError(fmt::format("the base moves freely at n = {}: --from and --to are needed", n));
  }
  const auto rounded = [](double x) { return std::stod(fmt::format("{:.3g}", x)); };
  result.eta_from = options.eta_from.value_or(rounded(0.9 * (held > 0 ? std::min(alone, held) : alone)));
  result.eta_to = options.eta_to.value_or(rounded(1.1 * std::max(alone, held)));
  if (!(result.eta_from < result.eta_to)) {
    throw SectorKindError(
        fmt::format("--from: expected less than --to, {}, got {}", result.eta_to, result.eta_from));
  }
  result.notes += fmt::format(
      "# The base alone first resonates at eta = {:.10g}, with the damper held to it at {:.10g}{}.\n", alone,
      held, result.speed > 0 ? ", at rest" : "");
}

/// Keeps `count` of the contacts, equally spaced.
void thin_out(std::vector<Index>& contacts, Index count, const char* elements) {
  const Index all = std::ssize(contacts);
  if (count > all || all % count != 0) {
    throw SectorKindError(
        fmt::format("--contacts: expected a divisor of the {} {}, got {}", all, elements, count));
  }
  for (Index i = 0; i < count; ++i) {
    contacts[static_cast<std::size_t>(i)] = contacts[static_cast<std::size_t>(i * (all / count))];
  }
  contacts.resize(static_cast<std::size_t>(count));
}

/// Travelling force of unit amplitude in all on the base's outputs, which are equally spaced.
void load_outputs(SectorCase& result) {
  const double propagation =
      two_pi * static_cast<double>(result.wave_number) / static_cast<double>(result.sectors);
  const std::vector<Index>& dofs = result.base.outputs;
  const auto count = static_cast<double>(dofs.size());
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    result.base.load(dofs[i]) = std::polar(1 / count, -propagation * static_cast<double>(i) / count);
  }
}

std::string describe(const SolidRing& ring) {
  return fmt::format("a ring of radius {}, width {} and height {} m", ring.radius, ring.width, ring.height);
}

/// The base is there; adds its load, the damper and the rest.
SectorCase with_damper(const PairOptions& options, const SolidOptions& solid, const std::string& base,
                       SectorCase result) {
  const SolidRing& ring = solid.damper;
  load_outputs(result);
  thin_out(result.base.contacts, solid.contacts, "elements of the base's contact line");
  result.damper = ring_sector(ring);
  result.speed = solid.speed;
  thin_out(result.damper.contacts, solid.contacts, "elements of the damper");
  const double shear = ring.youngs_modulus / (2 * (1 + ring.poisson_ratio));
  const double spacing = two_pi * ring.radius / static_cast<double>(result.sectors * solid.contacts);
  result.contact_stiffness =
      solid.contact_stiffness.value_or(shear * ring.width * spacing / (0.5 * ring.height));
  result.si = true;
  result.notes += fmt::format(
      "# {},\n# and its damper, {}: {} and {} dofs in one of {} sectors.\n# SI units: eta in Hz, force in N "
      "on a sector, preload P = mu p, the largest friction force of one contact, in N.\n",
      base, describe(ring), result.base.mass.rows(), result.damper.mass.rows(), result.sectors);
  set_window(options, result);
  return result;
}

}  // namespace

SectorCase paper_case(const PairOptions& options, const SystemParameters& system, Index per_sector) {
  if (system.elements % per_sector != 0) {
    throw SectorKindError(fmt::format("--elements-per-sector: expected a divisor of the {} elements, got {}",
                                      system.elements, per_sector));
  }
  SectorCase result = shared(options, system.elements / per_sector);
  const bool rods = system.model == StructureModel::rods;
  const auto element = rods ? rod_element : beam_element;
  const Index n = options.wave_number;
  const Index count = system.elements;
  const double stiffness = system.stiffness_ratio();
  result.base = chain_sector(element(system.mass_ratio, stiffness, n, count), n, count, per_sector);
  result.base.load *= stiffness;
  result.damper = chain_sector(element(1, 1, n, count), n, count, per_sector);
  result.base_damping.reference = system.frequency_ratio;
  result.damper_damping.reference = 1;
  result.contact_stiffness = system.interface_stiffness / static_cast<double>(count);
  result.limit_per_preload = stiffness / static_cast<double>(count);
  result.title = rods ? "Two rods as sectors" : "Two beams as sectors";
  result.notes = fmt::format(
      "# Two {} of {} elements, {} to a sector, nondimensional: M* = {}, gamma = {}, K_FD = {:.10g}.\n",
      to_string(system.model), count, per_sector, system.mass_ratio, system.frequency_ratio,
      system.interface_stiffness);
  set_window(options, result);
  return result;
}

SectorCase plate_case(const PairOptions& options, const AnnularPlate& plate, const SolidOptions& solid) {
  if (!(plate.inner_radius < plate.outer_radius)) {
    throw SectorKindError(fmt::format("--inner-radius: expected less than --outer-radius, {}, got {}",
                                      plate.outer_radius, plate.inner_radius));
  }
  constexpr Index most = 250'000;
  if (plate.radial_elements > most / plate.angular_elements) {
    throw SectorKindError(
        fmt::format("--radial-elements times --angular-elements: expected at most {}", most));
  }
  if (plate.outer_edge != EdgeSupport::free) {
    throw SectorKindError("--outer-edge: expected free, since the damper rubs there");
  }
  SectorCase result = shared(options, plate.sectors);
  result.base = annular_plate_sector(plate);
  result.title = "Annular plate with a ring damper at its rim";
  const std::string base = fmt::format("An annular plate of radii {} and {} m, thickness {} m",
                                       plate.inner_radius, plate.outer_radius, plate.thickness);
  return with_damper(options, solid, base, std::move(result));
}

SectorCase ring_case(const PairOptions& options, const SolidRing& base, const SolidOptions& solid) {
  SectorCase result = shared(options, base.sectors);
  result.base = ring_sector(base);
  result.title = "Ring with a ring damper";
  return with_damper(options, solid, "Base: " + describe(base), std::move(result));
}

}  // namespace arcslip
