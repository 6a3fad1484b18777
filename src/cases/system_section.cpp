#include "cases/system_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "arcslip/assembly/sector_pair.hpp"
#include "arcslip/motion/odd_motion.hpp"
#include "cases/geometry_section.hpp"
#include "cases/sector_section.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

const std::vector<std::string> friction_keys = {
    "model",           "wave_number",  "elements",      "mass_ratio",
    "frequency_ratio", "slenderness",  "poisson_ratio", "interface_stiffness",
    "damping",         "force",        "preload",       "preload_growth",
    "cubic_stiffness", "fixed_damper", "harmonics",     "harmonics_tolerance"};
constexpr double default_poisson_ratio = 0.3;
constexpr double default_harmonics_tolerance = 1e-4;

NumberRule damping_rule() {
  return {[](double zeta) { return std::abs(zeta) < 1 && zeta != 0; }, " > -1 and < 1 that is not 0"};
}

double read_interface_stiffness(const TomlSection& section, StructureModel model) {
  const double poisson_ratio = section.number("poisson_ratio", poisson_rule(), default_poisson_ratio);
  if (model == StructureModel::rods) {
    if (section.has("slenderness"))
      section.fail("slenderness", "only for beams; rods take interface_stiffness");
    return section.number("interface_stiffness", positive());
  }
  if (section.has("slenderness") && section.has("interface_stiffness")) {
    section.fail("interface_stiffness", "expected this or slenderness, not both");
  }
  if (section.has("interface_stiffness")) return section.number("interface_stiffness", positive());
  return shear_interface_stiffness(section.number("slenderness", positive()), poisson_ratio);
}

/// What a damping ratio may be. That of a sector with damping of another kind may be 0.
NumberRule ratio_rule(bool may_be_negative, const SectorPart* part) {
  if (part == nullptr || !part->is_damped()) return may_be_negative ? damping_rule() : inside(0, 1);
  if (may_be_negative) return {[](double zeta) { return std::abs(zeta) < 1; }, " > -1 and < 1"};
  return {[](double zeta) { return zeta >= 0 && zeta < 1; }, " >= 0 and < 1"};
}

void read_damping(const TomlDocument& document, const TomlSection& section, bool passive,
                  SystemParameters& system) {
  const SectorPart* base_part = system.sectors ? &system.sectors->base() : nullptr;
  const SectorPart* damper_part = system.sectors ? system.sectors->damper() : nullptr;
  if (base_part != nullptr && base_part->is_damped()) system.base_damping = 0;
  if (damper_part != nullptr && damper_part->is_damped()) system.damper_damping = 0;
  if (!section.has("damping")) return;
  const toml::table* table = section.require("damping", "a table").as_table();
  if (table == nullptr) section.mismatch("damping", "a table { base = ..., damper = ... }");
  for (const auto& [key, node] : *table) {
    const std::string name = section.name_given("damping") + "." + std::string(key.str());
    if (key.str() == "kind" && !system.sectors) {
      const std::string kind = node.value<std::string>().value_or("");
      if (kind != "viscous" && kind != "structural")
        document.mismatch(node, name, R"("viscous" or "structural", for the base)");
      system.base_damping_kind = kind == "viscous" ? DampingKind::viscous : DampingKind::structural;
      continue;
    }
    const bool base = key.str() == "base";
    if (!base && key.str() != "damper")
      document.fail(&node, name,
                    system.sectors ? "unknown key; expected base or damper"
                                   : "unknown key; expected base, damper or kind");
    const NumberRule rule = ratio_rule(base && !passive, base ? base_part : damper_part);
    (base ? system.base_damping : system.damper_damping) = document.number({&node, name}, rule);
  }
}

/// What [geometry] stands for where it is given.
void read_groups(const TomlSection& section, const SystemUse& use, SystemParameters& system) {
  system.mass_ratio = section.number("mass_ratio", positive());
  system.frequency_ratio = section.number("frequency_ratio", positive());
  system.interface_stiffness = read_interface_stiffness(section, system.model);
  system.force = section.number("force", positive());
  if (use.parameter != "P" || section.has("preload")) system.preload = section.number("preload", positive());
}

/// Refuses numbers so extreme that what follows from them is beyond what a double holds.
void check_groups(const TomlDocument& document, const TomlSection& section, const SystemParameters& system) {
  const double per_preload = system.stiffness_ratio() / system.interface_stiffness;
  const std::pair<const char*, double> groups[] = {
      {"K* = gamma^2 M*", system.stiffness_ratio()},
      {"K_FD", system.interface_stiffness},
      {"k = K_FD/N", system.interface_stiffness / static_cast<double>(system.elements)},
      {"F K*", system.force * system.stiffness_ratio()},
      {"S = P K*/K_FD", system.preload * per_preload},
      {"S^2, to which energies are related,", std::pow(system.preload * per_preload, 2)}};
  for (const auto& [name, value] : groups) {
    if (std::isnormal(value)) continue;
    document.fail(
        section.table(), "system",
        fmt::format("expected numbers that give a {} within the range of a double, got {:g}", name, value));
  }
}

void read_rings(const TomlDocument& document, const Replacements& replacements, const TomlSection& section,
                const SystemUse& use, ProblemRequest& problem) {
  SystemParameters& system = problem.system;
  system.model =
      section.text("model", {"rods", "beams"}) == "rods" ? StructureModel::rods : StructureModel::beams;
  constexpr Index most = 1'000'000'000;
  system.wave_number = section.integer("wave_number", 1, most, [] { return "an integer >= 1"; });
  system.elements = section.integer("elements", 2 * system.wave_number + 1, most, [&] {
    return fmt::format("an integer > 2 wave_number = {} and <= 1e9", 2 * system.wave_number);
  });
  if (has_geometry(document)) {
    read_geometry(document, replacements, section, use.parameter, problem);
  } else {
    read_groups(section, use, system);
    check_groups(document, section, system);
  }
  const NumberRule zero{[](double k) { return k == 0; }, " that is 0, as a study has it"};
  system.cubic_stiffness = section.number("cubic_stiffness", use.linear_passive ? zero : any_number(), 0);
  system.fixed_damper = section.boolean("fixed_damper", false);
}

/// The harmonics in which friction is balanced: up to a highest one, listed, or found while tracing.
void read_harmonics(const TomlSection& section, const SystemUse& use, ProblemRequest& problem) {
  constexpr int highest = 2 * most_harmonics - 1;
  const auto expected = [=] {
    return fmt::format(R"(an odd integer from 1 to {}, a list of them that begins with 1, or "auto")",
                       highest);
  };
  const auto fits = [](double h) { return h >= 1 && h <= highest && std::fmod(h, 2) == 1; };
  std::vector<int>& orders = problem.system.harmonics;
  problem.harmonics_tolerance.reset();
  if (section.has("harmonics")) {
    const toml::node& node = section.require("harmonics", "");
    if (node.value<std::string>() == "auto") {
      const NumberRule rule{[](double x) { return x >= 1e-9 && x <= 0.1; }, " >= 1e-9 and <= 0.1"};
      problem.harmonics_tolerance = section.number("harmonics_tolerance", rule, default_harmonics_tolerance);
    } else if (node.is_array()) {
      orders.clear();
      for (const double h : section.numbers("harmonics", {fits, " that is odd, from 1 to 255"}))
        orders.push_back(static_cast<int>(h));
      const bool ascending =
          std::adjacent_find(orders.begin(), orders.end(), std::greater_equal<>()) == orders.end();
      if (orders.empty() || orders.front() != 1 || !ascending)
        section.fail("harmonics", "expected a list that begins with 1 and ascends");
    } else {
      if (!node.is_integer() || !fits(static_cast<double>(*node.value<Index>())))
        section.mismatch("harmonics", expected());
      orders = odd_up_to(static_cast<int>(*node.value<Index>()));
    }
  }
  if (section.has("harmonics_tolerance") && !problem.harmonics_tolerance)
    section.fail("harmonics_tolerance", R"(only beside harmonics = "auto")");
  const bool several = orders.size() > 1 || problem.harmonics_tolerance;
  if (several && !use.balanced)
    section.fail("harmonics", "expected 1 for a study, limit cycles and one-way responses");
  if (several && problem.system.cubic_stiffness != 0)
    section.fail("harmonics", "expected 1 beside cubic_stiffness");
  check_waves(section, "harmonics", problem.system, orders);
}

void read_friction(const TomlDocument& document, const Replacements& replacements, const TomlSection& section,
                   const SystemUse& use, ProblemRequest& problem) {
  if (use.sectors) {
    if (has_geometry(document))
      document.fail(document.root().get("geometry"), "geometry", "only for rods and beams");
    read_sector_system(document, section, use, problem.system);
  } else {
    read_rings(document, replacements, section, use, problem);
  }
  read_damping(document, section, use.linear_passive, problem.system);
  problem.system.preload_growth = section.number("preload_growth", any_number(), 0);
  read_harmonics(section, use, problem);
}

void read_settings(const TomlSection& section, const SystemUse& use,
                   problems::LibraryModel::Values& settings) {
  for (const problems::Setting& setting : use.model->settings) {
    if (setting.name == use.parameter && section.has(setting.name))
      section.fail(setting.name,
                   "the continuation parameter has its values from [branch]; leave it out here");
    if (setting.is_integer) {
      settings.push_back(static_cast<double>(section.integer(
          setting.name, static_cast<Index>(setting.low), static_cast<Index>(setting.high),
          [&] { return fmt::format("an integer >= {:g} and <= {:g}", setting.low, setting.high); },
          static_cast<Index>(setting.value))));
    } else {
      settings.push_back(
          section.number(setting.name, parameter_rule(use.model, setting.name), setting.value));
    }
  }
}

}  // namespace

void check_waves(const TomlSection& section, const std::string& key, const SystemParameters& system,
                 const std::vector<int>& orders) {
  if (!system.sectors) return;
  for (const int h : orders) {
    const Index wave = h * system.wave_number % system.elements;
    try {
      system.sectors->check({wave, system.elements});
    } catch (const SectorError& error) {
      section.fail(key, fmt::format("harmonic {}, which travels as {} waves: {}", h, wave, error.what()));
    }
  }
}

std::vector<std::string> model_names() {
  std::vector<std::string> names = {"rods", "beams", "sector"};
  for (const problems::LibraryModel& model : problems::library()) names.push_back(model.name);
  return names;
}

std::vector<std::string> system_keys(const problems::LibraryModel* model) {
  if (model == nullptr) return friction_keys;
  std::vector<std::string> keys = {"model"};
  for (const problems::Setting& setting : model->settings) keys.push_back(setting.name);
  return keys;
}

std::vector<std::string> listed_keys(const TomlDocument& document, const problems::LibraryModel* model) {
  if (is_sector(document)) {
    std::vector<std::string> names = sector_keys();
    for (const char* key : {"model", "base", "damper", "reduction_tolerance", "path"}) std::erase(names, key);
    return names;
  }
  std::vector<std::string> names = system_keys(model);
  if (model != nullptr) std::erase(names, "model");
  if (model == nullptr && has_geometry(document)) {
    for (const std::string& key : geometry_keys()) names.push_back(key);
  }
  return names;
}

void check_keys(const TomlDocument& document, const problems::LibraryModel* model) {
  TomlSection(document, "system").allow_only(is_sector(document) ? sector_keys() : system_keys(model));
  if (model == nullptr && !is_sector(document)) check_geometry_keys(document);
}

std::string path_of(const std::string& key) {
  static const std::vector<std::string> of_geometry = geometry_keys();
  const bool is_physical = std::find(of_geometry.begin(), of_geometry.end(), key) != of_geometry.end();
  return (is_physical ? "geometry." : "system.") + key;
}

NumberRule poisson_rule() {
  return {[](double nu) { return nu > -1 && nu <= 0.5; }, " > -1 and <= 0.5"};
}

NumberRule parameter_rule(const problems::LibraryModel* model, const std::string& parameter) {
  if (model == nullptr) return parameter == "zeta_B" ? damping_rule() : positive();
  for (const problems::Setting& setting : model->settings) {
    if (setting.name != parameter) continue;
    constexpr double most = std::numeric_limits<double>::max();
    if (setting.low == -most && setting.high == most) return any_number();
    const auto holds = [low = setting.low, high = setting.high](double x) { return x >= low && x <= high; };
    if (setting.high == most) return {holds, fmt::format(" >= {:g}", setting.low)};
    return {holds, fmt::format(" >= {:g} and <= {:g}", setting.low, setting.high)};
  }
  return any_number();
}

void read_system(const TomlDocument& document, const Replacements& replacements, const SystemUse& use,
                 ProblemRequest& problem) {
  const TomlSection section(document, "system", &replacements);
  problem.model = use.model;
  if (use.model != nullptr) {
    if (has_geometry(document))
      document.fail(document.root().get("geometry"), "geometry", "only for systems with friction");
    read_settings(section, use, problem.settings);
  } else {
    read_friction(document, replacements, section, use, problem);
  }
}

void resolve_system(const ProblemRequest& problem, ordered_json& section) {
  const auto set = [&](const std::string& key, const ordered_json& value) {
    if (!section.contains(key)) section[key] = value;
  };
  if (problem.model != nullptr) {
    for (std::size_t i = 0; i < problem.settings.size(); ++i) {
      const problems::Setting& setting = problem.model->settings[i];
      if (setting.is_integer) {
        set(setting.name, static_cast<Index>(problem.settings[i]));
      } else {
        set(setting.name, problem.settings[i]);
      }
    }
    return;
  }
  const SystemParameters& system = problem.system;
  // One that for_each replaces may be anything.
  ordered_json damping = section.contains("damping") && section["damping"].is_object()
                             ? section["damping"]
                             : ordered_json::object();
  if (!damping.contains("base")) damping["base"] = system.base_damping;
  if (!damping.contains("damper")) damping["damper"] = system.damper_damping;
  if (!system.sectors && !damping.contains("kind")) damping["kind"] = to_string(system.base_damping_kind);
  section["damping"] = damping;
  set("harmonics", 1);
  if (problem.harmonics_tolerance) set("harmonics_tolerance", *problem.harmonics_tolerance);
  if (system.sectors) return resolve_sectors(system, section);
  if (section.contains("slenderness")) set("poisson_ratio", default_poisson_ratio);
  set("preload_growth", system.preload_growth);
  set("cubic_stiffness", system.cubic_stiffness);
  set("fixed_damper", system.fixed_damper);
}

}  // namespace arcslip
