#include "arcslip/case_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "arcslip/runs.hpp"
#include "system_section.hpp"
#include "toml_reader.hpp"

namespace arcslip {
namespace {

using continuation::PointType;
using nlohmann::ordered_json;
using problems::LibraryModel;

const std::vector<std::string> branch_keys = {"parameter", "parameters",    "from",      "to",    "eta",
                                              "start",     "all_solutions", "switching", "curve", "window",
                                              "response",  "for_each",      "extrema_of"};
const std::vector<std::string> continuation_keys = {"tolerance", "max_step",   "min_step",   "max_points",
                                                    "stop_at",   "stop_after", "max_seconds"};
const std::vector<std::string> curves = {"fold", "branch_point", "hopf", "peak", "trough", "switch"};

/// What differs from branch to branch: one value for each key of `for_each`.
struct ForEach {
  std::vector<std::string> keys;
  std::vector<const toml::array*> values;
  std::size_t count = 1;

  bool sets(const std::string& key) const { return std::find(keys.begin(), keys.end(), key) != keys.end(); }
};

/// The lists of for_each by their keys, those in a table by dotted ones: damper.width.
std::vector<std::pair<std::string, const toml::node*>> lists_of(const TomlDocument& document,
                                                                const std::string& path,
                                                                const std::vector<std::string>& allowed) {
  const TomlSection section(document, path);
  std::vector<std::string> here = allowed;
  for (const std::string& key : allowed) here.push_back(key.substr(0, key.find('.')));
  section.allow_only(here);
  std::vector<std::pair<std::string, const toml::node*>> lists;
  for (const auto& [key, node] : *section.table()) {
    const std::string name(key.str());
    std::vector<std::string> inner;
    for (const std::string& one : allowed) {
      if (one.starts_with(name + ".")) inner.push_back(one.substr(name.size() + 1));
    }
    if (inner.empty()) {
      lists.emplace_back(name, &node);
    } else {
      for (const auto& [rest, list] : lists_of(document, section.name(name), inner))
        lists.emplace_back(name + "." + rest, list);
    }
  }
  return lists;
}

ForEach read_for_each(const TomlDocument& document, const TomlSection& branch, const LibraryModel* model) {
  ForEach result;
  if (!branch.has("for_each")) return result;
  const TomlSection section(document, "branch.for_each");
  std::vector<std::string> allowed = listed_keys(document, model);
  if (model == nullptr) allowed.emplace_back("eta");
  for (const auto& [name, node] : lists_of(document, "branch.for_each", allowed)) {
    const toml::array* list = node->as_array();
    if (list == nullptr || list->empty())
      document.mismatch(*node, section.name(name), "an array with at least one value");
    if (!result.keys.empty() && list->size() != result.count) {
      document.fail(
          node, section.name(name),
          fmt::format("expected {} values, as many as {} has (the lists are walked together), got {}",
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
    const std::string path = key == "eta" ? "branch.eta" : path_of(key);
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

/// One special point by its name, or a table of names and counts.
std::vector<continuation::StopAfter> read_stop_after(const TomlDocument& document,
                                                     const TomlSection& section) {
  constexpr const char* expected =
      "the type of a special point, or a table of types and counts: \"fold\", { fold = 2, peak = 5 }";
  std::vector<continuation::StopAfter> rules;
  if (!section.has("stop_after")) return rules;
  const toml::node& node = section.require("stop_after", expected);
  const auto type_of = [&](const std::string& name, const toml::node& place, const std::string& key) {
    const auto type = continuation::point_type(name);
    if (!type || *type == PointType::regular || *type == PointType::start || *type == PointType::end)
      document.fail(&place, key, fmt::format("unknown type '{}'; expected {}", name, expected));
    return *type;
  };
  if (const toml::table* table = node.as_table()) {
    const TomlSection counts(document, "continuation.stop_after");
    for (const auto& [key, value] : *table) {
      const std::string name(key.str());
      rules.push_back({type_of(name, value, counts.name(name)),
                       counts.integer(name, 1, std::numeric_limits<int>::max(), "an integer >= 1"),
                       {}});
    }
    return rules;
  }
  const auto name = node.value_exact<std::string>();
  if (!name) section.mismatch("stop_after", expected);
  rules.push_back({type_of(*name, node, section.name("stop_after")), 1, {}});
  return rules;
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
  options.max_seconds = section.number("max_seconds", positive(), options.max_seconds);
  options.stop_after = read_stop_after(document, section);
  return options;
}

const LibraryModel* read_model(const TomlDocument& document) {
  const TomlSection section(document, "system");
  if (section.table() == nullptr) document.fail(nullptr, "system", "missing; expected a section [system]");
  return problems::find_model(section.text("model", model_names()));
}

/// The parameters that may be continued.
std::vector<std::string> parameters_of(const LibraryModel* model, bool limit_cycle) {
  if (model != nullptr) return model->build(problems::defaults(*model))->parameter_names();
  return limit_cycle ? std::vector<std::string>{"zeta_B", "P"} : std::vector<std::string>{"eta", "P"};
}

/// Reads [branch] but for what `for_each` may change.
class BranchSection {
 public:
  BranchSection(const TomlDocument& document, const TomlSection& section, const LibraryModel* model)
      : document_(document), section_(section), model_(model) {}

  CaseBranch read(const continuation::TraceOptions& options) {
    CaseBranch branch;
    branch.options = options;
    if (section_.has("response")) {
      if (model_ != nullptr) section_.fail("response", "only for systems with friction");
      branch.problem.limit_cycle = section_.text("response", {"forced", "limit_cycle"}) == "limit_cycle";
    }
    names_ = parameters_of(model_, branch.problem.limit_cycle);
    if (section_.has("curve")) {
      read_curve(branch);
    } else {
      for (const char* key : {"parameters", "window"}) {
        if (section_.has(key)) section_.fail(key, "only beside curve");
      }
      branch.options.parameter = section_.text("parameter", names_);
    }
    read_range(branch);
    read_extrema(branch);
    return branch;
  }

 private:
  void read_curve(CaseBranch& branch) {
    for (const char* key : {"parameter", "start", "all_solutions", "switching"}) {
      if (section_.has(key)) section_.fail(key, "not beside curve, which has parameters and a window");
    }
    CurveRequest curve{};
    curve.type = *continuation::point_type(section_.text("curve", curves));
    const std::string expected = fmt::format("two different names among \"{}\"", fmt::join(names_, "\", \""));
    const std::vector<std::string> pair = section_.texts("parameters", names_, expected);
    if (pair.size() != 2 || pair[0] == pair[1]) section_.mismatch("parameters", expected);
    curve.active = pair[0];
    branch.options.parameter = pair[1];
    section_.require("window", "two different numbers, the range of " + curve.active);
    const std::vector<double> window = section_.numbers("window", parameter_rule(model_, curve.active));
    if (window.size() != 2 || window[0] == window[1])
      section_.mismatch("window", "two different numbers, the range of " + curve.active);
    curve.from = window[0];
    curve.to = window[1];
    curve.window = {std::min(curve.from, curve.to), std::max(curve.from, curve.to)};
    branch.curve = curve;
  }

  void read_range(CaseBranch& branch) {
    continuation::TraceOptions& options = branch.options;
    const NumberRule rule = parameter_rule(model_, options.parameter);
    options.from = section_.number("from", rule);
    options.to = section_.number("to", rule);
    if (options.from == options.to) section_.mismatch("to", "a number that differs from branch.from");
    const NumberRule in_range =
        within(std::min(options.from, options.to), std::max(options.from, options.to));
    options.stop_at = TomlSection(document_, "continuation").numbers("stop_at", in_range);
    if (section_.has("start")) branch.start = section_.number("start", in_range);
    branch.switching = section_.boolean("switching", false);
    branch.all_solutions = section_.boolean("all_solutions", false);
    if (branch.all_solutions)
      section_.require("start", "the value of the parameter to find all solutions at");
    if (branch.start && branch.switching)
      section_.fail("start", "not beside switching, which follows the branch that begins at branch.from");
  }

  void read_extrema(CaseBranch& branch) {
    if (section_.has("extrema_of")) {
      branch.options.extrema_of = section_.texts("extrema_of", {}, "an array of observables");
    } else if (model_ == nullptr && !branch.problem.limit_cycle) {
      branch.options.extrema_of = {"Y"};
    }
    if (!branch.curve) return;
    const char* expected = "the one observable whose extrema the curve is made of";
    const bool ridge = branch.curve->type == PointType::peak || branch.curve->type == PointType::trough;
    if (!ridge && section_.has("extrema_of"))
      section_.fail("extrema_of", "only beside curves of peaks or troughs");
    if (ridge && branch.options.extrema_of.empty()) section_.require("extrema_of", expected);
    if (ridge && branch.options.extrema_of.size() != 1) section_.mismatch("extrema_of", expected);
  }

  const TomlDocument& document_;
  const TomlSection& section_;
  const LibraryModel* model_;
  std::vector<std::string> names_;
};

/// The input as it is understood, defaults included.
ordered_json resolve(const TomlDocument& document, const Case& built) {
  ordered_json resolved = to_json(document.root());
  const CaseBranch& first = built.branches.front();
  resolve_system(first.problem, resolved["system"]);
  ordered_json& continuation = resolved["continuation"];
  continuation["tolerance"] = first.options.tolerance;
  continuation["max_step"] = first.options.max_step;
  continuation["min_step"] = first.options.min_step;
  continuation["max_points"] = first.options.max_points;
  continuation["stop_at"] = first.options.stop_at;
  return resolved;
}

/// Refuses observables that the problem does not have.
void check_extrema(const TomlSection& branch, const CaseBranch& first) {
  if (!branch.has("extrema_of")) return;
  const std::vector<std::string> names = tracked_observables(first.problem);
  if (names.empty()) branch.fail("extrema_of", "this model has no observables with extrema to look for");
  branch.texts("extrema_of", names, fmt::format("names among \"{}\"", fmt::join(names, "\", \"")));
}

/// Refuses what `for_each` or `eta` would set although it is continued, or not a parameter at all.
void check_fixed(const TomlSection& branch, const ForEach& for_each, const CaseBranch& common,
                 const std::string& parameter) {
  if (common.problem.limit_cycle && (branch.has("eta") || for_each.sets("eta"))) {
    branch.fail(branch.has("eta") ? "eta" : "for_each", "a limit cycle has an eta of its own");
  }
  for (const char* key : {"preload", "preload_per_length"}) {
    if (parameter == "P" && for_each.sets(key))
      branch.fail("for_each", fmt::format("{} cannot be listed where P is the continuation parameter", key));
  }
  if (parameter != "P" && (branch.has("eta") || for_each.sets("eta"))) {
    branch.fail(branch.has("eta") ? "eta" : "for_each", "eta is fixed only where parameter = \"P\"");
  }
}

}  // namespace

Case read_case(const std::string& path, const std::vector<std::string>& settings) {
  const TomlDocument document(path, settings);
  const TomlSection root(document, "");
  root.allow_only({"title", "system", "geometry", "branch", "continuation"});
  const TomlSection section(document, "branch");
  if (section.table() == nullptr) document.fail(nullptr, "branch", "missing; expected a section [branch]");
  section.allow_only(branch_keys);
  const LibraryModel* model = read_model(document);

  Case result;
  result.title = root.has("title") ? root.text("title", {}) : "";
  const CaseBranch common = BranchSection(document, section, model).read(read_continuation(document));
  // Of a curve, the branch on which its first points are looked for is what counts.
  const std::string& parameter = common.curve ? common.curve->active : common.options.parameter;
  const ForEach for_each = read_for_each(document, section, model);
  if (model == nullptr) check_fixed(section, for_each, common, parameter);
  if (model != nullptr && section.has("eta")) section.fail("eta", "only for systems with friction");
  for (std::size_t i = 0; i < for_each.count; ++i) {
    const Replacements replacements = replacements_of(for_each, i);
    CaseBranch branch = common;
    branch.values = values_of(for_each, i);
    read_system(document, replacements, {model, parameter}, branch.problem);
    if (model == nullptr && parameter == "P" && !branch.problem.limit_cycle)
      branch.problem.eta = TomlSection(document, "branch", &replacements).number("eta", positive());
    if (branch.curve) {
      branch.curve->seed = fixed_value(branch.problem, branch.options.parameter);
      const double low = std::min(branch.options.from, branch.options.to);
      const double high = std::max(branch.options.from, branch.options.to);
      if (!(branch.curve->seed >= low && branch.curve->seed <= high)) {
        section.fail("from",
                     fmt::format("the curve is looked for at {} = {:g}, which is not between {:g} and {:g}",
                                 branch.options.parameter, branch.curve->seed, low, high));
      }
    }
    result.branches.push_back(std::move(branch));
  }
  check_extrema(section, result.branches.front());
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
