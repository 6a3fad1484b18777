#include "cases/flutter_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/assembly/structures.hpp"
#include "cases/ring_numbers.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

struct FlutterSettings {
  Index sectors = 1;  ///< N
  Influence influence = {};
  double factor = 1;
};

using FlutterKey = Key<FlutterSettings>;
using Rows = std::vector<std::vector<double>>;

/// A whole number that is one of a wave or neighbour, each of which is there once. Throws InputError.
Index offset_of(const TomlSection& section, const char* key, const char* what, double number, Index sectors,
                std::vector<Index>& known) {
  const Index half = sectors / 2;
  const auto offset = static_cast<Index>(std::abs(number) < 1e9 ? number : 1e9);
  if (static_cast<double>(offset) != number || std::abs(offset) > half)
    section.fail(
        key, fmt::format("expected whole numbers from {} to {} as {}, got {:g}", -half, half, what, number));
  const auto same = [&](Index other) { return (other - offset) % sectors == 0; };
  if (std::any_of(known.begin(), known.end(), same))
    section.fail(key, fmt::format("expected {} that differ, got {} twice{}", what, offset,
                                  2 * std::abs(offset) == sectors ? ", as the one across is" : ""));
  known.push_back(offset);
  return offset;
}

constexpr const char* coefficient_rows =
    "rows [k, L_k] or, of complex ones, [k, Re L_k, Im L_k], in a list or a CSV file";

void read_coefficients(FlutterSettings& settings, const TomlSection& section) {
  std::vector<Index> known;
  for (const std::vector<double>& row : listed_rows(section, "coefficients", coefficient_rows)) {
    if (row.size() != 2 && row.size() != 3)
      section.fail("coefficients", fmt::format("expected {}, got a row of {}", coefficient_rows, row.size()));
    settings.influence.coefficients.push_back(
        {offset_of(section, "coefficients", "neighbours", row[0], settings.sectors, known),
         Complex(row[1], row.size() > 2 ? row[2] : 0)});
  }
}

constexpr const char* damping_rows = "rows [n, zeta_n], in a list or a CSV file";

void read_damping(FlutterSettings& settings, const TomlSection& section) {
  std::vector<Index> known;
  for (const std::vector<double>& row : listed_rows(section, "damping", damping_rows)) {
    if (row.size() != 2)
      section.fail("damping", fmt::format("expected {}, got a row of {}", damping_rows, row.size()));
    const Index wave = offset_of(section, "damping", "nodal diameters", row[0], settings.sectors, known);
    if (!(std::abs(row[1]) < 1))
      section.fail("damping", fmt::format("expected damping ratios > -1 and < 1, got {:g}", row[1]));
    settings.influence.damping.push_back({wave, row[1]});
  }
}

void read_modes(FlutterSettings& settings, const TomlSection& section) {
  const NumberRule rule{[](double one) { return one >= 1 && one < 1e9 && one == std::floor(one); },
                        " that are whole, from 1 on"};
  for (const double one : section.numbers("modes", rule))
    settings.influence.modes.push_back(static_cast<Index>(one) - 1);
  if (settings.influence.modes.empty()) section.fail("modes", "expected one mode or more");
}

const KeyTable<FlutterSettings>& flutter_keys() {
  static const KeyTable<FlutterSettings> keys{
      {FlutterKey::special("coefficients", "rows or CSV file",
                           "[k, L_k]: the force on each sector, per modal mass, of the motion of its k-th "
                           "neighbour; complex [k, Re L_k, Im L_k] at one frequency, in the first harmonic",
                           read_coefficients, needed("required, or damping", lacks("damping")), unlisted),
       FlutterKey::special("damping", "rows or CSV file",
                           "[n, zeta_n]: damping ratios of waves of n nodal diameters beside the base's own; "
                           "those of n hold for both ways round unless -n is there",
                           read_damping, otherwise("0 of all"), unlisted),
       FlutterKey::special("modes", "list of integers", "which modes of the base it acts on, under each wave",
                           read_modes, otherwise("all"), unlisted),
       FlutterKey("influence", &FlutterSettings::factor, positive(), "factor on all of it",
                  parameter("influence"))}};
  return keys;
}

ordered_json rows_of_coefficients(const Influence& influence) {
  ordered_json rows = ordered_json::array();
  for (const auto& [neighbour, value] : influence.coefficients) {
    ordered_json row{neighbour, value.real()};
    if (value.imag() != 0) row.push_back(value.imag());
    rows.push_back(row);
  }
  return rows;
}

/// Refuses what a flow is not calculated of.
void check_flutter_use(const TomlDocument& document, const toml::table* table, const SystemUse& use,
                       const SystemParameters& system) {
  const auto fail = [&](const std::string& why) { document.fail(table, "flutter", why); };
  if (feels_rotation(system))
    fail("not of sectors that turn, whose modes are not those that a flow is told by");
  if (use.linear_passive) fail("not of studies, whose structures are passive; expected [branch] alone");
  if (document.root().contains("ring"))
    fail("not beside [ring]: influence coefficients are those of equal sectors, each with its own wave");
  bool by_modes = structures_of(system).has_equations();
  try {
    by_modes = by_modes && structures_of(system).in_modes() == nullptr;
  } catch (const std::invalid_argument&) {
    by_modes = false;
  }
  if (!by_modes)
    fail(
        "it acts on modes of the base: not of structures that are solved for, as with path = \"full\", or "
        "known by their responses");
}

/// Refuses what has another frequency than that of the first harmonic.
void check_complex(const TomlSection& section, const ProblemRequest& problem) {
  if (!problem.system.influence->is_complex()) return;
  const bool is_one = problem.system.harmonics == std::vector<int>{1} && !problem.harmonics_tolerance;
  if (!is_one)
    section.fail("coefficients",
                 "complex ones are meant at one frequency: expected real ones, or harmonics = 1");
  if (problem.stability)
    section.fail("coefficients",
                 "complex ones are meant at one frequency, and disturbances have others: expected real ones, "
                 "or no stability");
}

}  // namespace

std::vector<KeyWords> flutter_words() { return flutter_keys().words(); }

void read_flutter(const TomlDocument& document, const Replacements& replacements, const SystemUse& use,
                  ProblemRequest& problem) {
  const TomlSection section(document, "flutter", &replacements);
  if (section.table() == nullptr) return;
  SystemParameters& system = problem.system;
  check_flutter_use(document, section.table(), use, system);
  FlutterSettings settings{system.elements};
  flutter_keys().read(settings, section);
  system.influence = std::make_shared<const Influence>(std::move(settings.influence));
  system.influence_factor = settings.factor;
  check_complex(section, problem);
  try {
    const Index count = std::ssize(build_wave(system).base.modes());
    for (const Index mode : system.influence->modes) {
      if (mode >= count)
        section.fail("modes", fmt::format("expected modes from 1 to {}, as many as the base has, got {}",
                                          count, mode + 1));
    }
  } catch (const std::invalid_argument& error) {
    document.fail(section.table(), "flutter", error.what());
  }
}

std::vector<ListedKey> listed_flutter_keys(const TomlDocument& document) {
  if (!document.root().contains("flutter")) return {};
  return listed_keys(flutter_words(), "flutter");
}

void resolve_flutter(const SystemParameters& system, ordered_json& section) {
  const Influence& influence = *system.influence;
  if (section.contains("coefficients")) section["coefficients"] = rows_of_coefficients(influence);
  if (section.contains("damping")) {
    section["damping"] = ordered_json::array();
    for (const auto& [wave, zeta] : influence.damping) section["damping"].push_back({wave, zeta});
  }
  fill(section, flutter_keys().values({system.elements, influence, system.influence_factor}));
}

std::string flutter_in_words(const SystemParameters& system) {
  if (!system.influence) return "";
  const Influence& influence = *system.influence;
  const double factor = system.influence_factor;
  const Complex a = factor * influence.coefficient(system.wave_number, system.elements);
  std::string text = fmt::format("a flow on the base, in this wave A = {:g} {} {:g}j", a.real(),
                                 a.imag() < 0 ? '-' : '+', std::abs(a.imag()));
  if (!influence.damping.empty())
    text += fmt::format(", zeta = {:g}", factor * influence.zeta(system.wave_number, system.elements));
  return text;
}

}  // namespace arcslip
