#include "arcslip/cases/case_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <new>
#include <tuple>

#include "arcslip/assembly/structures.hpp"
#include "arcslip/cases/runs.hpp"
#include "cases/branch_checks.hpp"
#include "cases/branch_section.hpp"
#include "cases/continuation_section.hpp"
#include "cases/cycles.hpp"
#include "cases/cycles_section.hpp"
#include "cases/for_each.hpp"
#include "cases/model_section.hpp"
#include "cases/system_section.hpp"
#include "cases/unit_names.hpp"
#include "keys/toml_reader.hpp"

namespace arcslip {

std::vector<std::string> case_sections() {
  return {"title",   "system", "model",  "geometry", "element",      "excitation",
          "flutter", "ring",   "branch", "study",    "continuation", "cycles"};
}

namespace {

using nlohmann::ordered_json;
using problems::LibraryModel;

using Model = std::shared_ptr<const LibraryModel>;

/// Null for a system with friction.
Model read_model(const TomlDocument& document) {
  if (has_model(document)) return read_model_section(document);
  const TomlSection section(document, "system");
  if (section.table() == nullptr)
    document.fail(nullptr, "system", "missing; expected a section [system] or [model]");
  return {Model(), problems::find_model(section.text("model", model_names(document)))};  // which stays
}

/// What may differ from branch to branch.
std::vector<ListedKey> for_each_keys(const TomlDocument& document, const LibraryModel* model) {
  std::vector<ListedKey> keys = listed_keys(document, model);
  if (model == nullptr) {
    for (const std::string name : {"eta", frequency_name}) keys.push_back({name, "branch." + name});
  }
  return keys;
}

/// The input as it is understood, defaults included, without what belongs to [study].
ordered_json resolve(const TomlDocument& document, const CaseBranch& first,
                     const continuation::TraceOptions& given) {
  ordered_json resolved = to_json(document.root());
  resolved.erase("study");
  resolve_system(document, first.problem, resolved);
  resolved["continuation"].update(continuation_keys().values(given));
  if (resolved.contains("cycles") || asks_for_cycles(first) || has_orbits_alone(first) ||
      (first.problem.model != nullptr && first.switching))
    fill(resolved["cycles"], cycles_keys().values(first));
  return resolved;
}

/// Refuses observables that the problem does not have.
void check_extrema(const TomlSection& branch, const CaseBranch& first) {
  if (!branch.has("extrema_of")) return;
  const std::vector<std::string> names = tracked_observables(first.problem);
  if (names.empty()) branch.fail("extrema_of", "this model has no observables with extrema to look for");
  branch.texts("extrema_of", names, fmt::format("names among \"{}\"", fmt::join(names, "\", \"")));
}

/// Whether a load does work, on a motion that lags behind it.
bool may_tell_lag(const ProblemRequest& problem) {
  return problem.model == nullptr && !problem.response->has_own_frequency() &&
         structures_of(problem.system).whole() == nullptr;
}

/// Refuses levels of what the problem does not have.
void check_level(const TomlSection& branch, const CaseBranch& first) {
  if (!branch.has("level_of")) return;
  ProblemRequest problem = first.problem;
  problem.system.tells_lag = may_tell_lag(problem);
  const std::vector<std::string> names = tracked_observables(problem);
  if (names.empty()) branch.fail("level_of", "this model has no observables with levels to look for");
  branch.text("level_of", names);
}

/// Refuses a stored point of another problem.
void check_stored_point(const TomlSection& branch, const CaseBranch& first) {
  if (!first.stored) return;
  const Index expected = build(first.problem).problem->size();
  const Index size = first.stored->unknowns.size();
  if (size == expected) return;
  branch.fail("from_point",
              fmt::format("the point has {} in place of the problem's {} unknowns", size, expected));
}

/// Refuses what `for_each` or `eta` would set although it is continued, or not a parameter at all.
void check_fixed(const TomlSection& branch, const ForEach& for_each, const std::vector<ListedKey>& listed,
                 const CaseBranch& common, const std::string& parameter) {
  const std::string frequency = for_each.sets(frequency_name) ? frequency_name : frequency_key(branch);
  const bool is_given = branch.has(frequency);
  if (common.problem.response->frequency == ResponseKind::Frequency::own &&
      (is_given || for_each.sets(frequency)))
    branch.fail(is_given ? frequency : "for_each", "a limit cycle has an eta of its own");
  for (const ListedKey& key : listed) {
    if (key.parameter == parameter && parameter != "eta" && for_each.sets(key.name))
      branch.fail("for_each", fmt::format("{} cannot be listed where {} is the continuation parameter",
                                          key.name, parameter));
  }
  if (parameter == "eta" && (is_given || for_each.sets(frequency)))
    branch.fail(is_given ? frequency : "for_each",
                fmt::format("{} is fixed only where parameter = \"P\"", frequency));
}

/// The value of the second parameter at which the first points of a curve are looked for.
void find_seed(const TomlSection& section, CaseBranch& branch) {
  const continuation::TraceOptions& options = branch.options;
  branch.curve->seed = fixed_value(branch.problem, options.parameter);
  const auto [low, high] = std::minmax({options.from, options.to});
  if (branch.curve->seed >= low && branch.curve->seed <= high) return;
  section.fail("from", fmt::format("the curve is looked for at {} = {:g}, which is not between {:g} and {:g}",
                                   options.parameter, branch.curve->seed, low, high));
}

/// The fixed frequency of a set of `for_each`, as it is given.
std::pair<std::string, double> given_frequency(const TomlDocument& document,
                                               const Replacements& replacements) {
  const TomlSection section(document, "branch", &replacements);
  const std::string key = frequency_key(section);
  return {key, section.number(key, positive())};
}

/// Brings ranges that are given in SI units, or as the speed beside an engine order, to the model's.
void take_units(const TomlSection& section, CaseBranch& branch) {
  const auto size = [&](const std::string& name, const char* key) {
    if (branch.problem.model != nullptr) return 1.0;
    const double per_eta = branch.problem.system.rotation.per_eta;
    if (name == speed_name && per_eta != 0) return per_eta;
    return size_of_unit(name, branch.problem.physical, section, branch.curve ? "parameters" : key);
  };
  const double unit = size(branch.named, "parameter");
  if (unit != 1) {
    continuation::TraceOptions& options = branch.options;
    options.from /= unit;
    options.to /= unit;
    if (branch.start && !branch.stored) *branch.start /= unit;
    for (double& value : options.stop_at) value /= unit;
  }
  if (branch.stored) {
    const auto [low, high] = std::minmax({branch.options.from, branch.options.to});
    if (!(*branch.start >= low && *branch.start <= high))
      section.fail("from_point", fmt::format("the point has {} = {:g}, which is not from {:g} to {:g}",
                                             branch.options.parameter, *branch.start, low, high));
  }
  if (!branch.curve) return;
  CurveRequest& curve = *branch.curve;
  const double across = size(curve.named, "parameters");
  for (double* value : {&curve.from, &curve.to, &curve.window.low, &curve.window.high}) *value /= across;
}

/// Ranges of eta that are given as such or, by `named`, as those of the speed under each engine order.
std::pair<double, double> eta_of_speeds(const TomlDocument& document, const ForEach& for_each,
                                        const std::string& named, std::pair<double, double> range) {
  if (named != speed_name) return range;
  std::pair<double, double> orders{std::numeric_limits<double>::infinity(), 0};
  for (const std::size_t i : for_each.samples()) {
    const ForEachSet set = for_each.at(i);
    const double m = TomlSection(document, "system", &set.replacements).number("engine_order", positive());
    orders = {std::min(orders.first, m), std::max(orders.second, m)};
  }
  return {orders.first * range.first, orders.second * range.second};
}

/// The eta that the branches pass; 0 where they are unknown beforehand.
std::pair<double, double> eta_range(const TomlDocument& document, const ForEach& for_each,
                                    const CaseBranch& common, const std::string& parameter) {
  const auto in_eta = [&](const std::string& named, const std::pair<double, double>& range) {
    return eta_of_speeds(document, for_each, named, range);
  };
  if (common.problem.response->has_own_frequency()) return {0, 0};
  if (common.curve && parameter == "eta")
    return in_eta(common.curve->named, {common.curve->window.low, common.curve->window.high});
  if (common.options.parameter == "eta")
    return in_eta(common.named, std::minmax({common.options.from, common.options.to}));
  std::pair<double, double> range{std::numeric_limits<double>::infinity(), 0};
  for (const std::size_t i : for_each.samples()) {
    const ForEachSet set = for_each.at(i);
    const double eta = given_frequency(document, set.replacements).second;
    range = {std::min(range.first, eta), std::max(range.second, eta)};
  }
  return range;
}

/// The speeds that the branches pass; 0 where it is not continued.
std::pair<double, double> speed_range(const CaseBranch& common) {
  if (common.options.parameter == speed_name) return std::minmax({common.options.from, common.options.to});
  if (common.curve && common.curve->active == speed_name)
    return {common.curve->window.low, common.curve->window.high};
  return {0, 0};
}

/// Refuses a range with values that a parameter of the system may not have.
void check_values(const TomlSection& section, const CaseBranch& branch, const SystemParameter& parameter) {
  const bool is_active = branch.curve && branch.curve->active == parameter.name;
  const auto check = [&](const char* key, double value) {
    if (!parameter.allows(value)) section.fail(key, fmt::format("{} may not be {:g}", parameter.name, value));
  };
  check(is_active ? "window" : "from", is_active ? branch.curve->from : branch.options.from);
  check(is_active ? "window" : "to", is_active ? branch.curve->to : branch.options.to);
}

/// The parameter of the system beside eta and P that is continued, or "".
std::string varied_parameter(const TomlSection& section, const CaseBranch& branch) {
  const ProblemRequest& problem = branch.problem;
  if (problem.model != nullptr) return "";
  using Kind = SystemParameter::Kind;
  const std::string active = branch.curve ? branch.curve->active : "";
  const auto fail = [&](const std::string& why) {
    section.fail(branch.curve ? "parameters" : "parameter", why);
  };
  std::string varied;
  for (const std::string& name : {active, branch.options.parameter}) {
    if (name.empty() || name == problem.response->parameters[0] || name == "P") continue;
    try {
      const SystemParameter parameter = system_parameter(problem.system, name);
      if (problem.geometry && (parameter.kind == Kind::contact || parameter.kind == Kind::ratio))
        fail(fmt::format("{} follows from [geometry], whose units it would change", name));
      check_values(section, branch, parameter);
    } catch (const std::invalid_argument& error) {
      fail(error.what());
    }
    varied = name;
  }
  return varied;
}

/// What the branches are made from.
class BranchSource {
 public:
  explicit BranchSource(std::shared_ptr<const TomlDocument> document);

  std::size_t count() const { return for_each_->count(); }
  /// As they are given.
  const continuation::TraceOptions& options() const { return common_.options; }
  CaseBranch branch(std::size_t index) const;
  void check_replaced() const;

  /// The first branch, after a look at all of them. Each key's rule is an interval, so that of very many
  /// branches some tell; what another one may still be ends the run when it is met.
  CaseBranch checked() const;

 private:
  std::shared_ptr<const TomlDocument> document_;
  TomlSection section_;
  Model model_;
  CaseBranch common_;      ///< what is the same in all branches
  std::string parameter_;  ///< of a curve, that of the branch on which its first points are looked for
  std::optional<ForEach> for_each_;
  SystemUse use_{};
};

BranchSource::BranchSource(std::shared_ptr<const TomlDocument> document)
    : document_(std::move(document)), section_(*document_, "branch") {
  TomlSection(*document_, "").allow_only(case_sections());
  const bool has_study = document_->root().contains("study");
  if (section_.table() == nullptr)
    document_->fail(nullptr, "branch",
                    std::string("missing; expected a section [branch]") +
                        (has_study ? "; what [study] asks for is done by arcslip study" : ""));
  model_ = read_model(*document_);
  common_ = read_branch(*document_, model_);
  parameter_ = common_.curve ? common_.curve->active : common_.options.parameter;
  const std::vector<ListedKey> listed = for_each_keys(*document_, model_.get());
  for_each_.emplace(*document_, section_, listed, ForEach::Lists::together);
  if (model_ == nullptr) check_fixed(section_, *for_each_, listed, common_, parameter_);
  use_ = {parameter_, false, model_ == nullptr ? load_structures(*document_) : nullptr};
  use_.is_free = common_.problem.response->has_own_frequency();
  if (use_.structures)
    std::tie(use_.eta_low, use_.eta_high) = eta_range(*document_, *for_each_, common_, parameter_);
  std::tie(use_.speed_low, use_.speed_high) = speed_range(common_);
}

CaseBranch BranchSource::branch(std::size_t index) const {
  auto [values, replacements, made] = for_each_->at(index);
  CaseBranch branch = common_;
  branch.values = std::move(values);
  read_system(*document_, replacements, model_, use_, branch.problem);
  const TomlSection system(*document_, "system", &replacements);
  branch.problem.system.one_way = branch.problem.response->one_way;
  take_units(section_, branch);
  branch.problem.system.varied = varied_parameter(section_, branch);
  branch.problem.system.tells_lag = may_tell_lag(branch.problem) && branch.curve && branch.curve->level &&
                                    branch.curve->level->observable == "lag";
  if (branch.problem.harmonics_tolerance && branch.problem.response->has_own_frequency())
    system.fail("harmonics", "\"auto\" is not for limit cycles and nonlinear modes");
  if (model_ == nullptr && parameter_ != "eta" &&
      branch.problem.response->frequency != ResponseKind::Frequency::own) {
    const auto [key, given] = given_frequency(*document_, replacements);
    branch.problem.eta = given / size_of_unit(key, branch.problem.physical, section_, key);
  }
  if (model_ == nullptr && branch.problem.response->parameters.front() == "R" && parameter_ != "R")
    section_.number("R", positive());
  if (branch.curve) find_seed(section_, branch);
  check_even(system, section_, branch);
  check_amplification(section_, branch);
  check_stability(section_, branch);
  return branch;
}

/// Refuses values that `for_each` takes the place of as it would without it.
void BranchSource::check_replaced() const {
  if (for_each_->keys().empty()) return;
  const ForEachSet lacking = for_each_->lacking();
  ProblemRequest problem = common_.problem;
  read_system(*document_, lacking.replacements, model_, use_, problem);
}

CaseBranch BranchSource::checked() const {
  for (const std::size_t index : for_each_->samples()) branch(index);
  CaseBranch first = branch(0);
  check_extrema(section_, first);
  check_level(section_, first);
  check_stored_point(section_, first);
  check_replaced();
  return first;
}

}  // namespace

CaseFile::CaseFile(const std::string& path, const std::vector<std::string>& settings)
    : document_(std::make_shared<const TomlDocument>(path, settings)) {}

CaseFile CaseFile::of_text(const std::string& name, const std::string& text,
                           const std::vector<std::string>& settings, std::shared_ptr<const CaseParts> parts) {
  return CaseFile(std::make_shared<const TomlDocument>(name, text, settings, std::move(parts)));
}

const std::string& CaseFile::path() const { return document_->path(); }

bool CaseFile::has(const std::string& section) const { return document_->root().contains(section); }

void CaseFile::named(const std::string& section, const std::function<void()>& work) const {
  const std::string place = section == "system" && has_model(*document_) ? "model" : section;
  const auto fail = [&](const std::string& why) {
    document_->fail(document_->root().get(place), place, why);
  };
  try {
    work();
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    fail("there is not enough memory for what it asks for");
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

bool has_section(const std::string& path, const std::string& name, const std::vector<std::string>& settings) {
  return CaseFile(path, settings).has(name);
}

CasePlan plan_case(const CaseFile& file) {
  const auto source = std::make_shared<const BranchSource>(file.document());
  const TomlSection root(*file.document(), "");
  CasePlan plan;
  plan.title = root.has("title") ? root.text("title", {}) : "";
  plan.count = source->count();
  plan.branch = [source](std::size_t index) { return source->branch(index); };
  plan.resolved = resolve(*file.document(), source->checked(), source->options());
  return plan;
}

Case read_case(const std::string& path, const std::vector<std::string>& settings) {
  CasePlan plan = plan_case(CaseFile(path, settings));
  Case result{std::move(plan.title), std::move(plan.resolved), {}};
  for (std::size_t i = 0; i < plan.count; ++i) result.branches.push_back(plan.branch(i));
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
