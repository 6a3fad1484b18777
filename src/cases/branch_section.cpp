#include "cases/branch_section.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cases/continuation_section.hpp"
#include "cases/cycles_section.hpp"
#include "cases/stored_point.hpp"
#include "cases/system_section.hpp"
#include "cases/unit_names.hpp"

namespace arcslip {
namespace {

using continuation::PointType;
using continuation::TraceOptions;

/// The parameters that may be continued.
std::vector<std::string> parameters_of(const ProblemRequest& problem) {
  if (problem.model != nullptr)
    return problem.model->build(problems::defaults(*problem.model))->parameter_names();
  return problem.response->parameters;
}

/// These, under names with units as well where they have any.
std::vector<std::string> names_of_parameters(const ProblemRequest& problem) {
  std::vector<std::string> names = parameters_of(problem);
  if (problem.model == nullptr) add_unit_names(names);
  return names;
}

/// Whether a name may be one of a part of a system that is not yet known: `K_FD_2`, or `stops.gap`.
bool may_be_of_part(const std::string& name) {
  const std::size_t digits = name.find_last_not_of("0123456789") + 1;
  const std::string stem = name.substr(0, digits);
  return (digits < name.size() && (stem == "K_FD_" || stem == "L_")) || name.find('.') != std::string::npos;
}

/// Names of parameters that may be continued, of which those of parts are looked up with the system.
std::vector<std::string> names_with(std::vector<std::string> names, const CaseBranch& branch,
                                    const std::vector<std::string>& given) {
  if (branch.problem.model != nullptr) return names;
  std::copy_if(given.begin(), given.end(), std::back_inserter(names), may_be_of_part);
  return names;
}

/// What a parameter is called without its unit; one of a model's own may be called as it likes.
std::string parameter_of(const CaseBranch& branch, const std::string& name, const TomlSection& section) {
  return branch.problem.model != nullptr ? name : parameter_named(name, section.document());
}

std::vector<std::string> curve_names() {
  return {"fold",       "branch_point",    "hopf",          "peak",
          "trough",     "switch",          "level",         "phase_resonance",
          "cycle_fold", "period_doubling", "neimark_sacker"};
}

bool of_friction(const CaseBranch& branch, const TomlSection& /*section*/) {
  return branch.problem.model == nullptr;
}
bool is_curve(const CaseBranch& branch, const TomlSection& /*section*/) { return branch.curve.has_value(); }
bool is_branch(const CaseBranch& branch, const TomlSection& /*section*/) { return !branch.curve; }
bool is_no_curve(const CaseBranch& branch, const TomlSection& /*section*/) {
  return !branch.curve || branch.curve->is_surface();
}

void read_surface(CaseBranch& branch, const TomlSection& section) {
  if (!section.boolean("surface")) return;
  const problems::LibraryModel* model = branch.problem.model.get();
  if (model != nullptr && (model->orbit || model->is_driven))
    section.fail("surface", "not of cycles and of boundary value problems");
  branch.curve.emplace();
  branch.curve->name = "surface";
  branch.curve->type = PointType::regular;
}

void read_parameters(CaseBranch& branch, const TomlSection& section) {
  const std::vector<std::string> names = names_of_parameters(branch.problem);
  const std::string expected = fmt::format("two different names among \"{}\"", fmt::join(names, "\", \""));
  const std::vector<std::string> allowed =
      names_with(names, branch, section.texts("parameters", {}, expected));
  const std::vector<std::string> given = section.texts("parameters", allowed, expected);
  std::vector<std::string> pair;
  std::transform(given.begin(), given.end(), std::back_inserter(pair),
                 [&](const std::string& name) { return parameter_of(branch, name, section); });
  if (pair.size() != 2 || pair[0] == pair[1]) section.mismatch("parameters", expected);
  const auto is_own = [&](const std::string& name) { return name == names[0] || name == names[1]; };
  if (branch.problem.model == nullptr && !is_own(pair[0]) && !is_own(pair[1]))
    section.mismatch("parameters", fmt::format("\"{}\" or \"{}\" as one of them", names[0], names[1]));
  if (branch.curve->is_backbone() && pair[0] != "eta")
    section.mismatch("parameters", "\"eta\" and another one: phase resonances are looked for over eta");
  branch.curve->active = pair[0];
  branch.curve->named = given[0];
  branch.options.parameter = pair[1];
  branch.named = given[1];
}

void read_curve(CaseBranch& branch, const TomlSection& section) {
  static const std::vector<std::string> names = curve_names();
  CurveRequest& curve = branch.curve.emplace();
  curve.name = section.text("curve", names);
  curve.type = continuation::point_type(curve.name).value_or(PointType::event);
  curve.of_cycles =
      curve.name == "cycle_fold" || curve.name == "period_doubling" || curve.name == "neimark_sacker";
  if (curve.name == "cycle_fold") curve.type = PointType::fold;
  if (curve.of_cycles && branch.problem.model == nullptr)
    section.fail("curve", "of cycles only of flows by [model] or of the library");
  if (curve.type == PointType::event) curve.level.emplace();
  if (!curve.is_backbone()) return;
  if (branch.problem.model != nullptr || branch.problem.response->has_own_frequency())
    section.fail("curve", "phase_resonance is only of forced and one-way responses");
  *curve.level = {"lag", 0.5 * pi};
}

bool is_level(const CaseBranch& branch, const TomlSection& /*section*/) {
  return branch.curve && branch.curve->name == "level";
}

void read_window(CaseBranch& branch, const TomlSection& section) {
  CurveRequest& curve = *branch.curve;
  const std::string expected = "two different numbers, the range of " + curve.active;
  section.require("window", expected);
  const std::vector<double> window =
      section.numbers("window", parameter_rule(branch.problem.model.get(), curve.active));
  if (window.size() != 2 || window[0] == window[1]) section.mismatch("window", expected);
  curve.from = window[0];
  curve.to = window[1];
  curve.window = {std::min(curve.from, curve.to), std::max(curve.from, curve.to)};
}

NumberRule rule_of_parameter(const CaseBranch& branch) {
  return parameter_rule(branch.problem.model.get(), branch.options.parameter);
}

NumberRule rule_of_range(const CaseBranch& branch) {
  const auto [low, high] = std::minmax({branch.options.from, branch.options.to});
  return within(low, high);
}

void check_range(const CaseBranch& branch, const TomlSection& section) {
  if (branch.options.from == branch.options.to)
    section.mismatch("to", "a number that differs from branch.from");
}

void read_from_point(CaseBranch& branch, const TomlSection& section) {
  const continuation::TraceOptions& options = branch.options;
  branch.stored = read_stored_point(section);
  const auto value = branch.stored->parameters.find(options.parameter);
  if (value == branch.stored->parameters.end())
    section.fail("from_point", fmt::format("the point has no {}", options.parameter));
  branch.start = value->second;
}

/// Once for all unknowns, or for each; of how many there are nothing is known yet.
void read_box(CaseBranch& branch, const TomlSection& section) {
  branch.box = section.numbers("box", any_number());
  const std::size_t count = branch.box.size();
  bool fits = count > 0 && count % 2 == 0;
  for (std::size_t i = 0; fits && i < count; i += 2) fits = branch.box[i] < branch.box[i + 1];
  if (!fits)
    section.mismatch("box", "lowest and highest value of all unknowns, or of each in turn, as [-1, 1, 0, 5]");
}

void check_all(const CaseBranch& branch, const TomlSection& section) {
  if (!branch.all_solutions) return;
  if (!branch.curve) section.require("start", "the value of the parameter to find all solutions at");
  const problems::LibraryModel* model = branch.problem.model.get();
  if (model != nullptr && (model->is_driven || model->orbit))
    section.fail("all_solutions", "not of orbits, which begin with the one next to a guess");
}

void read_extrema(CaseBranch& branch, const TomlSection& section) {
  const char* expected = "the one observable whose extrema the curve is made of";
  const bool curve = branch.curve.has_value();
  const bool is_line = curve && !branch.curve->is_surface();
  const bool ridge =
      curve && (branch.curve->type == PointType::peak || branch.curve->type == PointType::trough);
  std::vector<std::string>& observables = branch.options.extrema_of;
  if (section.has("extrema_of")) {
    observables = section.texts("extrema_of", {}, "an array of observables");
    if (is_line && !ridge) section.fail("extrema_of", "only beside curves of peaks or troughs");
  } else if (branch.problem.model == nullptr && !branch.problem.response->extremum.empty()) {
    const bool is_whole = section.document().root().contains("ring");
    observables = {is_whole ? "Y_max" : branch.problem.response->extremum};
  }
  if (ridge && observables.empty()) section.require("extrema_of", expected);
  if (ridge && observables.size() != 1) section.mismatch("extrema_of", expected);
}

using BranchKey = Key<CaseBranch>;

const auto not_beside_curve =
    only("not beside curve, which has parameters and a window", is_branch, "not beside curve");
const auto beside_curves_that_meet = only("beside curve only of \"fold\", \"hopf\" or special cycles",
                                          [](const CaseBranch& branch, const TomlSection&) {
                                            return !branch.curve || branch.curve->name == "fold" ||
                                                   branch.curve->name == "hopf" || branch.curve->of_cycles;
                                          });
const auto beside_curve = only("only beside curve or surface", is_curve);
const auto beside_neither = only("not beside curve", is_no_curve, "not beside curve");
const auto with_friction = only("only for systems with friction", of_friction);
const auto beside_level = only("only beside curve = \"level\"", is_level);

Choices<const ResponseKind*> response_choices() {
  Choices<const ResponseKind*> all;
  for (const ResponseKind& kind : response_kinds()) all.emplace_back(kind.name, &kind);
  return all;
}

/// What is asked, and what varies.
std::vector<BranchKey> keys_of_request() {
  return {
      BranchKey::choice("response", at(&CaseBranch::problem, &ProblemRequest::response), response_choices(),
                        "what is asked of a system with friction", "", with_friction),
      BranchKey::special("curve", one_of(curve_names()), "a curve of such points in two parameters",
                         read_curve),
      BranchKey::special("surface", "true or false", "all solutions over two parameters, as triangles",
                         read_surface, not_beside_curve),
      BranchKey::special(
          "level_of", "name", "the observable that has a given value along the curve",
          [](CaseBranch& branch, const TomlSection& section) {
            branch.curve->level->observable = section.text("level_of", {});
          },
          required, beside_level),
      BranchKey::special(
          "level", "number", "that value; of phases in radians",
          [](CaseBranch& branch, const TomlSection& section) {
            branch.curve->level->value = section.number("level", any_number());
          },
          required, beside_level),
      BranchKey::special(
          "parameter", "name",
          "what varies: eta, P, in SI units frequency_Hz, preload_N_per_m or preload_N; F, zeta_B, zeta_D, "
          "K_FD, P_2, M*, gamma or cubic_stiffness, of [flutter] influence, of sectors L and the speed of "
          "rotation, "
          "of one contact of several K_FD_2 or L_2, of an element its settings as stops.gap, of nonlinear "
          "modes R in place of "
          "eta, of limit "
          "cycles zeta_B, or a library model's own",
          [](CaseBranch& branch, const TomlSection& section) {
            const std::vector<std::string> names = names_of_parameters(branch.problem);
            const toml::node& node = section.require("parameter", one_of(names));
            const std::string given = node.value<std::string>().value_or("");
            branch.named = section.text("parameter", names_with(names, branch, {given}));
            branch.options.parameter = parameter_of(branch, branch.named, section);
          },
          needed("required", lacks("parameters")), not_beside_curve),
      BranchKey::special(
          "parameters", "two names",
          "of a curve: its first points are looked for over the first, at the second of `[system]`; of a "
          "surface, which begins at both of `[system]` if they are within the ranges",
          read_parameters, required, beside_curve),
      BranchKey::special("window", "two numbers",
                         "range of the first parameter of a curve, searched from its first value on",
                         read_window, required, beside_curve)};
}

/// The range, and what is fixed.
std::vector<BranchKey> keys_of_range() {
  return {
      BranchKey("from", at(&CaseBranch::options, &TraceOptions::from), {"", rule_of_parameter},
                "first value of the parameter, of a curve of the second one", required),
      BranchKey("to", at(&CaseBranch::options, &TraceOptions::to), {"", rule_of_parameter},
                "last value, on which a branch ends", required, then(check_range)),
      BranchKey("eta", at(&CaseBranch::problem, &ProblemRequest::eta), positive(),
                "the fixed frequency where P varies; of nonlinear modes one near theirs", with_friction,
                parameter("eta"), unresolved),
      BranchKey("frequency_Hz", at(&CaseBranch::problem, &ProblemRequest::eta), positive(),
                "the same in Hz, of systems in SI units", with_friction, parameter("eta"), unresolved,
                unit("Hz")),
      BranchKey("R", at(&CaseBranch::problem, &ProblemRequest::R), positive(),
                "the fixed amplitude of nonlinear modes where R does not vary", with_friction, unresolved),
      BranchKey::special(
          "for_each", "table, or list of tables",
          "one branch for each value of keys of `[system]` and `[geometry]`, or of eta or frequency_Hz", {})};
}

/// From where and how branches are traced, and what is looked for on them.
std::vector<BranchKey> keys_of_ways() {
  return {BranchKey::flag(
              "switching", &CaseBranch::switching,
              "follow all branches that meet this one, at branch points and corners, and the cycles of "
              "flows; of curves of folds, Hopf points and special cycles those that they meet or that begin "
              "there",
              beside_curves_that_meet),
          BranchKey("start", &CaseBranch::start, {" from `from` to `to`", rule_of_range},
                    "trace both ways from this value", not_beside_curve),
          BranchKey::special(
              "from_point", "\"DIR:branch/point\"",
              "trace both ways from a special point of the run in DIR, at its value of the parameter",
              read_from_point, not_beside_curve, only("not beside start", lacks("start"))),
          BranchKey::flag(
              "all_solutions", &CaseBranch::all_solutions,
              "find all solutions at `start`, by deflation and by branches in all parameters, say whether "
              "these are all, and trace the branch of each; of a surface where it begins",
              beside_neither, then(check_all)),
          BranchKey::special(
              "box", "two numbers, or two for each unknown",
              "lowest and highest unknowns between which all solutions are found, by proof where "
              "`[model]` has formulas",
              read_box,
              only("only beside all_solutions",
                   [](const CaseBranch& branch, const TomlSection&) { return branch.all_solutions; })),
          BranchKey::special(
              "extrema_of", "list of names",
              "observables whose peaks and troughs are located; of a curve of these the one; of a surface "
              "those whose ridges are told, the first one if none is given",
              read_extrema, needed("`[\"Y\"]` of forced responses", always)),
          BranchKey::flag("stability", at(&CaseBranch::problem, &ProblemRequest::stability),
                          "growth of disturbances in every wave, of forced responses and limit cycles")};
}

}  // namespace

const KeyTable<CaseBranch>& branch_keys() {
  static const KeyTable<CaseBranch> keys{keys_of_request(), keys_of_range(), keys_of_ways()};
  return keys;
}

CaseBranch read_branch(const TomlDocument& document,
                       const std::shared_ptr<const problems::LibraryModel>& model) {
  CaseBranch branch;
  branch.problem.model = model;
  branch_keys().read(branch, TomlSection(document, "branch"));
  continuation_keys().read(branch.options, TomlSection(document, "continuation"));
  cycles_keys().read(branch, TomlSection(document, "cycles"));
  return branch;
}

}  // namespace arcslip
