#include "arcslip/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "arcslip/problems/harmonic_response.hpp"
#include "arcslip/problems/nonlinear_mode.hpp"
#include "arcslip/sector_pair.hpp"
#include "certificate_results.hpp"
#include "full_receptance.hpp"
#include "stability_results.hpp"
#include "verification_results.hpp"

namespace arcslip {
namespace {

using continuation::BranchPoint;
using continuation::PointType;
using nlohmann::ordered_json;

/// What a point is described by: parameters and observables by name. Of a curve of special points the active
/// parameter is an observable; it stands among the parameters, in the base's order.
class Columns {
 public:
  explicit Columns(const TracedBranch& traced) : problem_(traced.problem()), request_(*traced.request) {
    names_ = problem_.parameter_names();
    parameters_ = static_cast<Index>(names_.size());
    if (traced.curve) moved_ = traced.curve->active();
    for (const continuation::Observable& observable : problem_.observables()) {
      const bool first = static_cast<Index>(names_.size()) == parameters_;
      names_.insert(first && moved_ >= 0 ? names_.begin() + moved_ : names_.end(), observable.name);
    }
  }

  const std::vector<std::string>& names() const { return names_; }

  /// In the order of the names; valid until the next call.
  const std::vector<double>& values(const BranchPoint& point) {
    problem_.observe(point.unknowns, point.parameters, point.regime, observed_);
    values_.assign(point.parameters.begin(), point.parameters.end());
    if (moved_ >= 0) values_.insert(values_.begin() + moved_, observed_(0));
    values_.insert(values_.end(), observed_.begin() + (moved_ >= 0 ? 1 : 0), observed_.end());
    return values_;
  }

  Index find(const std::string& name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    return found == names_.end() ? -1 : static_cast<Index>(found - names_.begin());
  }

  /// Those that tables and summaries show of a special point.
  std::vector<Index> shown() const {
    std::vector<Index> indices;
    for (const char* name : {"eta", "zeta", "zeta_B", "P", "R_over_S", "Y", "growth", "worst_wave"}) {
      if (const Index i = find(name); i >= 0) indices.push_back(i);
    }
    if (find("R_over_S") >= 0) return indices;
    indices.clear();
    for (Index i = 0; i < static_cast<Index>(names_.size()) && indices.size() < most_shown; ++i) {
      if (!is_constant(names_[static_cast<std::size_t>(i)])) indices.push_back(i);
    }
    return indices;
  }

 private:
  static constexpr std::size_t most_shown = 8;

  /// Whether a parameter is the same on all branches of the case.
  bool is_constant(const std::string& name) const {
    const std::vector<std::string> parameters = problem_.parameter_names();
    return std::find(parameters.begin(), parameters.end(), name) != parameters.end() &&
           name != request_.options.parameter && !request_.values.contains(name);
  }

  const continuation::Problem& problem_;
  const CaseBranch& request_;
  std::vector<std::string> names_;
  Index parameters_ = 0;
  Index moved_ = -1;
  Vector observed_;
  std::vector<double> values_;
};

/// The columns in SI units that a system given in them has besides; none of any other.
class PhysicalColumns {
 public:
  explicit PhysicalColumns(const TracedBranch& traced) {
    const ProblemRequest& problem = traced.request->problem;
    if (!problem.geometry) return;
    scale_.emplace(*problem.geometry, problem.system);
    const Columns columns(traced);
    for (const char* name : {"eta", "P", "R", "S", "Y", "U", "dissipated"})
      sources_.push_back(static_cast<std::size_t>(columns.find(name)));
    names_ = {"frequency_Hz", "preload_N_per_m", "R_m", "S_m", "Y_m", "U_m", "dissipated_J"};
  }

  const std::vector<std::string>& names() const { return names_; }

  /// In the order of the names, from the values of Columns.
  std::vector<double> values(const std::vector<double>& row) const {
    if (!scale_) return {};
    const auto at = [&](std::size_t i) { return row[sources_[i]]; };
    return {scale_->frequency(at(0)),        scale_->preload_per_length(at(1)), scale_->displacement(at(2)),
            scale_->displacement(at(3)),     scale_->displacement(at(4)),       scale_->displacement(at(5)),
            scale_->dissipated(at(6), at(3))};
  }

  /// Those that the table shows of a special point.
  std::vector<std::size_t> shown() const {
    return scale_ ? std::vector<std::size_t>{0, 4} : std::vector<std::size_t>{};
  }

 private:
  std::optional<PhysicalScale> scale_;
  std::vector<std::size_t> sources_;
  std::vector<std::string> names_;
};

/// The groups that [geometry] stands for, and what one of each nondimensional quantity is.
void add_geometry(const ProblemRequest& problem, ordered_json& summary) {
  if (!problem.geometry) return;
  const SystemParameters& system = problem.system;
  const PhysicalScale scale(*problem.geometry, system);
  ordered_json groups = {{"mass_ratio", system.mass_ratio},
                         {"frequency_ratio", system.frequency_ratio},
                         {"interface_stiffness", system.interface_stiffness},
                         {"force", system.force}};
  if (problem.geometry->preload_per_length > 0) groups["preload"] = system.preload;
  summary["groups"] = groups;
  summary["units"] = {{"frequency_Hz", scale.frequency(1)},
                      {"displacement_m", scale.displacement(1)},
                      {"preload_N_per_m", scale.preload_per_length(1)},
                      {"force_N_per_m", scale.force_per_length(1)},
                      {"energy_J", scale.energy(1)}};
}

ordered_json special_points(const TracedBranch& traced) {
  Columns columns(traced);
  const PhysicalColumns physical(traced);
  ordered_json listed = ordered_json::array();
  for (const BranchPoint& point : traced.branch.points) {
    if (point.type == PointType::regular) continue;
    const std::vector<double>& values = columns.values(point);
    ordered_json special = {{"type", to_string(point.type)}};
    for (const Index k : columns.shown())
      special[columns.names()[static_cast<std::size_t>(k)]] = values[static_cast<std::size_t>(k)];
    const std::vector<double> in_units = physical.values(values);
    for (const std::size_t k : physical.shown()) special[physical.names()[k]] = in_units[k];
    if (const std::optional<double> moved = moved_by(traced, point)) special["moved_by"] = *moved;
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

bool is_full(const SystemParameters& system) { return system.sectors->path() == SectorPath::full; }

ordered_json summarize(std::size_t number, const TracedBranch& traced) {
  const ordered_json special = special_points(traced);
  const continuation::Work& work = traced.branch.work;
  ordered_json summary = {{"branch", number},
                          {"values", traced.request->values},
                          {"points", traced.branch.points.size()},
                          {"stop", to_string(traced.branch.stop)},
                          {"explanation", traced.branch.explanation}};
  add_geometry(traced.request->problem, summary);
  if (const SystemParameters& system = traced.request->problem.system; system.sectors)
    summary[is_full(system) ? "full_solves" : "reduction"] = modes_to_json(system);
  if (traced.request->problem.model == nullptr) summary["harmonics"] = harmonics_of(*traced.base);
  if (traced.branch.first_stop) summary["first_stop"] = to_string(*traced.branch.first_stop);
  if (why_not_verifiable(*traced.request).empty()) {
    const problems::BalanceErrors errors =
        problems::largest_errors(traced.request->problem.system, harmonics_of(*traced.base), traced.branch);
    summary["power_error"] = errors.power;
    summary["motion_error"] = errors.motion;
  }
  summary["special"] = special;
  summary["peak"] = highest_peak(traced, special);
  summary["work"] = {{"evaluations", work.evaluations},
                     {"factorizations", work.factorizations},
                     {"iterations", work.iterations},
                     {"rejected_steps", work.rejected_steps}};
  summary["seconds"] = traced.seconds;
  if (traced.certificate) summary["certificate"] = certificate_to_json(*traced.certificate);
  return summary;
}

/// The columns of all branches; those with more harmonics have more of them.
std::vector<std::string> all_names(const std::vector<TracedBranch>& traced) {
  std::vector<std::string> all;
  for (const TracedBranch& one : traced) {
    const Columns columns(one);
    for (const std::string& name : columns.names()) {
      if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
    }
  }
  return all;
}

}  // namespace

void write_branches(const std::vector<TracedBranch>& traced, const Sink& sink) {
  fmt::memory_buffer row;
  const auto out = std::back_inserter(row);
  const auto flush = [&] {
    sink({row.data(), row.size()});
    row.clear();
  };
  const TracedBranch& first = traced.front();
  const bool stability = !first.curve && std::any_of(traced.begin(), traced.end(), [](const auto& one) {
    return !one.branch.points.empty() && one.branch.points.front().unstable >= 0;
  });
  fmt::format_to(out, "branch,point,type,regime");
  const std::vector<std::string> header = all_names(traced);
  for (const std::string& name : header) fmt::format_to(out, ",{}", name);
  fmt::format_to(out, "{},arclength,iterations,residual", stability ? ",unstable" : "");
  const PhysicalColumns physical_header(first);
  for (const std::string& name : physical_header.names()) fmt::format_to(out, ",{}", name);
  fmt::format_to(out, "\n");
  flush();
  for (std::size_t number = 0; number < traced.size(); ++number) {
    const TracedBranch& one = traced[number];
    Columns columns(one);
    const PhysicalColumns physical(one);
    std::vector<Index> places;
    for (const std::string& name : header) places.push_back(columns.find(name));
    const std::vector<std::string> regimes = one.base->regime_names();
    for (std::size_t i = 0; i < one.branch.points.size(); ++i) {
      const BranchPoint& point = one.branch.points[i];
      fmt::format_to(out, "{},{},{},{}", number, i, to_string(point.type),
                     regimes[static_cast<std::size_t>(point.regime)]);
      const std::vector<double>& values = columns.values(point);
      for (const Index place : places)
        fmt::format_to(out, ",{:.17g}", place < 0 ? std::nan("") : values[static_cast<std::size_t>(place)]);
      if (stability) fmt::format_to(out, ",{}", point.unstable);
      fmt::format_to(out, ",{:.17g},{},{:.17g}", point.arclength, point.iterations, point.residual);
      for (const double value : physical.values(values)) fmt::format_to(out, ",{:.17g}", value);
      fmt::format_to(out, "\n");
      flush();
    }
  }
}

ordered_json summarize(const Case& input, const std::vector<TracedBranch>& traced, double seconds) {
  ordered_json branches = ordered_json::array();
  for (std::size_t number = 0; number < traced.size(); ++number)
    branches.push_back(summarize(number, traced[number]));
  return {{"arcslip", ARCSLIP_VERSION},
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
  const PhysicalScale scale(problem.geometry.value(), system);
  const auto n = static_cast<double>(system.wave_number);
  const double damper = system.model == StructureModel::rods ? n : n * n;
  return fmt::format(
      "eta = 1: {:.6g} Hz, P = 1: {:.6g} N/m, Y = 1: {:.6g} m; resonances alone: base {:.6g} Hz, damper "
      "{:.6g} Hz",
      scale.frequency(1), scale.preload_per_length(1), scale.displacement(1),
      scale.frequency(damper * system.frequency_ratio), scale.frequency(damper));
}

std::string describe_modes(const SystemParameters& system) {
  std::string text;
  const ordered_json parts = modes_to_json(system);
  for (const auto& [name, part] : parts.items()) {
    if (!text.empty()) text += "\n  ";
    if (is_full(system)) {
      text += fmt::format("{}: full path, {} dofs solved for at each eta; {} modes show the resonances", name,
                          part["dofs"].get<Index>(), part["modes"].get<Index>());
      continue;
    }
    text += fmt::format(
        "{}: {} of {} modes, error {:.1e}{} against the full solve at {} eta, at worst at eta = {:g}; {} "
        "factorisations",
        name, part["modes"].get<Index>(), part["dofs"].get<Index>(), part["error"].get<double>(),
        part["error"].get<double>() > system.sectors->tolerance() ? " (above reduction_tolerance)" : "",
        part["check_etas"].size(), part["error_eta"].get<double>(), part["factorisations"].get<int>());
  }
  return text;
}

ordered_json modes_to_json(const SystemParameters& system) {
  ordered_json parts = ordered_json::object();
  const SectorUse use = sector_use(system);
  const SectorPair& sectors = *system.sectors;
  const auto add = [&](const char* name, const SectorModes& modes, const auto& solves) {
    ordered_json& part = parts[name] = {{"dofs", modes.dofs}, {"modes", modes.frequencies.size()}};
    if (is_full(system)) {
      part["factorisations"] = solves()->factorisations();
      return;
    }
    part["error"] = modes.error;
    part["error_eta"] = modes.error_eta;
    part["check_etas"] = modes.check_etas;
    part["factorisations"] = modes.factorisations;
  };
  add("base", sectors.base_modes(use, system.base_damping),
      [&] { return sectors.base_solves(use.wave, system.base_damping); });
  if (sectors.damper() != nullptr)
    add("damper", sectors.damper_modes(use, system.damper_damping),
        [&] { return sectors.damper_solves(use.wave, system.damper_damping); });
  return parts;
}

std::vector<int> harmonics_of(const continuation::Problem& problem) {
  if (const auto* several = dynamic_cast<const problems::HarmonicResponse*>(&problem))
    return several->system().orders;
  if (const auto* mode = dynamic_cast<const problems::NonlinearMode*>(&problem)) return mode->system().orders;
  return {1};
}

std::string describe_harmonics(const TracedBranch& traced) {
  const std::vector<int> orders = harmonics_of(*traced.base);
  if (orders.size() == 1) return "";
  return fmt::format("{} harmonics, up to {}\n", orders.size(), orders.back());
}

std::string special_table_header(const TracedBranch& traced) {
  const Columns columns(traced);
  std::string header = fmt::format("{:>6} {:>6}  {:<12}", "branch", "point", "type");
  for (const Index i : columns.shown()) {
    const std::string& name = columns.names()[static_cast<std::size_t>(i)];
    header += fmt::format(" {:>15}", name == "R_over_S" ? "R/S" : name);
  }
  const PhysicalColumns physical(traced);
  for (const std::size_t i : physical.shown()) header += fmt::format(" {:>15}", physical.names()[i]);
  return header + "\n";
}

std::string special_table(std::size_t number, const TracedBranch& traced) {
  Columns columns(traced);
  const PhysicalColumns physical(traced);
  const std::vector<Index> shown = columns.shown();
  std::string rows;
  for (std::size_t i = 0; i < traced.branch.points.size(); ++i) {
    const BranchPoint& point = traced.branch.points[i];
    if (point.type == PointType::regular) continue;
    const std::vector<double>& values = columns.values(point);
    rows += fmt::format("{:>6} {:>6}  {:<12}", number, i, to_string(point.type));
    for (const Index k : shown) rows += fmt::format(" {:>15.9g}", values[static_cast<std::size_t>(k)]);
    const std::vector<double> in_units = physical.values(values);
    for (const std::size_t k : physical.shown()) rows += fmt::format(" {:>15.9g}", in_units[k]);
    rows += "\n";
  }
  return rows;
}

}  // namespace arcslip
