#include "results/branch_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace arcslip {

Columns::Columns(const TracedBranch& traced, BranchTable::Detail detail)
    : problem_(traced.problem()),
      is_drawn_(detail == BranchTable::Detail::drawn),
      request_(*traced.request),
      points_(traced.branch.points) {
  told_ = (is_drawn_ ? traced.drawn : traced.told).get();
  names_ = problem_.parameter_names();
  parameters_ = static_cast<Index>(names_.size());
  if (traced.curve) moved_ = traced.curve->active();
  for (const continuation::Observable& observable : problem_.observables()) {
    const bool first = static_cast<Index>(names_.size()) == parameters_;
    names_.insert(first && moved_ >= 0 ? names_.begin() + moved_ : names_.end(), observable.name);
  }
  const auto* harmonic = dynamic_cast<const problems::HarmonicProblem*>(traced.base.problem.get());
  for (Index i = 0; harmonic != nullptr && i < harmonic->contacts(); ++i) {
    if (harmonic->system().contacts[static_cast<std::size_t>(i)].stiffness > 0) continue;
    const std::string suffix = i == 0 ? "" : fmt::format("_contact_{}", i + 1);
    for (const char* name : {"S", "R_over_S"}) {
      if (const Index place = find(name + suffix); place >= 0) undefined_.push_back(place);
    }
  }
}

void Columns::observe(const continuation::BranchPoint& point) {
  if (is_drawn_) return problem_.observe_quickly(point.unknowns, point.parameters, point.regime, observed_);
  problem_.observe(point.unknowns, point.parameters, point.regime, observed_);
}

bool Columns::is_told(const continuation::BranchPoint& point) const {
  const std::less<> before;
  const continuation::BranchPoint* first = points_.data();
  return told_ != nullptr && !before(&point, first) && before(&point, first + points_.size());
}

const std::vector<double>& Columns::values(const continuation::BranchPoint& point) {
  if (is_told(point)) {
    values_.resize(names_.size());
    Eigen::Map<Vector>(values_.data(), std::ssize(names_)) =
        told_->row(&point - points_.data()).head(std::ssize(names_));
  } else {
    observe(point);
    values_.assign(point.parameters.begin(), point.parameters.end());
    if (moved_ >= 0) values_.insert(values_.begin() + moved_, observed_(0));
    values_.insert(values_.end(), observed_.begin() + (moved_ >= 0 ? 1 : 0), observed_.end());
  }
  for (const Index place : undefined_) values_[static_cast<std::size_t>(place)] = std::nan("");
  return values_;
}

Index Columns::find(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  return found == names_.end() ? -1 : static_cast<Index>(found - names_.begin());
}

std::vector<Index> Columns::shown() const {
  constexpr std::size_t most_shown = 8;
  std::vector<Index> indices;
  std::vector<std::string> names = system_parameter_names(request_.problem.system);
  names.insert(names.begin(), {"eta", "zeta"});
  names.insert(names.end(), {"P", "R_over_S", "Y", "Y_max", "slipping", "growth", "worst_wave"});
  for (const std::string& name : names) {
    if (const Index i = find(name); i >= 0) indices.push_back(i);
  }
  if (find("R_over_S") >= 0) return indices;
  indices.clear();
  for (Index i = 0; i < static_cast<Index>(names_.size()) && indices.size() < most_shown; ++i) {
    if (!is_constant(names_[static_cast<std::size_t>(i)])) indices.push_back(i);
  }
  return indices;
}

/// Whether a parameter is the same on all branches of the case.
bool Columns::is_constant(const std::string& name) const {
  const std::vector<std::string> parameters = problem_.parameter_names();
  return std::find(parameters.begin(), parameters.end(), name) != parameters.end() &&
         name != request_.options.parameter && !request_.values.contains(name);
}

PhysicalColumns::PhysicalColumns(const TracedBranch& traced) {
  const ProblemRequest& problem = traced.request->problem;
  scale_ = problem.physical;
  if (problem.model == nullptr) per_eta_ = problem.system.rotation.per_eta;
  if (!scale_ && per_eta_ == 0) return;
  const Columns columns(traced);
  threshold_ = columns.find("S");
  const auto add = [&](const char* source, const std::string& name, Unit unit) {
    const Index place = columns.find(source);
    if (place < 0) return;
    const bool is_shown = unit == Unit::frequency || unit == Unit::speed || std::string_view(source) == "Y";
    if (is_shown) shown_.push_back(names_.size());
    sources_.push_back({static_cast<std::size_t>(place), unit});
    names_.push_back(name);
  };
  if (per_eta_ != 0) add("eta", "speed", Unit::speed);
  if (!scale_) return;
  add("eta", "frequency_Hz", Unit::frequency);
  add("frequency_2", "frequency_2_Hz", Unit::frequency);
  add("P", std::string("preload_") + scale_->preload_unit(), Unit::preload);
  for (const char* name : {"R", "S", "Y", "U"}) add(name, std::string(name) + "_m", Unit::length);
  if (threshold_ >= 0) add("dissipated", "dissipated_J", Unit::energy);
  add("T_max", "T_max_N", Unit::force);
}

std::vector<double> PhysicalColumns::values(const std::vector<double>& row) const {
  std::vector<double> values;
  for (const auto& [place, unit] : sources_) {
    const double value = row[place];
    switch (unit) {
      case Unit::speed: values.push_back(per_eta_ * value); break;
      case Unit::frequency: values.push_back(scale_->frequency(value)); break;
      case Unit::preload: values.push_back(scale_->preload(value)); break;
      case Unit::force: values.push_back(scale_->force(value)); break;
      case Unit::length: values.push_back(scale_->displacement(value)); break;
      case Unit::energy:
        values.push_back(scale_->dissipated(value, row[static_cast<std::size_t>(threshold_)]));
        break;
    }
  }
  return values;
}

}  // namespace arcslip
