#include "results/case_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "arcslip/cases/runs.hpp"
#include "arcslip/cases/study_case.hpp"
#include "arcslip/continuation/problem/derivative_check.hpp"
#include "arcslip/results/results.hpp"
#include "cases/case_warnings.hpp"
#include "cases/flutter_section.hpp"
#include "cases/ring_section.hpp"
#include "cases/structure_kind.hpp"
#include "keys/printable.hpp"

namespace arcslip {
namespace {

std::string describe(const ProblemRequest& problem) {
  if (problem.model != nullptr) {
    std::string text = fmt::format("{}: {}", problem.model->name, problem.model->title);
    for (std::size_t i = 0; i < problem.settings.size(); ++i)
      text += fmt::format(", {} = {:g}", problem.model->settings[i].name, problem.settings[i]);
    return text;
  }
  std::string text = problem.structure->describe(of_one_sector(problem));
  for (const std::string& more : {flutter_in_words(problem.system), ring_in_words(problem.system)})
    text += more.empty() ? "" : "\n  " + more;
  return text;
}

/// What is held while the branch's parameter runs.
std::string fixed(const CaseBranch& branch) {
  const ProblemRequest& problem = branch.problem;
  if (problem.model != nullptr) return "";
  std::vector<std::string> held;
  for (const std::string& name : {problem.response->parameters.front(), std::string("P")}) {
    if (name != branch.options.parameter)
      held.push_back(fmt::format("{} = {:g}", name, fixed_value(problem, name)));
  }
  return fmt::format(" at {}", fmt::join(held, ", "));
}

std::string describe(const CaseBranch& branch) {
  const continuation::TraceOptions& options = branch.options;
  if (branch.curve && branch.curve->is_surface()) {
    return fmt::format("surface over {} from {:g} to {:g} and {} from {:g} to {:g}", branch.curve->active,
                       branch.curve->from, branch.curve->to, options.parameter, options.from, options.to);
  }
  if (branch.curve) {
    return fmt::format(
        "curve of {} points: {} from {:g} to {:g}, {} from {:g} to {:g}, looked for at {} = {:g}",
        branch.curve->name, branch.curve->active, branch.curve->from, branch.curve->to, options.parameter,
        options.from, options.to, options.parameter, branch.curve->seed);
  }
  std::string text =
      fmt::format("{} from {:g} to {:g}{}", options.parameter, options.from, options.to, fixed(branch));
  const ResponseKind& response = *branch.problem.response;
  if (!response.remark.empty()) text += ", " + response.remark;
  if (response.frequency == ResponseKind::Frequency::guessed)
    text += fmt::format(" near eta = {:g}", branch.problem.eta);
  if (branch.start) text += fmt::format(", both ways from {:g}", *branch.start);
  if (branch.all_solutions) text += ", through every solution found there";
  if (branch.switching) text += ", with the branches that it meets";
  return text;
}

/// How far inside its regime a point lies.
double depth(const continuation::Problem& problem, const continuation::BranchPoint& point) {
  double least = std::numeric_limits<double>::infinity();
  for (int b = 0; b < problem.border_count(point.regime); ++b) {
    least = std::min(least, -problem.border(point.unknowns, point.parameters, point.regime, b, nullptr));
  }
  return least;
}

/// A branch's points by regime, but for those at its borders, where differences would leave it.
std::map<continuation::Regime, std::vector<const continuation::BranchPoint*>> points_inside(
    const TracedBranch& traced) {
  std::map<continuation::Regime, std::vector<const continuation::BranchPoint*>> inside;
  for (const continuation::BranchPoint& point : traced.branch.points) {
    if (depth(*traced.base.problem, point) >= 0.01) inside[point.regime].push_back(&point);
  }
  return inside;
}

/// The worst of all derivatives, in each regime at the median of several points: beside a feature that is
/// narrower than their distance differences are wrong, and at a trivial point any derivative is right.
/// None if the branch has no point.
std::optional<continuation::DerivativeReport> check_derivatives(const TracedBranch& traced) {
  constexpr std::size_t places = 7;
  std::optional<continuation::DerivativeReport> worst;
  for (const auto& [regime, points] : points_inside(traced)) {
    std::vector<continuation::DerivativeReport> reports;
    for (std::size_t i = 0; i < places; ++i) {
      const continuation::BranchPoint& point = *points[i * (points.size() - 1) / (places - 1)];
      reports.push_back(
          continuation::check_derivatives(*traced.base.problem, point.unknowns, point.parameters, regime));
    }
    std::sort(reports.begin(), reports.end(), [](const auto& a, const auto& b) { return a.worst < b.worst; });
    if (!worst || reports[places / 2].worst > worst->worst) worst = reports[places / 2];
  }
  return worst;
}

/// Traces the branch, compares its derivatives and says how exact they are; false if they are not or nobody
/// knows.
bool report_derivatives(const CaseBranch& request, std::string& text) {
  constexpr double exact = 1e-6;  // differences are no better than that where a problem is stiff
  const CaseBranch plain = request.curve ? seed_branch(request) : request;
  const std::vector<TracedBranch> traced = trace(plain);
  const auto report = check_derivatives(traced.front());
  if (!report) {
    const continuation::Branch& branch = traced.front().branch;
    text += fmt::format("  derivatives NOT compared: {}\n",
                        branch.points.empty() ? branch.explanation : "no point lies inside its regime");
    return false;
  }
  text += fmt::format("  derivatives against differences: {:.1e} at worst, {}{}\n", report->worst,
                      report->where, report->worst <= exact ? "" : ": NOT exact");
  return report->worst <= exact;
}

std::string heading(const CaseFile& file, const std::string& title) {
  constexpr std::size_t longest = 200;
  return fmt::format("{}: {}\n", printable(file.path()), title.empty() ? "valid" : printable(title, longest));
}

/// Of very many the first ones and the last one are shown.
constexpr std::size_t most_shown = 100;

void add_warnings(const std::vector<std::string>& warnings, CaseCheck& check) {
  for (const std::string& warning : warnings) {
    check.text += "warning: " + warning + "\n";
    check.warnings.push_back(warning);
  }
}

/// Adds the branches and, if asked for, how exact their derivatives are; false if one is not.
bool check_branches(const CaseFile& file, bool derivatives, CaseCheck& check) {
  const CasePlan plan = plan_case(file);
  std::string& text = check.text;
  text += heading(file, plan.title);
  file.named("system", [&] { add_warnings(warnings_of(plan), check); });
  bool good = true;
  for (std::size_t i = 0; i < plan.count; ++i) {
    if (!derivatives && i == most_shown - 1 && plan.count > most_shown) {
      text += fmt::format("... and {} more, of which the last one is\n", plan.count - i);
      i = plan.count - 1;
    }
    const CaseBranch branch = plan.branch(i);
    file.named("system", [&] { build(branch.problem); });
    const std::string values = arcslip::describe(branch.values);
    text += fmt::format("branch {}{}{}\n  {}\n  {}\n", i, values.empty() ? "" : ": ", values,
                        describe(branch), describe(branch.problem));
    if (branch.problem.geometry) text += fmt::format("  {}\n", describe_units(branch.problem));
    if (derivatives) file.named("system", [&] { good = report_derivatives(branch, text) && good; });
  }
  return good;
}

/// What `for_each` sets on one key, in short.
std::string describe(const std::string& key, const nlohmann::ordered_json& listed) {
  if (listed.is_array()) {
    return fmt::format("{}: {} values, {} to {}", key, listed.size(), listed.front().dump(),
                       listed.back().dump());
  }
  return fmt::format("{}: {} values, {} to {}, {}", key, listed["count"].dump(), listed["from"].dump(),
                     listed["to"].dump(), listed.value("scale", "linear"));
}

std::string describe(const problems::Scatter& scatter) {
  if (scatter.kind == problems::Scatter::Kind::none) return "fixed";
  if (scatter.kind == problems::Scatter::Kind::lognormal)
    return fmt::format("lognormal, {:g}", scatter.deviation);
  return fmt::format("uniform, {:g} to {:g}", scatter.low, scatter.high);
}

std::string describe(const problems::Uncertainty& uncertainty) {
  if (uncertainty.patterns > 0) return fmt::format("{} patterns of each whole ring", uncertainty.patterns);
  return fmt::format("scatter of mu: {}; of the preload: {}; of the force: {}; {} samples, seed {}",
                     describe(uncertainty.friction), describe(uncertainty.preload),
                     describe(uncertainty.force), uncertainty.samples, uncertainty.seed);
}

void check_study(const CaseFile& file, CaseCheck& check) {
  const StudyCase study = read_study(file);
  const problems::PreloadRange& range = study.range;
  std::string& text = check.text;
  text += heading(file, study.title);
  text += fmt::format("study of {} design{}: {} from {:g} to {:g}, peaks between {} = {:g} and {:g}{}\n",
                      study.count, study.count == 1 ? "" : "s", study.preload_as, range.from, range.to,
                      study.frequency_as, range.eta_low, range.eta_high, study.sweep ? "" : ", no sweep.csv");
  if (study.uncertain) text += fmt::format("  {}\n", describe(*study.uncertain));
  file.named("system", [&] { add_warnings(warnings_of(study), check); });
  if (!study.keys.empty()) {
    const nlohmann::ordered_json& for_each = study.resolved["study"]["for_each"];
    for (const std::string& key : study.keys) {
      text += "  " +
              (for_each.is_object() ? describe(key, for_each[key])
                                    : fmt::format("{}: listed design by design", key)) +
              "\n";
    }
  }
  for (const std::size_t i : {std::size_t{0}, study.count - 1}) {
    const StudyDesign design = study.design(i * study.each());
    const ProblemRequest problem = design.problem();
    file.named("system", [&] { build(problem); });
    text += fmt::format("design {}{}{}\n  {}\n", i, design.values.empty() ? "" : ": ",
                        arcslip::describe(design.values), describe(problem));
    if (problem.geometry) text += fmt::format("  {}\n", describe_units(problem));
    if (study.count == 1) break;
  }
}

}  // namespace

CaseCheck check_case(const CaseFile& file, bool derivatives) {
  CaseCheck check;
  const bool study = file.has("study");
  const bool branches = file.has("branch");
  if (study) check_study(file, check);
  if (study && !branches && derivatives)
    throw InputError(file.path() + ": branch: missing; --derivatives compares those of branches");
  check.good = (study && !branches) || check_branches(file, derivatives, check);
  return check;
}

}  // namespace arcslip
