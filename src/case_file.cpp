#include "arcslip/case_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "toml_reader.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

const std::vector<std::string> system_keys = {
    "model",         "wave_number",         "elements", "mass_ratio", "frequency_ratio", "slenderness",
    "poisson_ratio", "interface_stiffness", "damping",  "force",      "preload"};
const std::vector<std::string> branch_keys = {"parameter", "from", "to", "eta", "for_each"};
const std::vector<std::string> continuation_keys = {"tolerance", "max_step", "min_step", "max_points",
                                                    "stop_at"};
constexpr double default_poisson_ratio = 0.3;

/// What differs from branch to branch: one value for each key of `for_each`.
struct ForEach {
  std::vector<std::string> keys;
  std::vector<const toml::array*> values;
  std::size_t count = 1;

  bool sets(const std::string& key) const { return std::find(keys.begin(), keys.end(), key) != keys.end(); }
};

ForEach read_for_each(const TomlDocument& document, const TomlSection& branch) {
  ForEach result;
  if (!branch.has("for_each")) return result;
  const TomlSection section(document, "branch.for_each");
  std::vector<std::string> allowed = system_keys;
  allowed.emplace_back("eta");
  section.allow_only(allowed);
  for (const auto& [key, node] : *section.table()) {
    const std::string name(key.str());
    const toml::array* list = node.as_array();
    if (list == nullptr || list->empty()) section.mismatch(name, "an array with at least one value");
    if (!result.keys.empty() && list->size() != result.count) {
      section.fail(
          name, fmt::format("expected {} values, as many as {} has (the lists are walked together), got {}",
                            result.count, result.keys.front(), list->size()));
    }
    result.keys.push_back(name);
    result.values.push_back(list);
    result.count = list->size();
  }
  if (result.keys.empty()) branch.mismatch("for_each", "a table with at least one key");
  return result;
}

Replacements replacements_of(const ForEach& for_each, std::size_t i) {
  Replacements replacements;
  for (std::size_t k = 0; k < for_each.keys.size(); ++k) {
    const std::string& key = for_each.keys[k];
    const std::string path = key == "eta" ? "branch.eta" : "system." + key;
    replacements[path] = {for_each.values[k]->get(i), fmt::format("branch.for_each.{}[{}]", key, i)};
  }
  return replacements;
}

ordered_json values_of(const ForEach& for_each, std::size_t i) {
  ordered_json values = ordered_json::object();
  for (std::size_t k = 0; k < for_each.keys.size(); ++k) {
    values[for_each.keys[k]] = to_json(*for_each.values[k]->get(i));
  }
  return values;
}

double read_interface_stiffness(const TomlSection& section, StructureModel model) {
  const double poisson_ratio =
      section.number("poisson_ratio", {[](double nu) { return nu > -1 && nu <= 0.5; }, " > -1 and <= 0.5"},
                     default_poisson_ratio);
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

void read_damping(const TomlDocument& document, const TomlSection& section, SystemParameters& system) {
  if (!section.has("damping")) return;
  const toml::table* table = section.require("damping", "a table").as_table();
  if (table == nullptr) section.mismatch("damping", "a table { base = ..., damper = ... }");
  for (const auto& [key, node] : *table) {
    const bool base = key.str() == "base";
    if (!base && key.str() != "damper") {
      document.fail(&node, section.name("damping") + "." + std::string(key.str()),
                    "unknown key; expected base or damper");
    }
    const double value = node.value<double>().value_or(-1);
    if (!node.is_number() || !(value > 0 && value < 1)) {
      document.mismatch(node, section.name("damping") + "." + std::string(key.str()),
                        "a finite number > 0 and < 1");
    }
    (base ? system.base_damping : system.damper_damping) = value;
  }
}

SystemParameters read_system(const TomlDocument& document, const Replacements& replacements,
                             bool needs_preload) {
  const TomlSection section(document, "system", &replacements);
  if (section.table() == nullptr) document.fail(nullptr, "system", "missing; expected a section [system]");
  section.allow_only(system_keys);
  SystemParameters system;
  system.model =
      section.text("model", {"rods", "beams"}) == "rods" ? StructureModel::rods : StructureModel::beams;
  constexpr Index most = 1'000'000'000;
  system.wave_number = section.integer("wave_number", 1, most, "an integer >= 1");
  system.elements =
      section.integer("elements", 2 * system.wave_number + 1, most,
                      fmt::format("an integer > 2 wave_number = {} and <= 1e9", 2 * system.wave_number));
  system.mass_ratio = section.number("mass_ratio", positive());
  system.frequency_ratio = section.number("frequency_ratio", positive());
  system.interface_stiffness = read_interface_stiffness(section, system.model);
  read_damping(document, section, system);
  system.force = section.number("force", positive());
  if (needs_preload || section.has("preload")) system.preload = section.number("preload", positive());
  return system;
}

continuation::TraceOptions read_continuation(const TomlDocument& document) {
  const TomlSection section(document, "continuation");
  section.allow_only(continuation_keys);
  continuation::TraceOptions options;
  options.tolerance = section.number("tolerance", inside(0, 1e-2), options.tolerance);
  options.max_step = section.number("max_step", {[](double h) { return h > 0 && h <= 1; }, " > 0 and <= 1"},
                                    options.max_step);
  options.min_step = section.number(
      "min_step", {[&](double h) { return h > 0 && h <= options.max_step; }, " > 0 and <= max_step"},
      options.min_step);
  options.max_points = section.integer("max_points", 2, std::numeric_limits<int>::max(), "an integer >= 2",
                                       options.max_points);
  return options;
}

void read_range(const TomlDocument& document, const TomlSection& branch,
                continuation::TraceOptions& options) {
  options.parameter = branch.text("parameter", {"eta", "P"});
  options.extrema_of = {"Y"};
  options.from = branch.number("from", positive());
  options.to = branch.number("to", positive());
  if (options.from == options.to) branch.mismatch("to", "a number that differs from branch.from");
  const double low = std::min(options.from, options.to);
  const double high = std::max(options.from, options.to);
  options.stop_at = TomlSection(document, "continuation").numbers("stop_at", within(low, high));
}

/// The input as it is understood, defaults included.
ordered_json resolve(const TomlDocument& document, const Case& built) {
  ordered_json resolved = to_json(document.root());
  const CaseBranch& first = built.branches.front();
  ordered_json& system = resolved["system"];
  if (!system.contains("damping")) system["damping"] = ordered_json::object();
  if (!system["damping"].contains("base")) system["damping"]["base"] = first.system.base_damping;
  if (!system["damping"].contains("damper")) system["damping"]["damper"] = first.system.damper_damping;
  if (system.contains("slenderness") && !system.contains("poisson_ratio")) {
    system["poisson_ratio"] = default_poisson_ratio;
  }
  ordered_json& continuation = resolved["continuation"];
  continuation["tolerance"] = first.options.tolerance;
  continuation["max_step"] = first.options.max_step;
  continuation["min_step"] = first.options.min_step;
  continuation["max_points"] = first.options.max_points;
  continuation["stop_at"] = first.options.stop_at;
  return resolved;
}

}  // namespace

Case read_case(const std::string& path, const std::vector<std::string>& settings) {
  const TomlDocument document(path, settings);
  const TomlSection root(document, "");
  root.allow_only({"title", "system", "branch", "continuation"});
  const TomlSection branch(document, "branch");
  if (branch.table() == nullptr) document.fail(nullptr, "branch", "missing; expected a section [branch]");
  branch.allow_only(branch_keys);

  Case result;
  result.title = root.has("title") ? root.text("title", {}) : "";
  continuation::TraceOptions options = read_continuation(document);
  read_range(document, branch, options);
  const ForEach for_each = read_for_each(document, branch);
  const bool sweeps_preload = options.parameter == "P";
  if (sweeps_preload && for_each.sets("preload")) {
    branch.fail("for_each", "preload cannot be listed where P is the continuation parameter");
  }
  if (!sweeps_preload && (branch.has("eta") || for_each.sets("eta"))) {
    branch.fail(branch.has("eta") ? "eta" : "for_each", "eta is fixed only where parameter = \"P\"");
  }
  for (std::size_t i = 0; i < for_each.count; ++i) {
    const Replacements replacements = replacements_of(for_each, i);
    const TomlSection replaced(document, "branch", &replacements);
    result.branches.push_back({values_of(for_each, i), read_system(document, replacements, !sweeps_preload),
                               sweeps_preload ? replaced.number("eta", positive()) : 0, options});
  }
  result.resolved = resolve(document, result);
  return result;
}

std::string describe(const ordered_json& values) {
  std::vector<std::string> parts;
  for (const auto& [key, value] : values.items()) {
    parts.push_back(fmt::format("{} = {}", key, value.is_string() ? value.get<std::string>() : value.dump()));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace arcslip
