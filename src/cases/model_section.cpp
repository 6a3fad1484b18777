#include "cases/model_section.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "arcslip/continuation/cycles/orbit_observables.hpp"
#include "arcslip/problems/formulas/formula_problem.hpp"

namespace arcslip {
namespace {

using problems::FormulaKind;
using problems::FormulaParameter;
using problems::FormulaPiece;
using problems::FormulaSystem;
using problems::LibraryModel;
using ModelKey = Key<FormulaSystem>;

const char* const section_name = "model";
const char* const parameters_name = "model.parameters";

struct NamedNode {
  std::string key;
  const toml::node* node;
};

/// The entries of a table in the order of the file, then those of --set. Refuses what no formula could name.
std::vector<NamedNode> in_order(const TomlSection& section) {
  std::vector<std::pair<toml::source_position, NamedNode>> placed;
  for (const auto& [key, node] : *section.table()) {
    const std::string name(key.str());
    if (const std::string why = why_no_name(name); !why.empty())
      section.document().fail(&node, section.name(name), why);
    placed.push_back({key.source().begin, {name, &node}});
  }
  std::stable_sort(placed.begin(), placed.end(), [](const auto& a, const auto& b) {
    if (!a.first || !b.first) return static_cast<bool>(a.first) && !b.first;
    return a.first < b.first;
  });
  std::vector<NamedNode> entries;
  entries.reserve(placed.size());
  for (auto& [place, entry] : placed) entries.push_back(std::move(entry));
  return entries;
}

/// A number is a formula, too.
std::string text_of(const TomlSection& section, const NamedNode& entry) {
  if (const auto* text = entry.node->as_string()) return text->get();
  const std::optional<double> number = exact_number(*entry.node);
  if (!number || !std::isfinite(*number))
    section.document().mismatch(*entry.node, section.name(entry.key), "a formula as a string, or a number");
  return fmt::format("{}", *number);
}

template <class Owner>
auto formulas(const char* key, std::vector<Formula> Owner::*member) {
  return [=](Owner& owner, const TomlSection& section) {
    const TomlSection table = section.inside(key, "a table of formulas by names");
    for (const NamedNode& entry : in_order(table))
      (owner.*member).push_back({entry.key, text_of(table, entry), table.name(entry.key)});
  };
}

void read_parameters_table(FormulaSystem& system, const TomlSection& section) {
  const char* const expected = "a table with at least one number by its name";
  section.require("parameters", expected);
  const TomlSection table = section.inside("parameters", expected);
  for (const NamedNode& entry : in_order(table))
    system.parameters.push_back({entry.key, table.number(entry.key, any_number()), table.name(entry.key)});
  if (system.parameters.empty()) section.mismatch("parameters", expected);
}

void read_scale(FormulaSystem& system, const TomlSection& section) {
  const TomlSection table = section.inside("scale", "a table of numbers > 0 by names");
  for (const NamedNode& entry : in_order(table))
    system.scale.push_back({entry.key, table.number(entry.key, positive()), table.name(entry.key)});
}

void read_equations(FormulaSystem& system, const TomlSection& section) {
  const char* const expected = "a table with a formula for each unknown";
  section.require("equations", expected);
  formulas("equations", &FormulaSystem::equations)(system, section);
  if (system.equations.empty()) section.mismatch("equations", expected);
}

/// Formulas without names, as strings or numbers.
template <class Member>
auto formula_list(const char* key, const char* expected, Member member) {
  return [=](FormulaSystem& system, const TomlSection& section) {
    const toml::array* array = section.require(key, expected).as_array();
    if (array == nullptr) section.mismatch(key, expected);
    for (const toml::node& node : *array) {
      const std::string name = fmt::format("{}[{}]", key, (system.*member).size());
      (system.*member).push_back({name, text_of(section, {name, &node}), section.name(name)});
    }
  };
}

void read_interval(FormulaSystem& system, const TomlSection& section) {
  const char* const expected = "a table of one name with both its ends, as { x = [0, 1] }";
  section.require("interval", expected);
  const TomlSection table = section.inside("interval", expected);
  const toml::table& given = *table.table();
  const toml::array* ends = given.size() == 1 ? given.begin()->second.as_array() : nullptr;
  if (ends == nullptr || ends->size() != 2) section.mismatch("interval", expected);
  const std::string name(given.begin()->first.str());
  const auto end = [&](std::size_t i) {
    const std::string place = fmt::format("{}[{}]", name, i);
    return Formula{place, text_of(table, {place, ends->get(i)}), table.name(place)};
  };
  system.interval = {name, end(0), end(1), table.name(name)};
}

void read_free(FormulaSystem& system, const TomlSection& section) {
  std::vector<std::string> names;
  for (const FormulaParameter& parameter : system.parameters) names.push_back(parameter.name);
  system.free =
      section.texts("free", names, fmt::format("an array of parameters among {}", fmt::join(names, ", ")));
  for (auto one = system.free.begin(); one != system.free.end(); ++one) {
    if (std::find(system.free.begin(), one, *one) != one)
      section.fail("free", fmt::format("it has {} twice", *one));
  }
}

const KeyTable<FormulaPiece>& piece_keys() {
  using PieceKey = Key<FormulaPiece>;
  static const KeyTable<FormulaPiece> keys{
      {PieceKey::special("equations", "table of formulas", "f for the unknowns of which it differs here",
                         formulas("equations", &FormulaPiece::equations), otherwise("as of the model")),
       PieceKey::special(
           "until", "formula", "that vanishes where the piece ends",
           [](FormulaPiece& piece, const TomlSection& section) {
             section.require("until", "a formula as a string");
             piece.until = {"until", text_of(section, {"until", section.table()->get("until")}),
                            section.name("until")};
           },
           required),
       PieceKey::special("reset", "table of formulas", "where unknowns jump to as the piece ends",
                         formulas("reset", &FormulaPiece::reset), otherwise("none jumps"))}};
  return keys;
}

void read_pieces(FormulaSystem& system, const TomlSection& section) {
  const char* const expected = "a table with a table for each piece, by its name";
  section.require("pieces", expected);
  const TomlSection table = section.inside("pieces", expected);
  for (const NamedNode& entry : in_order(table)) {
    FormulaPiece piece{.name = entry.key, .place = table.name(entry.key)};
    piece_keys().read(piece, table.inside(entry.key, "a table of equations, until and reset"));
    system.pieces.push_back(std::move(piece));
  }
  if (system.pieces.empty()) section.mismatch("pieces", expected);
}

void read_cycle(FormulaSystem& system, const TomlSection& section) {
  std::vector<std::string> names;
  for (const FormulaPiece& piece : system.pieces) names.push_back(piece.name);
  system.cycle =
      section.texts("cycle", names, fmt::format("an array of pieces among {}", fmt::join(names, ", ")));
  if (system.cycle.empty()) section.mismatch("cycle", "an array with at least one piece");
}

/// Whether a system is of one of these kinds.
auto of_kinds(std::vector<FormulaKind> kinds) {
  return [kinds = std::move(kinds)](const FormulaSystem& system, const TomlSection&) {
    return std::find(kinds.begin(), kinds.end(), system.kind) != kinds.end();
  };
}

/// Of what is put together of pieces.
std::vector<ModelKey> piecewise_keys() {
  const auto of_pieces = only("only of kind = \"piecewise\"", of_kinds({FormulaKind::piecewise}));
  return {
      ModelKey::special("pieces", "table of tables",
                        "by name, in the order in which they follow each other, each with `until`, a "
                        "formula that vanishes where it ends, and as it needs them `equations` that differ "
                        "there and `reset`, where unknowns jump to at its end",
                        read_pieces, required, of_pieces),
      ModelKey::special("cycle", "list of names", "of pieces, as they follow each other in one period",
                        read_cycle, of_pieces, otherwise("each once"))};
}

void read_period(FormulaSystem& system, const TomlSection& section) {
  section.require("period", "a formula as a string, or a number");
  system.period = {"period", text_of(section, {"period", section.table()->get("period")}),
                   section.name("period")};
}

void read_angles(FormulaSystem& system, const TomlSection& section) {
  std::vector<std::string> names;
  for (const Formula& equation : system.equations) names.push_back(equation.name);
  system.angles = section.texts("angles", names, "an array of unknowns");
}

/// What conditions are on, and they.
std::vector<ModelKey> boundary_keys() {
  const auto of_boundary = only("only of kind = \"boundary\"", of_kinds({FormulaKind::boundary}));
  return {ModelKey::special(
              "interval", "table of two numbers or formulas",
              "what the equations are differentiated by, and its ends, by parameters: { x = [0, 1] }",
              read_interval, required, of_boundary),
          ModelKey::special(
              "conditions", "list of formulas",
              "that vanish, by parameters and values at the ends, `u_left` and `u_right` of each "
              "unknown u",
              formula_list("conditions", "an array of formulas as strings", &FormulaSystem::conditions),
              required, of_boundary),
          ModelKey::special(
              "integrals", "list of formulas", "whose integrals over the interval vanish: conditions as well",
              formula_list("integrals", "an array of formulas as strings", &FormulaSystem::integrals),
              of_boundary, otherwise("none")),
          ModelKey::special(
              "free", "list of names",
              "parameters that are found beside the unknowns, one by each condition more; their values "
              "are guesses",
              read_free, of_boundary, otherwise("none"))};
}

const KeyTable<FormulaSystem>& model_keys() {
  const auto is_map = of_kinds({FormulaKind::map});
  const auto may_be_forced = of_kinds({FormulaKind::forced, FormulaKind::piecewise});
  const auto is_flow = of_kinds({FormulaKind::flow, FormulaKind::forced, FormulaKind::piecewise});
  const auto has_points = of_kinds({FormulaKind::flow, FormulaKind::map, FormulaKind::algebraic});
  static const KeyTable<FormulaSystem> keys{
      {ModelKey::choice(
           "kind", &FormulaSystem::kind,
           {{"flow", FormulaKind::flow},
            {"forced", FormulaKind::forced},
            {"map", FormulaKind::map},
            {"algebraic", FormulaKind::algebraic},
            {"boundary", FormulaKind::boundary},
            {"piecewise", FormulaKind::piecewise}},
           "what the equations are: u' = f with its equilibria and cycles, u' = f with the time "
           "t in f and its "
           "cycles, u -> f and its fixed points, f = 0 without stability, u' = f with conditions at the "
           "ends of an interval, or cycles that are put together of pieces",
           ""),
       ModelKey::special("period", "formula", "of f in t, by parameters; what is forced needs it",
                         read_period, only("only of kind = \"forced\" or \"piecewise\"", may_be_forced),
                         otherwise("nothing depends on t")),
       ModelKey("iterate", &FormulaSystem::iterate, within(1, problems::most_iterates),
                "k: the points that are fixed after k steps of the map", only("only of maps", is_map)),
       ModelKey::special("parameters", "table of numbers",
                         "by name, in the order of columns; any may be continued, and for_each may list it",
                         read_parameters_table, required),
       ModelKey::special("definitions", "table of formulas",
                         "by names that equations and observables use, in any order",
                         formulas("definitions", &FormulaSystem::definitions)),
       ModelKey::special("equations", "table of formulas", "f for each unknown, by its name, in their order",
                         read_equations, required),
       ModelKey::special("angles", "list of names",
                         "unknowns of which whole turns, 2 pi, do not matter: cycles may go round",
                         read_angles, only("only of flows", is_flow), otherwise("none")),
       ModelKey::special("observables", "table of formulas",
                         "columns beside the unknowns, whose extrema may be looked for",
                         formulas("observables", &FormulaSystem::observables),
                         only("not of kind = \"forced\", \"boundary\" or \"piecewise\"", has_points)),
       ModelKey::special(
           "start", "table of formulas or numbers",
           "a guess of the unknowns where the branch begins, by parameters and what is between the "
           "ends of an interval",
           formulas("start", &FormulaSystem::start), otherwise("0 of each")),
       ModelKey::special(
           "scale", "table of numbers > 0",
           "typical magnitudes of unknowns and parameters that are far below 1, by their names: "
           "steps are a part of them",
           read_scale,
           otherwise("1 of each, of a parameter that is continued below 0.01 the largest value"))},
      boundary_keys(),
      piecewise_keys()};
  return keys;
}

/// Whether branches of cycles may be asked for.
bool may_have_cycles(const FormulaSystem& system, const TomlDocument& document) {
  if (system.kind == FormulaKind::forced || system.kind == FormulaKind::piecewise) return true;
  const auto given = [&](const char* place) { return document.root().at_path(place); };
  return system.kind == FormulaKind::flow &&
         (given("cycles.settle") || given("branch.switching").value_or(false));
}

/// Refuses what columns of cycles are called.
void check_cycle_names(const FormulaSystem& system) {
  std::vector<std::string> unknowns;
  std::vector<std::string> parameters;
  std::set<std::string> columns{"norm"};
  for (const FormulaParameter& parameter : system.parameters) parameters.push_back(parameter.name);
  for (const Formula& equation : system.equations) {
    unknowns.push_back(equation.name);
    columns.insert({equation.name + "_max", equation.name + "_min"});
  }
  columns.insert(continuation::duration_name(unknowns, parameters));
  const auto check = [&](const std::string& name, const std::string& place) {
    if (columns.contains(name))
      throw FormulaError(place,
                         fmt::format("results of cycles have {} already; expected another name", name));
  };
  for (const FormulaParameter& parameter : system.parameters) check(parameter.name, parameter.place);
  for (const Formula& equation : system.equations) check(equation.name, equation.place);
}

FormulaSystem read_formulas(const TomlDocument& document) {
  FormulaSystem system;
  const TomlSection section(document, section_name);
  model_keys().read(system, section);
  if (system.kind == FormulaKind::forced) section.require("period", "a formula as a string, or a number");
  return system;
}

/// By how far parameters are continued.
void scale_by_ranges(const TomlDocument& document, FormulaSystem& system) {
  const toml::node_view<const toml::node> branch = document.root()["branch"];
  const auto add = [&](const auto& name, const auto& from, const auto& to) {
    scale_within(system, name.value_or(std::string()), from.value_or(1.0), to.value_or(1.0));
  };
  add(branch["parameter"], branch["from"], branch["to"]);
  add(branch["parameters"][0], branch["window"][0], branch["window"][1]);
  add(branch["parameters"][1], branch["from"], branch["to"]);
}

}  // namespace

bool has_model(const TomlDocument& document) { return document.root().contains(section_name); }

std::vector<KeyWords> model_words() { return model_keys().words(); }

std::shared_ptr<const LibraryModel> read_model_section(const TomlDocument& document) {
  if (document.root().contains("system"))
    document.fail(document.root().get("system"), "system", "not beside [model], which is the system");
  try {
    FormulaSystem system = read_formulas(document);
    scale_by_ranges(document, system);
    if (may_have_cycles(system, document)) check_cycle_names(system);
    return std::make_shared<const LibraryModel>(problems::model_of(system));
  } catch (const FormulaError& error) {
    document.fail(document.root().at_path(error.place()).node(), error.place(), error.why());
  }
}

LibraryModel::Values read_model_values(const TomlDocument& document, const Replacements& replacements,
                                       const LibraryModel& model, const std::string& continued) {
  const TomlSection section(document, parameters_name, &replacements);
  LibraryModel::Values values;
  for (const Setting& setting : model.settings) {
    if (setting.name == continued && replacements.contains(section.name(continued)))
      section.fail(continued, "the continuation parameter has its values from [branch]");
    values.push_back(section.number(setting.name, any_number()));
  }
  return values;
}

std::vector<ListedKey> listed_model_keys(const LibraryModel& model) {
  std::vector<ListedKey> listed;
  for (const Setting& setting : model.settings)
    listed.push_back({setting.name, fmt::format("{}.{}", parameters_name, setting.name), setting.name});
  return listed;
}

void resolve_model(const TomlDocument& document, nlohmann::ordered_json& section) {
  for (auto& [key, value] : section.items()) {
    if (!value.is_object() || key == "interval") continue;
    nlohmann::ordered_json ordered = nlohmann::ordered_json::object();
    for (const NamedNode& entry : in_order(TomlSection(document, fmt::format("{}.{}", section_name, key))))
      ordered[entry.key] = value[entry.key];
    value = std::move(ordered);
  }
  FormulaSystem defaults = read_formulas(document);
  nlohmann::ordered_json values = model_keys().values(defaults);
  if (defaults.kind != FormulaKind::map) values.erase("iterate");
  fill(section, values);
}

}  // namespace arcslip
