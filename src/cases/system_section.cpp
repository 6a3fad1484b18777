#include "cases/system_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "arcslip/motion/odd_motion.hpp"
#include "cases/element_section.hpp"
#include "cases/geometry_section.hpp"
#include "cases/sector_section.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;
using S = FrictionSettings;
using K = Key<S>;
using problems::LibraryModel;

constexpr double most_elements = 1e9;
constexpr double usual_harmonics_tolerance = 1e-4;

NumberRule damping_rule() {
  return {[](double zeta) { return std::abs(zeta) < 1 && zeta != 0; }, " > -1 and < 1 that is not 0"};
}

/// What a damping ratio may be. That of a sector with damping of another kind may be 0.
NumberRule ratio_rule(bool may_be_negative, const SectorPart* part) {
  if (part == nullptr || !part->is_damped()) return may_be_negative ? damping_rule() : inside(0, 1);
  if (may_be_negative) return {[](double zeta) { return std::abs(zeta) < 1; }, " > -1 and < 1"};
  return {[](double zeta) { return zeta >= 0 && zeta < 1; }, " >= 0 and < 1"};
}

constexpr const char* in_geometry = "not beside [geometry], which gives it";
bool without_geometry(const S& settings, const TomlSection& /*section*/) { return !settings.has_geometry; }
bool is_beam(const S& settings, const TomlSection& /*section*/) {
  return settings.model == StructureModel::beams;
}
bool needs_slenderness(const S& settings, const TomlSection& section) {
  return is_beam(settings, section) && !section.has("interface_stiffness");
}
bool needs_stiffness(const S& settings, const TomlSection& section) {
  return !is_beam(settings, section) && !settings.has_geometry;
}
NumberRule element_rule(const S& settings) {
  const Index least = 2 * settings.wave_number;
  return within(static_cast<double>(least + 1), most_elements,
                fmt::format(" > 2 wave_number = {} and <= 1e9", least));
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
                S& settings, ProblemRequest& problem) {
  settings.has_geometry = has_geometry(document);
  ring_keys().read(settings, section);
  if (settings.has_geometry) return read_geometry(document, replacements, section, settings, problem);
  if (settings.slenderness)
    settings.interface_stiffness = shear_interface_stiffness(*settings.slenderness, settings.poisson_ratio);
  check_groups(document, section, settings);
}

/// The harmonics in which friction is balanced: up to a highest one, listed, or found while tracing.
void read_orders(S& settings, const TomlSection& section) {
  constexpr int highest = 2 * most_harmonics - 1;
  const auto fits = [](double h) { return h >= 1 && h <= highest && std::fmod(h, 2) == 1; };
  const toml::node& node = section.require("harmonics", "");
  std::vector<int>& orders = settings.harmonics;
  if (node.value<std::string>() == "auto") {
    settings.harmonics_tolerance = usual_harmonics_tolerance;
  } else if (node.is_array()) {
    const std::vector<double> listed = section.numbers("harmonics", {fits, " that is odd, from 1 to 255"});
    orders.assign(listed.begin(), listed.end());
    if (orders.empty() || orders.front() != 1 ||
        !std::is_sorted(orders.begin(), orders.end(), std::less_equal<>()))
      section.fail("harmonics", "expected a list that begins with 1 and ascends");
  } else {
    if (!node.is_integer() || !fits(static_cast<double>(*node.value<Index>())))
      section.mismatch(
          "harmonics",
          fmt::format(R"(an odd integer from 1 to {}, a list of them that begins with 1, or "auto")",
                      highest));
    orders = odd_up_to(static_cast<int>(*node.value<Index>()));
  }
}

/// Refuses sectors that cannot travel as the waves of the harmonics.
void check_waves(const TomlSection& section, const SystemParameters& system) {
  if (!system.sectors) return;
  for (const int h : system.harmonics) {
    const Index wave = h * system.wave_number % system.elements;
    try {
      system.sectors->check({wave, system.elements});
    } catch (const SectorError& error) {
      section.fail("harmonics",
                   fmt::format("harmonic {}, which travels as {} waves: {}", h, wave, error.what()));
    }
  }
}

void read_friction(const TomlDocument& document, const Replacements& replacements, const TomlSection& section,
                   const SystemUse& use, ProblemRequest& problem) {
  S settings;
  settings.use = &use;
  if (use.sectors) {
    if (has_geometry(document))
      document.fail(document.root().get("geometry"), "geometry", "only for rods and beams");
    read_sector_system(section, settings);
  } else {
    read_rings(document, replacements, section, settings, problem);
  }
  check_waves(section, settings);
  read_elements(document, settings);
  problem.harmonics_tolerance = settings.harmonics_tolerance;
  problem.system = std::move(settings);
}

Key<LibrarySettings> key_of(const Setting& setting, std::size_t i) {
  using L = Key<LibrarySettings>;
  const std::string standard = fmt::format("{}", setting.value);
  const auto continued = only(
      "the continuation parameter has its values from [branch]; leave it out here",
      [name = setting.name](const LibrarySettings& settings, const TomlSection&) {
        return name != settings.parameter;
      },
      "");
  const NumberRule rule = rule_of(setting);
  const auto value = [i](auto& settings) -> auto& { return settings.values[i]; };
  if (!setting.is_integer)
    return {setting.name,           value, rule, setting.meaning, continued, otherwise(standard),
            parameter(setting.name)};
  const auto read = [=, name = setting.name](LibrarySettings& settings, const TomlSection& section) {
    value(settings) = static_cast<double>(section.integer(name, rule));
  };
  const auto size = [=](const LibrarySettings& settings) { return static_cast<Index>(value(settings)); };
  return L::special(setting.name, "integer" + rule.text, setting.meaning, read, continued,
                    otherwise(standard), resolved(size));
}

}  // namespace

K preload_growth_key() {
  return {"preload_growth", &S::preload_growth, any_number(), "P_2 of the preload P + P_2 eta^2",
          parameter("P_2")};
}

std::vector<K> shared_keys() {
  const auto base = [](const S& settings) {
    const bool in_study = settings.use->linear_passive;
    NumberRule rule = ratio_rule(!in_study, settings.sectors ? &settings.sectors->base() : nullptr);
    if (in_study) {
      rule.text +=
          ", as a base that its own motion excites grows without bound wherever friction does not hold it: "
          "its peaks bound no motion, and no preload is best";
    }
    return rule;
  };
  const auto damper = [](const S& settings) {
    return ratio_rule(false, settings.sectors ? settings.sectors->damper() : nullptr);
  };
  const auto of_rings = [](const S& settings, const TomlSection&) { return !settings.sectors; };
  const auto kind = [](const S& settings) {
    return settings.sectors ? ordered_json() : ordered_json(to_string(settings.base_damping_kind));
  };
  static const KeyTable<S> damping{
      {K("base", &S::base_damping, {damping_rule().text, base},
         "zeta of the base; negative where its own motion excites it, which a study does not take",
         parameter("zeta_B")),
       K("damper", &S::damper_damping, {inside(0, 1).text, damper}, "zeta of the damper",
         parameter("zeta_D")),
       K::choice("kind", &S::base_damping_kind,
                 {{"viscous", DampingKind::viscous}, {"structural", DampingKind::structural}},
                 "of the base: C proportional to K, or K (1 + 2j zeta_B)", ", for the base", resolved(kind),
                 only("unknown key; expected base or damper", of_rings, "not of sectors"))}};
  const auto needs_preload = [](const S& settings, const TomlSection&) {
    return !settings.has_geometry && settings.use->parameter != "P";
  };
  const auto is_auto = [](const S& settings, const TomlSection&) {
    return settings.harmonics_tolerance.has_value();
  };
  return {
      K("preload", &S::preload, positive(), "P = mu p_0/k_B; of sectors, see limit_per_preload",
        needed("required, unless P varies", needs_preload), only(in_geometry, without_geometry),
        parameter("P")),
      K::table(
          "damping", [](auto& settings) -> auto& { return settings; }, damping, "",
          "a table { base = ..., damper = ... }", "damping ratios"),
      K::special("harmonics", "odd integer, list or \"auto\"",
                 "the harmonics in which friction is balanced: all odd ones up to this, or those listed",
                 read_orders, resolved([](const S&) { return 1; })),
      K("harmonics_tolerance", &S::harmonics_tolerance, within(1e-9, 0.1, " >= 1e-9 and <= 0.1"),
        "the largest harmonic left out, relative to R", only(R"(only beside harmonics = "auto")", is_auto),
        otherwise(fmt::format("{}", usual_harmonics_tolerance)))};
}

const KeyTable<FrictionSettings>& ring_keys() {
  const auto in_groups = only(in_geometry, without_geometry);
  const auto group = [=](auto& key) {
    needed("required", without_geometry)(key);
    in_groups(key);
  };
  const auto not_both =
      only("expected this or slenderness, not both", lacks("slenderness"), "not beside slenderness");
  const auto poisson_ratio = [](const S& settings) {
    return settings.slenderness ? ordered_json(settings.poisson_ratio) : ordered_json();
  };
  static const KeyTable<S> keys{
      {K::choice("model", &S::model, {{"rods", StructureModel::rods}, {"beams", StructureModel::beams}},
                 "longitudinal waves, or transverse ones", "", required),
       K("wave_number", &S::wave_number, at_least(1, most_elements), "n, waves round the circumference",
         required),
       K("elements", &S::elements, {" > 2 wave_number and <= 1e9", element_rule},
         "N, each with a contact point; the cost does not depend on it", required),
       K("mass_ratio", &S::mass_ratio, positive(), "M*, mass of the base over that of the damper", group,
         parameter("M*")),
       K("frequency_ratio", &S::frequency_ratio, positive(),
         "gamma, natural frequency of the base over that of the damper", group, parameter("gamma")),
       K("slenderness", &S::slenderness, positive(), "L/h_D, which gives K_FD = 12 (L/h_D)^4/(1 + nu)",
         needed("required, or interface_stiffness", needs_slenderness), in_groups,
         only("only for beams; rods take interface_stiffness", is_beam)),
       K("interface_stiffness", &S::interface_stiffness, positive(),
         "K_FD itself; beside `[geometry]` in place of its shear estimate",
         needed("required of rods", needs_stiffness), not_both, parameter("K_FD")),
       K("force", &S::force, positive(), "F = f_0/k_B", group, parameter("F"))},
      shared_keys(),
      {K("poisson_ratio", &S::poisson_ratio, poisson_rule(), "nu of the damper", in_groups,
         otherwise(fmt::format("{}", S{}.poisson_ratio)), resolved(poisson_ratio)),
       preload_growth_key(),
       K("cubic_stiffness", &S::cubic_stiffness, any_number(),
         "N k_3/K* of springs k_3 y^3 between the base's nodes and ground", parameter("cubic_stiffness")),
       K::flag("fixed_damper", &S::fixed_damper, "friction against a rigid ring")}};
  return keys;
}

const KeyTable<LibrarySettings>& library_keys(const LibraryModel& model) {
  static const auto tables = [] {
    std::map<std::string, KeyTable<LibrarySettings>> made;
    for (const LibraryModel& one : problems::library()) {
      std::vector<Key<LibrarySettings>> keys{Key<LibrarySettings>::special(
          "model", fmt::format("\"{}\"", one.name), one.title, {}, unlisted, otherwise("required"))};
      for (std::size_t i = 0; i < one.settings.size(); ++i) keys.push_back(key_of(one.settings[i], i));
      made.emplace(one.name, KeyTable<LibrarySettings>(std::move(keys)));
    }
    return made;
  }();
  return tables.at(model.name);
}

std::vector<std::string> model_names() {
  std::vector<std::string> names = {"rods", "beams", "sector"};
  for (const LibraryModel& model : problems::library()) names.push_back(model.name);
  return names;
}

std::vector<ListedKey> listed_keys(const TomlDocument& document, const LibraryModel* model) {
  std::vector<ListedKey> keys = listed_keys(model != nullptr      ? library_keys(*model).words()
                                            : is_sector(document) ? sector_keys().words()
                                                                  : ring_keys().words(),
                                            "system");
  if (model != nullptr || is_sector(document) || !has_geometry(document)) return keys;
  const std::vector<ListedKey> sizes = listed_keys(geometry_keys().words(), "geometry");
  keys.insert(keys.end(), sizes.begin(), sizes.end());
  return keys;
}

NumberRule poisson_rule() {
  return {[](double nu) { return nu > -1 && nu <= 0.5; }, " > -1 and <= 0.5"};
}

NumberRule parameter_rule(const LibraryModel* model, const std::string& parameter) {
  if (model == nullptr) {
    if (parameter == "zeta_B") return damping_rule();
    if (parameter == "P_2" || parameter == "cubic_stiffness" || parameter.find('.') != std::string::npos)
      return any_number();  // of its own rule
    return parameter == "zeta_D" ? inside(0, 1) : positive();
  }
  for (const Setting& setting : model->settings) {
    if (setting.name == parameter) return rule_of(setting);
  }
  return any_number();
}

void read_system(const TomlDocument& document, const Replacements& replacements, const SystemUse& use,
                 ProblemRequest& problem) {
  const TomlSection section(document, "system", &replacements);
  problem.model = use.model;
  if (use.model == nullptr) return read_friction(document, replacements, section, use, problem);
  if (has_geometry(document))
    document.fail(document.root().get("geometry"), "geometry", "only for systems with friction");
  if (document.root().contains("element"))
    document.fail(document.root().get("element"), "element", "only for systems with friction");
  LibrarySettings settings{problems::defaults(*use.model), use.parameter};
  library_keys(*use.model).read(settings, section);
  problem.settings = std::move(settings.values);
}

void resolve_system(const ProblemRequest& problem, ordered_json& file) {
  ordered_json& section = file["system"];
  if (problem.model != nullptr)
    return fill(section, library_keys(*problem.model).values({problem.settings, ""}));
  S settings{problem.system};
  settings.harmonics_tolerance = problem.harmonics_tolerance;
  if (settings.sectors) settings.path = settings.sectors->path();
  if (settings.sectors) settings.reduction_tolerance = settings.sectors->tolerance();
  if (section.contains("slenderness")) settings.slenderness = 0;
  fill(section, (settings.sectors ? sector_keys() : ring_keys()).values(settings));
  for (std::size_t i = 0; i < settings.others.size(); ++i)
    fill(file["element"][i], element_keys(*settings.others[i].kind).values(settings.others[i]));
}

}  // namespace arcslip
