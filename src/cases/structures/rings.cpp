// Rods and beams of the paper.

#include <fmt/format.h>

#include <cmath>

#include "arcslip/results/results.hpp"
#include "cases/geometry_section.hpp"
#include "cases/output_weights.hpp"
#include "cases/structure_kind.hpp"
#include "cases/system_section.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

struct RingSettings : FrictionSettings {
  std::optional<double> slenderness = {};
  double poisson_ratio = 0.3;
};

using R = RingSettings;
using RingKey = Key<R>;

constexpr double most_elements = 1e9;

bool is_beam(const R& settings, const TomlSection& /*section*/) {
  return settings.model == StructureModel::beams;
}
bool needs_slenderness(const R& settings, const TomlSection& section) {
  return is_beam(settings, section) && !section.has("interface_stiffness");
}
bool needs_stiffness(const R& settings, const TomlSection& section) {
  return !is_beam(settings, section) && !settings.has_geometry;
}
NumberRule element_rule(const R& settings) {
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

/// `base` or `damper`, a table of outputs among the dofs of an element.
RingKey outputs_of(const std::string& part, const std::string& meaning) {
  static const KeyTable<OutputSettings> keys(output_keys());
  const auto read = [=](R& settings, const TomlSection& section) {
    OutputSettings wanted{settings.model == StructureModel::rods ? 2 : 4, {}};
    keys.read(wanted, section.inside(part, "a table { output, weights }"));
    want(std::move(wanted.outputs), part == "base", settings);
  };
  const auto inner = [](auto& key) { key.words.inner = keys.words(); };
  return RingKey::special(part, "table", meaning, read, inner, otherwise("none"), unlisted);
}

const KeyTable<R>& ring_keys() {
  const auto in_groups = only(in_geometry, without_geometry);
  const auto group = [=](auto& key) {
    needed("required", without_geometry)(key);
    in_groups(key);
  };
  const auto not_both =
      only("expected this or slenderness, not both", lacks("slenderness"), "not beside slenderness");
  const auto poisson_ratio = [](const R& settings) {
    return settings.slenderness ? ordered_json(settings.poisson_ratio) : ordered_json();
  };
  static const KeyTable<R> keys{
      {RingKey::choice("model", &R::model, {{"rods", StructureModel::rods}, {"beams", StructureModel::beams}},
                       "longitudinal waves, or transverse ones", "", required),
       RingKey("wave_number", &R::wave_number, at_least(1, most_elements), "n, waves round the circumference",
               required),
       RingKey("elements", &R::elements, {" > 2 wave_number and <= 1e9", element_rule},
               "N, each with a contact point; the cost does not depend on it", required),
       RingKey("mass_ratio", &R::mass_ratio, positive(), "M*, mass of the base over that of the damper",
               group, parameter("M*")),
       RingKey("frequency_ratio", &R::frequency_ratio, positive(),
               "gamma, natural frequency of the base over that of the damper", group, parameter("gamma")),
       RingKey("slenderness", &R::slenderness, positive(), "L/h_D, which gives K_FD = 12 (L/h_D)^4/(1 + nu)",
               needed("required, or interface_stiffness", needs_slenderness), in_groups,
               only("only for beams; rods take interface_stiffness", is_beam)),
       RingKey("interface_stiffness", &R::interface_stiffness, positive(),
               "K_FD itself; beside `[geometry]` in place of its shear estimate",
               needed("required of rods", needs_stiffness), not_both, parameter("K_FD")),
       RingKey("force", &R::force, positive(), "F = f_0/k_B", group, parameter("F"))},
      keys_of<R>(shared_keys()),
      {RingKey("poisson_ratio", &R::poisson_ratio, poisson_rule(), "nu of the damper", in_groups,
               otherwise(fmt::format("{}", R{}.poisson_ratio)), resolved(poisson_ratio)),
       preload_growth_key(),
       RingKey("cubic_stiffness", &R::cubic_stiffness, any_number(),
               "N k_3/K* of springs k_3 y^3 between the base's nodes and ground",
               parameter("cubic_stiffness")),
       RingKey::flag("fixed_damper", &R::fixed_damper, "friction against a rigid ring"),
       outputs_of("base",
                  "outputs beside the contact, of an element's dofs: of rods the displacements of its two "
                  "nodes, of beams displacement and rotation of the first, then of the second"),
       outputs_of("damper", "the same of the damper")}};
  return keys;
}

void read_rings(const StructureKind::Source& source, ProblemRequest& problem) {
  const auto& [document, section, replacements, use] = source;
  R settings;
  settings.use = &use;
  settings.has_geometry = has_geometry(document);
  ring_keys().read(settings, section);
  if (settings.has_geometry) {
    read_geometry(document, replacements, section, settings, problem);
  } else {
    if (settings.slenderness)
      settings.interface_stiffness = shear_interface_stiffness(*settings.slenderness, settings.poisson_ratio);
    check_groups(document, section, settings);
  }
  take(std::move(settings), problem);
}

ordered_json rings_resolved(const ProblemRequest& problem, const ordered_json& given) {
  R settings;
  static_cast<SystemParameters&>(settings) = problem.system;
  settings.harmonics_tolerance = problem.harmonics_tolerance;
  if (given.contains("slenderness")) settings.slenderness = 0;  // beside which Poisson's ratio counts
  return ring_keys().values(settings);
}

std::string rings_in_words(const ProblemRequest& problem) {
  const SystemParameters& system = problem.system;
  std::string text = fmt::format("{}, n = {}, N = {}, {}, zeta = {:g} (base), {:g} (damper)",
                                 to_string(system.model), system.wave_number, system.elements,
                                 describe_groups(problem), system.base_damping, system.damper_damping);
  if (system.base_damping_kind == DampingKind::structural) text += ", structural damping of the base";
  if (system.fixed_damper) text += ", damper held";
  if (system.cubic_stiffness != 0) text += fmt::format(", cubic stiffness {:g}", system.cubic_stiffness);
  if (system.preload_growth != 0) text += fmt::format(", preload growth {:g}", system.preload_growth);
  return text;
}

}  // namespace

StructureKind rings_structure() {
  return {.name = "rings",
          .title = "rods and beams",
          .models = {"rods", "beams"},
          .keys = [] { return ring_keys().words(); },
          .sections = {{"geometry", "two rings in SI units", [] { return geometry_keys().words(); }, true}},
          .read = read_rings,
          .resolved = rings_resolved,
          .describe = rings_in_words};
}

}  // namespace arcslip
