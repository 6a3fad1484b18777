// Any structure of N equal sectors, or without symmetry: base and damper from the matrices of one sector
// each.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "arcslip/assembly/sector_pair.hpp"
#include "arcslip/results/results.hpp"
#include "cases/sector_part.hpp"
#include "cases/structure_kind.hpp"
#include "cases/system_section.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

struct SectorSettings : FrictionSettings {
  SectorSettings() {
    has_damping_kind = false;
    elements = 1;
    wave_number = 0;
  }

  std::shared_ptr<const SectorPair> sectors = {};
  std::vector<double> contact_stiffness = {};  ///< of each contact
  std::vector<double> limit_per_preload = {};
  SectorPath path = SectorPath::reduced;
  double reduction_tolerance = 1e-10;
};

using SectorKey = Key<SectorSettings>;

void read_reduction_window(SectorSettings& settings, const TomlSection& section) {
  std::tie(settings.eta_low, settings.eta_high) =
      section.rising("reduction_window",
                     "two numbers, 0 < low < high: the eta for which the modes of the sectors are found");
}

/// Reads a number for all contacts, or a list with one for each.
SectorKey::Reader for_contacts(const std::string& name, std::vector<double> SectorSettings::*member,
                               const NumberRule& rule = positive()) {
  return [=](SectorSettings& settings, const TomlSection& section) {
    settings.*member =
        numbers_of_contacts(section, name, rule, settings.sectors->base().sector.contacts.size());
  };
}

/// The one among the waves from -N/2 to N/2 as which so many waves move.
Index alias(Index waves, Index sectors) {
  const Index rest = ((waves % sectors) + sectors) % sectors;
  return 2 * rest > sectors ? rest - sectors : rest;
}

void check_wave(const SectorSettings& settings, const TomlSection& section) {
  const Index most = settings.elements / 2;
  const Index n = settings.wave_number;
  if (std::abs(n) > most)
    section.fail(
        "wave_number",
        fmt::format("expected an integer >= -sectors/2 = {} and <= sectors/2 = {}, got {}: on {} sectors {} "
                    "waves move as {}",
                    -most, most, n, settings.elements, n, alias(n, settings.elements)));
}

bool has_order(const SectorSettings& settings) { return settings.rotation.per_eta != 0; }

/// The order m of a load that stands still: eta = m speed on -m waves of the sectors, which pass it.
void read_engine_order(SectorSettings& settings, const TomlSection& section) {
  const Index m = section.integer("engine_order", within(1, 1e6, " >= 1 and <= 1e6"));
  settings.rotation.per_eta = 1 / static_cast<double>(m);
  settings.wave_number = alias(-m, settings.elements);
}

ordered_json engine_order(const SectorSettings& settings) {
  if (!has_order(settings)) return nullptr;
  return std::llround(1 / settings.rotation.per_eta);
}

/// Refuses speeds that nothing feels, and responses that are not calculated of what turns.
void check_rotation(const TomlSection& section, const SectorSettings& settings) {
  const bool turns = !settings.rotation.is_none() || settings.use->parameter == "speed";
  if (!turns) return;
  const char* key = has_order(settings) ? "engine_order" : "speed";
  const bool feels = settings.sectors->feels_rotation();
  if (!feels && !has_order(settings))
    section.fail("speed", "nothing feels it: expected `gyroscopic` or `stiffness_speed2` of a sector");
  if (feels && settings.use->is_free)
    section.fail(key, "only of forced and one-way responses where sectors feel rotation");
}

void check_path(const SectorSettings& settings, const TomlSection& section) {
  const bool is_free = settings.use != nullptr && settings.use->is_free;
  if (settings.path == SectorPath::full && is_free)
    section.fail(
        "path",
        R"(expected "reduced" for nonlinear modes and limit cycles, which begin from modes, got "full")");
}

/// What is held to the modes and contacts that there are.
void check_use(const TomlSection& section, const SectorSettings& settings) {
  try {
    settings.sectors->check(settings.wave_number, settings.elements);
  } catch (const SectorError& error) {
    if (!section.has("wave_number")) section.fail("base", error.what());
    section.fail("wave_number", fmt::format("at {}: {}", settings.wave_number, error.what()));
  }
}

bool is_cyclic(const SectorSettings& settings, const TomlSection& /*section*/) {
  const SectorPair* pair = settings.sectors.get();
  return pair != nullptr && (pair->base().sector.has_boundaries() ||
                             (pair->damper() != nullptr && pair->damper()->sector.has_boundaries()));
}

bool needs_wave(const SectorSettings& settings, const TomlSection& section) {
  return is_cyclic(settings, section) && !section.has("engine_order");
}

/// Sectors, their wave and rotation, and the contacts' stiffness.
std::vector<SectorKey> first_keys() {
  return {
      SectorKey::special("model", "\"sector\"", "any structure, or one of N equal sectors", {},
                         otherwise("required"), unlisted),
      SectorKey("sectors", &SectorSettings::elements, within(1, 1e9, " >= 1 and <= 1e9"), "N",
                needed("required beside `left` and `right`; without them 1", is_cyclic)),
      SectorKey::special(
          "engine_order", "integer >= 1 and <= 1e6",
          "m of a load that stands still: the speed is eta/m and the wave -m, of sectors numbered "
          "along the rotation; `parameter` may be `speed`",
          read_engine_order, otherwise("none"), resolved(engine_order)),
      SectorKey("wave_number", &SectorSettings::wave_number, any_number(),
                "n from -sectors/2 to sectors/2: as many nodal diameters, which run with the numbers of the "
                "sectors or, "
                "below 0, against them",
                only("not beside engine_order, which tells the wave",
                     [](const SectorSettings& settings, const TomlSection&) { return !has_order(settings); }),
                needed("required beside `left` and `right`; without them 0", needs_wave), then(check_wave)),
      SectorKey(
          "speed", [](auto& settings) -> auto& { return settings.rotation.fixed; }, any_number(),
          "of rotation, revolutions in the unit of time of eta, above 0 along the numbers of the sectors",
          only("not beside engine_order, with which it follows eta",
               [](const SectorSettings& settings, const TomlSection&) { return !has_order(settings); }),
          parameter("speed"), otherwise("0"), resolved([](const SectorSettings& settings) {
            return has_order(settings) ? ordered_json() : ordered_json(settings.rotation.fixed);
          })),
      SectorKey("preload_speed2", &SectorSettings::preload_speed2, any_number(),
                "P_2 of the preload P + P_2 speed^2; added to that of preload_growth",
                only("only beside engine_order, as the preload at one speed is `preload`",
                     [](const SectorSettings& settings, const TomlSection&) { return has_order(settings); }),
                otherwise("0"), resolved([](const SectorSettings& settings) {
                  return has_order(settings) ? ordered_json(settings.preload_speed2) : ordered_json();
                })),
      SectorKey::special("contact_stiffness", "number or list",
                         "k of the contact of a sector; of several contacts that of all, or a list, in which "
                         "0 is a place for elements where nothing rubs",
                         for_contacts("contact_stiffness", &SectorSettings::contact_stiffness, at_least(0)),
                         required, parameter("K_FD"))};
}

const KeyTable<SectorSettings>& sector_keys() {
  const auto of = [](const SectorPart* part) -> ordered_json {
    if (part == nullptr) return nullptr;
    return {{"damping_kind", to_string(part->damping_kind)},
            {"fingerprint", fmt::format("{:016x}", part->fingerprint)}};
  };
  const auto base = [=](const SectorSettings& settings) {
    return of(settings.sectors ? &settings.sectors->base() : nullptr);
  };
  const auto damper = [=](const SectorSettings& settings) {
    return of(settings.sectors ? settings.sectors->damper() : nullptr);
  };
  const auto window = [](const SectorSettings& settings) {
    return ordered_json{settings.eta_low, settings.eta_high};
  };
  const auto has_no_range = [](const SectorSettings& settings, const TomlSection&) {
    return !(settings.eta_low > 0);
  };
  static const KeyTable<SectorSettings> keys{
      first_keys(),
      keys_of<SectorSettings>(shared_keys()),
      {SectorKey::special("limit_per_preload", "number or list",
                          "L: a contact slips where its force is L P, S = L P/k",
                          for_contacts("limit_per_preload", &SectorSettings::limit_per_preload),
                          resolved([](const SectorSettings&) { return 1.0; })),
       SectorKey("force", &SectorSettings::force, positive(), "factor of the load", parameter("F")),
       preload_growth_key(), units_key(),
       SectorKey::choice("path", &SectorSettings::path,
                         {{"reduced", SectorPath::reduced}, {"full", SectorPath::full}},
                         "the response by modes, or by a sparse LU factorisation at each eta", "", unlisted,
                         then(check_path)),
       SectorKey("reduction_tolerance", &SectorSettings::reduction_tolerance,
                 within(1e-14, 1e-2, " >= 1e-14 and <= 0.01"),
                 "relative change of the response at which modes are no longer added", unlisted),
       SectorKey::special(
           "reduction_window", "two numbers",
           "the eta for which the modes serve or, with `path = \"full\"`, are found as resonances",
           read_reduction_window,
           needed("the range of `[branch]` or `[study]`; required of limit cycles", has_no_range),
           resolved(window)),
       SectorKey::special("base", "table", "the base's sector", {}, otherwise("required"), unlisted,
                          resolved(base)),
       SectorKey::special("damper", "table", "the damper's", {}, otherwise("none: the contact is to ground"),
                          unlisted, resolved(damper))}};
  return keys;
}

std::shared_ptr<const Structures> load_sectors(const TomlDocument& document) {
  const TomlSection section(document, "system");
  section.allow_only(sector_keys().names());
  section.require("base", "a table with the matrices of the base's sector");
  SectorSettings settings;
  for (const char* key : {"reduction_tolerance", "path"}) sector_keys().read(key, settings, section);
  std::optional<SectorPart> damper;
  if (section.has("damper")) damper = read_part(document, "system.damper", settings.path);
  SectorPart base = read_part(document, "system.base", settings.path);
  const std::size_t contacts = base.sector.contacts.size();
  if (damper && damper->sector.contacts.size() != contacts)
    TomlSection(document, "system.damper")
        .fail("contact", fmt::format("expected {} dofs, as many as of the base, got {}", contacts,
                                     damper->sector.contacts.size()));
  return std::make_shared<const SectorPair>(std::move(base), std::move(damper), settings.reduction_tolerance,
                                            settings.path);
}

void read_sector(const StructureKind::Source& source, ProblemRequest& problem) {
  SectorSettings settings;
  settings.use = &source.use;
  settings.structures = source.use.structures;
  settings.sectors = std::static_pointer_cast<const SectorPair>(settings.structures);
  settings.eta_low = source.use.eta_low;
  settings.eta_high = source.use.eta_high;
  const SectorPart& base = settings.sectors->base();
  const SectorPart* damper = settings.sectors->damper();
  settings.fixed_damper = damper == nullptr;
  settings.is_base_damped = base.is_damped();
  settings.is_damper_damped = damper != nullptr && damper->is_damped();
  if (settings.is_base_damped) settings.base_damping = 0;
  if (settings.is_damper_damped) settings.damper_damping = 0;
  const std::size_t count = base.sector.contacts.size();
  settings.limit_per_preload.assign(count, 1);
  sector_keys().read(settings, source.section);
  const std::vector<double>& k = settings.contact_stiffness;
  settings.interface_stiffness = k.front() * static_cast<double>(settings.elements);
  settings.contacts = sector_contacts(k, settings.limit_per_preload);
  check_use(source.section, settings);
  check_rotation(source.section, settings);
  settings.preload_growth += settings.preload_speed2 * settings.rotation.per_eta * settings.rotation.per_eta;
  settings.speed_low = source.use.speed_low;
  settings.speed_high = source.use.speed_high;
  take(std::move(settings), problem);
}

ordered_json sector_resolved(const ProblemRequest& problem, const ordered_json& /*given*/) {
  SectorSettings settings;
  static_cast<SystemParameters&>(settings) = problem.system;
  settings.sectors = std::static_pointer_cast<const SectorPair>(settings.structures);
  settings.harmonics_tolerance = problem.harmonics_tolerance;
  settings.preload_growth -= settings.preload_speed2 * settings.rotation.per_eta * settings.rotation.per_eta;
  settings.path = settings.sectors->path();
  settings.reduction_tolerance = settings.sectors->tolerance();
  return sector_keys().values(settings);
}

/// Which way a wave runs where it matters.
std::string rotation_in_words(const SystemParameters& system) {
  const Rotation& rotation = system.rotation;
  const bool stands = 2 * system.wave_number % system.elements == 0;
  const bool is_forward = (system.wave_number > 0) == (rotation.fixed >= 0);
  if (rotation.per_eta != 0)
    return fmt::format(", engine order {}{}", std::llround(1 / rotation.per_eta),
                       stands                   ? ""
                       : system.wave_number < 0 ? " (backward)"
                                                : " (forward)");
  if (rotation.fixed == 0) return "";
  return fmt::format(", speed {:g}{}", rotation.fixed,
                     stands       ? ""
                     : is_forward ? " (forward)"
                                  : " (backward)");
}

std::string sector_in_words(const ProblemRequest& problem) {
  const SystemParameters& system = problem.system;
  const auto& sectors = static_cast<const SectorPair&>(*system.structures);
  const bool is_cyclic = system.elements > 1 || sectors.base().sector.has_boundaries();
  std::string text = is_cyclic ? fmt::format("sector, n = {}, N = {}", system.wave_number, system.elements)
                               : std::string("structure without symmetry");
  text += rotation_in_words(system);
  text += fmt::format(", {}, zeta = {:g} (base, {})", contacts_in_words(system), system.base_damping,
                      to_string(sectors.base().damping_kind));
  if (sectors.damper() != nullptr)
    text +=
        fmt::format(", {:g} (damper, {})", system.damper_damping, to_string(sectors.damper()->damping_kind));
  return text + "\n  " + describe_modes(system);
}

}  // namespace

StructureKind sector_structure() {
  return {.name = "sector",
          .title = "sectors",
          .models = {"sector"},
          .keys = [] { return sector_keys().words(); },
          .sections = {{"system.base", "and of `[system.damper]`", [] { return part_keys(true).words(); }}},
          .load = load_sectors,
          .read = read_sector,
          .resolved = sector_resolved,
          .describe = sector_in_words,
          .frequency_unit = "Hz"};
}

}  // namespace arcslip
