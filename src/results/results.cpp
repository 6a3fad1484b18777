#include "arcslip/results/results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "arcslip/assembly/structures.hpp"
#include "arcslip/continuation/cycles/multiplier_form.hpp"
#include "arcslip/continuation/path/symmetric_branches.hpp"
#include "arcslip/continuation/points/codimension_two.hpp"
#include "arcslip/continuation/points/hopf_form.hpp"
#include "arcslip/motion/swing.hpp"
#include "arcslip/problems/response/harmonic_response.hpp"
#include "arcslip/problems/response/nonlinear_mode.hpp"
#include "arcslip/version.hpp"
#include "cases/cycles.hpp"
#include "cases/stored_point.hpp"
#include "results/atlas_table.hpp"
#include "results/branch_columns.hpp"
#include "results/certificate_results.hpp"
#include "results/solution_results.hpp"
#include "results/stability_results.hpp"
#include "results/verification_results.hpp"
#include "sectors/full_receptance.hpp"

namespace arcslip {
namespace {

using continuation::BranchPoint;
using continuation::PointType;
using nlohmann::ordered_json;

/// The groups that [geometry] stands for.
void add_groups(const ProblemRequest& problem, ordered_json& summary) {
  if (!problem.geometry) return;
  const SystemParameters& system = problem.system;
  ordered_json groups = {{"mass_ratio", system.mass_ratio},
                         {"frequency_ratio", system.frequency_ratio},
                         {"interface_stiffness", system.interface_stiffness},
                         {"force", system.force}};
  if (problem.geometry->preload_per_length > 0) groups["preload"] = system.preload;
  summary["groups"] = groups;
}

/// What one of each of the model's quantities is in SI units.
void add_units(const ProblemRequest& problem, ordered_json& summary) {
  if (!problem.physical) return;
  const PhysicalScale& scale = *problem.physical;
  const std::string unit = scale.preload_unit();
  summary["units"] = {{"frequency_Hz", scale.frequency(1)},
                      {"displacement_m", scale.displacement(1)},
                      {"preload_" + unit, scale.preload(1)},
                      {"force_" + unit, scale.force_per_length(1)},
                      {"energy_J", scale.energy(1)}};
}

/// All that a branch may begin from; null of a curve, whose unknowns are not those of its problem, of orbits,
/// which orbits.csv has, of tori, which tori.csv has, and of so many that nobody would read them.
ordered_json state_of(const TracedBranch& traced, const BranchPoint& point) {
  if (traced.curve || orbits_of(traced) != nullptr || torus_of(traced) != nullptr ||
      point.unknowns.size() > most_stored_unknowns)
    return nullptr;
  ordered_json parameters;
  const std::vector<std::string> names = traced.base.problem->parameter_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    parameters[names[i]] = point.parameters(static_cast<Index>(i));
  return {{"regime", digits(point.regime)},
          {"parameters", parameters},
          {"unknowns", fmt::format("{}", fmt::join(point.unknowns, " "))}};
}

/// The first shift and the first mirror of these symmetries, which tell the others.
ordered_json first_of_each(const std::vector<std::string>& names) {
  ordered_json told = ordered_json::array();
  for (const char* kind : {"shift", "mirror"}) {
    const auto first = std::find_if(names.begin(), names.end(),
                                    [&](const std::string& name) { return name.starts_with(kind); });
    if (first != names.end()) told.push_back(*first);
  }
  return told;
}

/// What is lost at branch points at which a whole ring's response loses symmetries.
class Lost {
 public:
  explicit Lost(const TracedBranch& traced) : traced_(traced) {
    const auto is_one = [](const BranchPoint& point) { return point.type == PointType::branch_point; };
    if (traced.curve || std::none_of(traced.branch.points.begin(), traced.branch.points.end(), is_one))
      return;
    std::vector<continuation::Symmetry> all = traced.problem().symmetries();
    if (!all.empty()) group_.emplace(std::move(all));
  }

  void add(const BranchPoint& point, ordered_json& special) const {
    if (!group_ || point.type != PointType::branch_point) return;
    const continuation::LostSymmetries lost =
        continuation::lost_symmetries(traced_.problem(), *group_, point);
    if (lost.names.empty()) return;
    special["null_vectors"] = lost.null_vectors;
    special["breaks"] = first_of_each(lost.names);
  }

 private:
  const TracedBranch& traced_;
  std::optional<continuation::SymmetryGroup> group_;
};

/// How cycles leave a Hopf point.
void add_hopf_form(const TracedBranch& traced, const BranchPoint& point, ordered_json& special) {
  if (traced.curve || point.type != PointType::hopf) return;
  const auto form =
      continuation::hopf_form(traced.problem(), {point.unknowns, point.parameters, point.regime, {}});
  if (!form) return;
  special["omega"] = form->omega;
  if (form->pairs > 1) {
    special["pairs"] = form->pairs;
  } else if (std::isfinite(form->lyapunov)) {
    special["lyapunov"] = form->lyapunov;
  }
}

/// How what leaves a cycle or a fixed point of a map does so.
void add_multiplier_form(const TracedBranch& traced, const BranchPoint& point, ordered_json& special) {
  if (traced.curve) return;
  const auto form = continuation::multiplier_form(traced.problem(), point.type,
                                                  {point.unknowns, point.parameters, point.regime, {}});
  if (form) special["coefficient"] = form->coefficient;
}

/// What happens around a special point of a curve of folds or of Hopf points.
void add_normal_form(const TracedBranch& traced, const BranchPoint& point, ordered_json& special) {
  if (!traced.curve) return;
  const Index second =
      continuation::index_of(traced.base.problem->parameter_names(), traced.request->options.parameter);
  const auto form = continuation::codimension_two_form(*traced.curve, second, point);
  if (!form) return;
  ordered_json& told = special["normal_form"];
  for (const continuation::Coefficient& one : form->coefficients) told[one.name] = one.value;
  if (point.type == PointType::cusp) told["regular"] = form->is_regular;
  told["error"] = form->error;
}

/// Of a cycle, the largest first; where a torus leaves it, by how much this turns in each period.
void add_multipliers(const TracedBranch& traced, const BranchPoint& point, ordered_json& special) {
  const continuation::OrbitProblem* orbits = orbits_of(traced);
  if (orbits == nullptr || orbits->pair_crossing() != PointType::neimark_sacker) return;
  ComplexVector logs = orbits->log_multipliers(point.unknowns, point.parameters, point.regime);
  std::sort(logs.begin(), logs.end(), [](const Complex& a, const Complex& b) {
    return std::pair(-a.real(), -a.imag()) < std::pair(-b.real(), -b.imag());
  });
  ordered_json multipliers = ordered_json::array();
  for (const Complex& log : logs) {
    const Complex multiplier = std::exp(log);
    multipliers.push_back({multiplier.real(), multiplier.imag()});
  }
  special["multipliers"] = std::move(multipliers);
  const bool has_one = point.type == PointType::fold || point.type == PointType::period_doubling ||
                       point.type == PointType::neimark_sacker;
  if (has_one && logs.size() > 0 && !continuation::has_critical_multiplier(point.type, logs))
    special["resolved"] = false;
  if (point.type != PointType::neimark_sacker || logs.size() == 0) return;
  const auto crosses = std::min_element(logs.begin(), logs.end(), [](const Complex& a, const Complex& b) {
    const auto off = [](const Complex& log) { return std::abs(log.real()) + (log.imag() > 0 ? 0 : pi); };
    return off(a) < off(b);
  });
  special["angle"] = crosses->imag();
}

ordered_json special_points(const TracedBranch& traced) {
  Columns columns(traced);
  const Lost lost(traced);
  const PhysicalColumns physical(traced);
  ordered_json listed = ordered_json::array();
  for (std::size_t i = 0; i < traced.branch.points.size(); ++i) {
    const BranchPoint& point = traced.branch.points[i];
    if (point.type == PointType::regular) continue;
    const std::vector<double>& values = columns.values(point);
    ordered_json special = {{"type", point.type_name()}, {"point", i}};
    for (const Index k : columns.shown())
      special[columns.names()[static_cast<std::size_t>(k)]] = values[static_cast<std::size_t>(k)];
    const std::vector<double> in_units = physical.values(values);
    for (const std::size_t k : physical.shown()) special[physical.names()[k]] = in_units[k];
    if (const std::optional<double> moved = moved_by(traced, point)) special["moved_by"] = *moved;
    lost.add(point, special);
    add_hopf_form(traced, point, special);
    add_normal_form(traced, point, special);
    add_multiplier_form(traced, point, special);
    add_multipliers(traced, point, special);
    if (ordered_json state = state_of(traced, point); !state.is_null()) special["state"] = std::move(state);
    listed.push_back(std::move(special));
  }
  return listed;
}

/// The highest peak of Y; null without one, and for curves, of which it would not be one.
ordered_json highest_peak(const TracedBranch& traced, const ordered_json& special) {
  const ordered_json* best = nullptr;
  for (const ordered_json& point : special) {
    if (traced.curve || point["type"] != "peak" || !point.contains("Y")) continue;
    if (best == nullptr || point["Y"] > (*best)["Y"]) best = &point;
  }
  if (best == nullptr) return nullptr;
  return {{"eta", (*best)["eta"]}, {"Y", (*best)["Y"]}, {"R_over_S", (*best)["R_over_S"]}};
}

ordered_json modes_to_json(const std::vector<PartModes>& found) {
  ordered_json parts = ordered_json::object();
  for (const PartModes& one : found) {
    ordered_json& part = parts[one.part] = {{"dofs", one.dofs}, {"modes", one.modes}};
    if (!one.is_solved) {
      part["error"] = one.error;
      part["error_eta"] = one.error_eta;
      part["check_etas"] = one.check_etas;
    }
    part["factorisations"] = one.factorisations;
  }
  return parts;
}

/// In multiples of eta.
ordered_json harmonics_of(const std::vector<int>& orders) {
  if (orders.front() == 1) return orders;
  std::vector<double> multiples;
  for (const int h : orders) multiples.push_back(static_cast<double>(h) / orders.front());
  return multiples;
}

}  // namespace

namespace {

/// The symmetries that all points of a branch have, by the first shift and the first mirror that tell the
/// others, and of how many images it is one.
void add_symmetries(const TracedBranch& traced, ordered_json& summary) {
  if (traced.branch.points.empty()) return;
  const continuation::Problem& problem = traced.problem();
  const std::vector<continuation::Symmetry> all = problem.symmetries();
  if (all.empty()) return;
  constexpr double same = 1e-6;
  std::vector<bool> kept(all.size(), true);
  for (const continuation::BranchPoint& point : traced.branch.points) {
    Vector scale(point.unknowns.size());
    Vector parameter_scale(point.parameters.size());
    problem.scale(point.unknowns, point.parameters, scale, parameter_scale);
    const std::vector<bool> here = continuation::kept_symmetries(all, point.unknowns, scale, same);
    for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = kept[i] && here[i];
  }
  const auto count = static_cast<std::size_t>(std::count(kept.begin(), kept.end(), true));
  std::vector<std::string> names;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (kept[i]) names.push_back(all[i].name);
  }
  summary["symmetries"] = first_of_each(names);
  summary["images"] = (all.size() + 1) / (count + 1);
}

}  // namespace

ordered_json summarize(std::size_t number, const TracedBranch& traced) {
  const ordered_json special = special_points(traced);
  const continuation::Work& work = traced.branch.work;
  ordered_json summary = {{"branch", number},
                          {"values", traced.request->values},
                          {"points", traced.branch.points.size()},
                          {"stop", to_string(traced.branch.stop)},
                          {"explanation", traced.branch.explanation}};
  add_groups(traced.request->problem, summary);
  add_units(traced.request->problem, summary);
  const SystemParameters& system = traced.request->problem.system;
  const std::vector<PartModes> found = structures_of(system).modes(system);
  if (!found.empty()) summary[found.front().is_solved ? "full_solves" : "reduction"] = modes_to_json(found);
  if (traced.request->problem.model == nullptr) summary["harmonics"] = harmonics_of(traced.base.harmonics);
  if (traced.branch.first_stop) {
    summary["first_stop"] = to_string(*traced.branch.first_stop);
    summary["first_explanation"] = traced.branch.first_explanation;
  }
  if (why_not_verifiable(*traced.request).empty()) {
    const std::optional<problems::BalanceErrors> errors = problems::largest_errors(
        traced.request->problem.system, traced.base.harmonics, traced.branch, traced.request->options.go_on);
    summary["power_error"] = errors ? ordered_json(errors->power) : ordered_json(nullptr);
    summary["power_cancellation"] = errors ? ordered_json(errors->cancellation) : ordered_json(nullptr);
    summary["motion_error"] = errors ? ordered_json(errors->motion) : ordered_json(nullptr);
  }
  add_symmetries(traced, summary);
  summary["special"] = special;
  summary["peak"] = highest_peak(traced, special);
  summary["work"] = {{"evaluations", work.evaluations},
                     {"factorizations", work.factorizations},
                     {"iterations", work.iterations},
                     {"rejected_steps", work.rejected_steps}};
  summary["seconds"] = traced.seconds;
  if (traced.solutions) summary["solutions"] = solutions_to_json(*traced.solutions);
  if (traced.surface) summary["surface"] = surface_to_json(traced);
  if (traced.certificate) summary["certificate"] = certificate_to_json(*traced.certificate);
  return summary;
}

ordered_json summary_of_failed(std::size_t number, const CaseBranch& request, const std::string& why) {
  return {{"branch", number},   {"values", request.values},
          {"points", 0},        {"stop", to_string(continuation::Stop::no_start)},
          {"explanation", why}, {"special", ordered_json::array()},
          {"peak", nullptr}};
}

ordered_json summarize(const Case& input, const std::vector<TracedBranch>& traced, double seconds) {
  ordered_json branches = ordered_json::array();
  for (std::size_t number = 0; number < traced.size(); ++number)
    branches.push_back(summarize(number, traced[number]));
  return {{"arcslip", release},
          {"title", input.title},
          {"case", input.resolved},
          {"branches", branches},
          {"seconds", seconds}};
}

std::string describe_groups(const ProblemRequest& problem) {
  const SystemParameters& system = problem.system;
  std::string text = fmt::format("M* = {:.6g}, gamma = {:.6g}, K_FD = {:.6g}, F = {:.6g}", system.mass_ratio,
                                 system.frequency_ratio, system.interface_stiffness, system.force);
  if (problem.geometry && problem.geometry->preload_per_length > 0)
    text += fmt::format(", P = {:.6g}", system.preload);
  return text;
}

std::string describe_units(const ProblemRequest& problem) {
  const SystemParameters& system = problem.system;
  const PhysicalScale& scale = problem.physical.value();
  const auto n = static_cast<double>(system.wave_number);
  const double damper = system.model == StructureModel::rods ? n : n * n;
  return fmt::format(
      "eta = 1: {:.6g} Hz, P = 1: {:.6g} N/m, Y = 1: {:.6g} m; resonances alone: base {:.6g} Hz, damper "
      "{:.6g} Hz",
      scale.frequency(1), scale.preload(1), scale.displacement(1),
      scale.frequency(damper * system.frequency_ratio), scale.frequency(damper));
}

std::string describe_modes(const SystemParameters& system) {
  std::string text;
  for (const PartModes& one : structures_of(system).modes(system)) {
    if (!text.empty()) text += "\n  ";
    if (one.is_solved) {
      text += fmt::format("{}: full path, {} dofs solved for at each eta; {} modes show the resonances",
                          one.part, one.dofs, one.modes);
      continue;
    }
    text += fmt::format(
        "{}: {} of {} modes, error {:.1e}{} against the full solve at {} eta, at worst at eta = {:g}; {} "
        "factorisations",
        one.part, one.modes, one.dofs, one.error,
        one.error > one.tolerance ? " (above reduction_tolerance)" : "", one.check_etas.size(), one.error_eta,
        one.factorisations);
  }
  return text;
}

std::string describe_harmonics(const TracedBranch& traced) {
  const std::vector<int> orders = traced.base.harmonics;
  if (orders.size() == 1) return "";
  const int periods = orders.front();
  const std::string over =
      periods > 1 ? fmt::format(" of a response over {} periods of the load", periods) : "";
  return fmt::format("{} harmonics{}, up to {}\n", orders.size(), over, highest_order(orders) / periods);
}

}  // namespace arcslip
