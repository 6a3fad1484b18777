#include "cases/system_section.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "arcslip/elements/idle.hpp"
#include "arcslip/motion/swing.hpp"
#include "cases/element_section.hpp"
#include "cases/excitation_section.hpp"
#include "cases/flutter_section.hpp"
#include "cases/geometry_section.hpp"
#include "cases/given_structure.hpp"
#include "cases/harmonics_section.hpp"
#include "cases/model_section.hpp"
#include "cases/ring_section.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;
using S = FrictionSettings;
using K = Key<S>;
using problems::LibraryModel;

NumberRule damping_rule() {
  return {[](double zeta) { return std::abs(zeta) < 1 && zeta != 0; }, " > -1 and < 1 that is not 0"};
}

/// What a damping ratio may be.
NumberRule ratio_rule(bool may_be_negative) {
  if (may_be_negative) return {[](double zeta) { return std::abs(zeta) < 1; }, " > -1 and < 1"};
  return {[](double zeta) { return zeta >= 0 && zeta < 1; }, " >= 0 and < 1"};
}

/// What 0 is calculated as where a structure has no other damping: responses at its undamped resonances
/// stay finite, and those that friction bounds keep their first nine digits.
constexpr double undamped = 1e-12;

/// Takes a ratio 0 so.
auto not_undamped(double S::*ratio, bool S::*is_damped) {
  return then([=](S& settings, const TomlSection&) {
    if (settings.*ratio == 0 && !(settings.*is_damped)) settings.*ratio = undamped;
  });
}

/// What all kinds of structures are called, with those that a program gives.
std::vector<std::string> structure_names(const TomlDocument& document) {
  std::vector<std::string> names;
  if (document.parts() != nullptr) {
    for (const auto& given : document.parts()->structures) names.push_back(given.first);
  }
  for (const StructureKind& kind : structure_kinds())
    names.insert(names.end(), kind.models.begin(), kind.models.end());
  return names;
}

const StructureKind& kind_of(const TomlDocument& document) {
  const std::string model = TomlSection(document, "system").text("model", structure_names(document));
  return find_given(document, model) ? given_structure() : *structure_of(model);
}

/// Refuses orders of the load that no harmonic balances, unless harmonics are found.
void check_balanced(const TomlDocument& document, const ProblemRequest& problem) {
  const SystemParameters& system = problem.system;
  const ExcitationKind* kind = system.excitation.kind;
  if (kind == nullptr || !kind->needed || problem.harmonics_tolerance) return;
  for (const int h : kind->needed(system.excitation)) {
    if (std::count(system.harmonics.begin(), system.harmonics.end(), h * system.periods()) > 0) continue;
    TomlSection(document, "excitation")
        .fail(kind->lists.front().each.name,
              fmt::format("order {} is not among the harmonics that are balanced, [system] harmonics", h));
  }
}

void read_friction(const TomlDocument& document, const Replacements& replacements, const TomlSection& section,
                   const SystemUse& use, ProblemRequest& problem) {
  const StructureKind& kind = kind_of(document);
  const bool has_sizes = std::any_of(kind.sections.begin(), kind.sections.end(),
                                     [](const auto& one) { return one.name == "geometry"; });
  if (has_geometry(document) && !has_sizes)
    document.fail(document.root().get("geometry"), "geometry", "only for rods and beams");
  problem.structure = &kind;
  kind.read({document, section, replacements, use}, problem);
  read_elements(document, problem.system);
  problem.system.excitation = read_excitation(document, replacements);
  complete_orders(section, problem.system);
  check_balanced(document, problem);
  check_waves(section, problem.system);
  read_flutter(document, replacements, use, problem);
  read_ring(document, replacements, use, problem);
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

K units_key() {
  return K::choice("units", &S::in_SI, {{"SI", true}},
                   "what masses, stiffnesses and forces are in: kg, N/m and N, so that columns, ranges and "
                   "pictures may be in Hz, N and m",
                   "", otherwise("none: numbers without unit"), resolved([](const S& settings) {
                     return settings.in_SI ? ordered_json("SI") : ordered_json();
                   }),
                   unlisted);
}

std::vector<K> shared_keys() {
  const auto base = [](const S& settings) {
    const bool in_study = settings.use->linear_passive;
    NumberRule rule = ratio_rule(!in_study);
    if (in_study) {
      rule.text +=
          ", as a base that its own motion excites grows without bound wherever friction does not hold it: "
          "its peaks bound no motion, and no preload is best";
    }
    return rule;
  };
  const auto has_kind = [](const S& settings, const TomlSection&) { return settings.has_damping_kind; };
  const auto kind = [](const S& settings) {
    return settings.has_damping_kind ? ordered_json(to_string(settings.base_damping_kind)) : ordered_json();
  };
  static const KeyTable<S> damping{
      {K("base", &S::base_damping, {ratio_rule(true).text, base},
         "zeta of the base; negative where its own motion excites it, which a study does not take; 0 is "
         "calculated as 1e-12",
         parameter("zeta_B"), not_undamped(&S::base_damping, &S::is_base_damped)),
       K("damper", &S::damper_damping, ratio_rule(false), "zeta of the damper; 0 is calculated as 1e-12",
         parameter("zeta_D"), not_undamped(&S::damper_damping, &S::is_damper_damped)),
       K::choice("kind", &S::base_damping_kind,
                 {{"viscous", DampingKind::viscous}, {"structural", DampingKind::structural}},
                 "of the base: C proportional to K, or K (1 + 2j zeta_B)", ", for the base", resolved(kind),
                 only("unknown key; expected base or damper", has_kind, "of rods and beams"))}};
  const auto needs_preload = [](const S& settings, const TomlSection&) {
    return !settings.has_geometry && settings.use->parameter != "P";
  };
  const auto is_response = [](const S& settings, const TomlSection&) {
    return !settings.use->linear_passive;
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
                 "the harmonics in which friction is balanced: all odd ones up to this, or those listed; "
                 "beside elements that are not odd the mean 0 and the even ones as well",
                 read_orders, resolved([](const S&) { return 1; })),
      K::special(
          "even_harmonics", "true or false",
          "balance the mean 0 and the even harmonics beside odd elements, too: for responses whose half "
          "periods differ",
          {}, otherwise("false"), resolved([](const S& settings) { return !all_odd(settings.harmonics); })),
      K::special("periods", fmt::format("integer >= 1 and <= {}", most_periods),
                 "p: the response repeats itself after so many periods of the load, and has the harmonics of "
                 "eta/p up to `harmonics` eta; where periods double, `switching` reaches it",
                 {}, otherwise("1"), resolved([](const S& settings) { return settings.periods(); }),
                 only("not of studies, whose responses repeat themselves with the load", is_response,
                      "not of studies")),
      K::special(
          "subharmonic_wave", "integer",
          "m, on how many waves the harmonic of eta/p travels: p m = n modulo N; only beside periods > 1", {},
          otherwise("the least")),
      K("harmonics_tolerance", &S::harmonics_tolerance, within(1e-9, 0.1, " >= 1e-9 and <= 0.1"),
        "the largest harmonic left out, relative to R", only(R"(only beside harmonics = "auto")", is_auto),
        otherwise(fmt::format("{}", usual_harmonics_tolerance)))};
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

const StructureKind* structure_of(const std::string& model) {
  for (const StructureKind& kind : structure_kinds()) {
    if (std::find(kind.models.begin(), kind.models.end(), model) != kind.models.end()) return &kind;
  }
  return nullptr;
}

void take(FrictionSettings settings, ProblemRequest& problem) {
  problem.harmonics_tolerance = settings.harmonics_tolerance;
  if (settings.in_SI) problem.physical.emplace(settings.hertz, settings);
  problem.system = std::move(settings);
}

std::vector<std::string> model_names(const TomlDocument& document) {
  std::vector<std::string> names = structure_names(document);
  for (const LibraryModel& model : problems::library()) names.push_back(model.name);
  return names;
}

std::vector<ListedKey> listed_keys(const TomlDocument& document, const LibraryModel* model) {
  if (has_model(document)) return listed_model_keys(*model);
  if (model != nullptr) return listed_keys(library_keys(*model).words(), "system");
  const StructureKind& kind = kind_of(document);
  std::vector<ListedKey> keys = listed_keys(kind.keys(), "system");
  for (const StructureKind::Section& section : kind.sections) {
    if (!section.is_listed || !document.root().contains(section.name)) continue;
    const std::vector<ListedKey> more = listed_keys(section.keys(), section.name);
    keys.insert(keys.end(), more.begin(), more.end());
  }
  const std::vector<ListedKey> of_load = listed_excitation_keys(document);
  keys.insert(keys.end(), of_load.begin(), of_load.end());
  const std::vector<ListedKey> of_ring = listed_ring_keys(document);
  keys.insert(keys.end(), of_ring.begin(), of_ring.end());
  const std::vector<ListedKey> of_flow = listed_flutter_keys(document);
  keys.insert(keys.end(), of_flow.begin(), of_flow.end());
  return keys;
}

std::shared_ptr<const Structures> load_structures(const TomlDocument& document) {
  const StructureKind& kind = kind_of(document);
  return kind.load ? kind.load(document) : nullptr;
}

std::vector<double> numbers_of_contacts(const TomlSection& section, const std::string& name,
                                        const NumberRule& rule, std::size_t count) {
  const toml::table* table = section.table();
  std::vector<double> values;
  if (table == nullptr || !(*table)[name].is_array()) {
    values.assign(count, section.number(name, rule));
    return values;
  }
  values = section.numbers(name, rule);
  if (values.size() != count)
    section.fail(name, fmt::format("expected a number, or {} of them as there are contacts, got {}", count,
                                   values.size()));
  return values;
}

std::vector<SectorContact> sector_contacts(const std::vector<double>& stiffness,
                                           const std::vector<double>& limit_per_preload) {
  std::vector<SectorContact> contacts;
  std::transform(stiffness.begin(), stiffness.end(), limit_per_preload.begin(), std::back_inserter(contacts),
                 [](double k, double limit) {
                   return k > 0 ? SectorContact{k, limit / k} : SectorContact{0, never_slips};
                 });
  return contacts;
}

std::string contacts_in_words(const SystemParameters& system) {
  std::vector<double> k;
  std::vector<double> limits;
  for (const SectorContact& contact : system.contacts) {
    k.push_back(contact.stiffness);
    limits.push_back(contact.slip_per_preload * contact.stiffness);
  }
  return fmt::format("k = {:g}, L = {:g}, F = {:g}", fmt::join(k, ", "), fmt::join(limits, ", "),
                     system.force);
}

NumberRule poisson_rule() {
  return {[](double nu) { return nu > -1 && nu <= 0.5; }, " > -1 and <= 0.5"};
}

NumberRule parameter_rule(const LibraryModel* model, const std::string& parameter) {
  if (model == nullptr) {
    if (parameter == "zeta_B") return damping_rule();
    if (parameter == "P_2" || parameter == "cubic_stiffness" || parameter == "speed" ||
        parameter.find('.') != std::string::npos)
      return any_number();  // of its own rule
    return parameter == "zeta_D" ? inside(0, 1) : positive();
  }
  for (const Setting& setting : model->settings) {
    if (setting.name == parameter) return rule_of(setting);
  }
  return any_number();
}

void read_system(const TomlDocument& document, const Replacements& replacements,
                 const std::shared_ptr<const LibraryModel>& model, const SystemUse& use,
                 ProblemRequest& problem) {
  const TomlSection section(document, "system", &replacements);
  problem.model = model;
  if (model == nullptr) return read_friction(document, replacements, section, use, problem);
  if (has_geometry(document))
    document.fail(document.root().get("geometry"), "geometry", "only for systems with friction");
  for (const char* name : {"element", "excitation", "flutter", "ring"}) {
    if (document.root().contains(name))
      document.fail(document.root().get(name), name, "only for systems with friction");
  }
  if (has_model(document)) {
    problem.settings = read_model_values(document, replacements, *model, use.parameter);
    return;
  }
  LibrarySettings settings{problems::defaults(*model), use.parameter};
  library_keys(*model).read(settings, section);
  problem.settings = std::move(settings.values);
}

namespace {

/// Puts what files held in the place of their names: of loads and of the weights of outputs.
void resolve_files(const SystemParameters& system, ordered_json& file) {
  const Excitation& excitation = system.excitation;
  for (std::size_t i = 0; i < excitation.lists.size(); ++i) {
    ordered_json& list = file["excitation"][excitation.kind->lists[i].each.name];
    if (list.is_string()) list = excitation.lists[i];
  }
  for (const bool on_base : {true, false}) {
    const auto part = file["system"].find(on_base ? "base" : "damper");
    if (part == file["system"].end() || !part->is_object() || !part->contains("weights")) continue;
    ordered_json rows = ordered_json::object();
    for (const WantedOutput& output : system.wanted) {
      if (output.on_base != on_base) continue;
      ordered_json& row = rows[output.name];
      for (Index i = 0; i < output.weights.size(); ++i) {
        if (output.weights(i) == 0) continue;
        row["dof"].push_back(i + 1);
        row["value"].push_back(output.weights(i));
      }
    }
    ordered_json& weights = (*part)["weights"];
    if (weights.is_string() && !rows.empty()) weights = std::move(rows);
  }
}

}  // namespace

void resolve_system(const TomlDocument& document, const ProblemRequest& problem, ordered_json& file) {
  if (has_model(document)) return resolve_model(document, file["model"]);
  ordered_json& section = file["system"];
  if (problem.model != nullptr)
    return fill(section, library_keys(*problem.model).values({problem.settings, ""}));
  fill(section, problem.structure->resolved(of_one_sector(problem), section));
  if (file.contains("ring")) fill(file["ring"], ring_values());
  if (file.contains("flutter")) resolve_flutter(problem.system, file["flutter"]);
  const Excitation& excitation = problem.system.excitation;
  if (excitation.kind != nullptr)
    fill(file["excitation"], excitation_keys(*excitation.kind).values(excitation));
  resolve_files(problem.system, file);
  const std::vector<PlacedElement>& others = problem.system.others;
  for (std::size_t i = 0; i < others.size(); ++i)
    fill(file["element"][i], element_keys(*others[i].kind).values(others[i]));
}

}  // namespace arcslip
