#include "results/branch_columns.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace arcslip {

Columns::Columns(const TracedBranch& traced, BranchTable::Detail detail)
    : problem_(traced.problem()), request_(*traced.request), points_(traced.branch.points) {
  if (detail == BranchTable::Detail::full) told_ = traced.told.get();
  if (detail == BranchTable::Detail::drawn && !traced.curve) without_verdict_ = traced.base.disturbed.get();
  names_ = problem_.parameter_names();
  parameters_ = static_cast<Index>(names_.size());
  if (traced.curve) moved_ = traced.curve->active();
  for (const continuation::Observable& observable : problem_.observables()) {
    const bool first = static_cast<Index>(names_.size()) == parameters_;
    names_.insert(first && moved_ >= 0 ? names_.begin() + moved_ : names_.end(), observable.name);
  }
}

void Columns::observe(const continuation::BranchPoint& point) {
  if (without_verdict_ == nullptr)
    return problem_.observe(point.unknowns, point.parameters, point.regime, observed_);
  without_verdict_->HarmonicResponse::observe(point.unknowns, point.parameters, point.regime, observed_);
  const Index known = observed_.size();
  observed_.conservativeResize(static_cast<Index>(names_.size()) - parameters_);
  observed_.tail(observed_.size() - known).setConstant(std::nan(""));
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
    return values_;
  }
  observe(point);
  values_.assign(point.parameters.begin(), point.parameters.end());
  if (moved_ >= 0) values_.insert(values_.begin() + moved_, observed_(0));
  values_.insert(values_.end(), observed_.begin() + (moved_ >= 0 ? 1 : 0), observed_.end());
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
  names.insert(names.end(), {"P", "R_over_S", "Y", "growth", "worst_wave"});
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
  if (!problem.geometry) return;
  scale_.emplace(*problem.geometry, problem.system);
  const Columns columns(traced);
  for (const char* name : {"eta", "P", "R", "S", "Y", "U", "dissipated"})
    sources_.push_back(static_cast<std::size_t>(columns.find(name)));
  names_ = {"frequency_Hz", "preload_N_per_m", "R_m", "S_m", "Y_m", "U_m", "dissipated_J"};
}

std::vector<double> PhysicalColumns::values(const std::vector<double>& row) const {
  if (!scale_) return {};
  const auto at = [&](std::size_t i) { return row[sources_[i]]; };
  return {scale_->frequency(at(0)),        scale_->preload_per_length(at(1)), scale_->displacement(at(2)),
          scale_->displacement(at(3)),     scale_->displacement(at(4)),       scale_->displacement(at(5)),
          scale_->dissipated(at(6), at(3))};
}

std::vector<std::size_t> PhysicalColumns::shown() const {
  return scale_ ? std::vector<std::size_t>{0, 4} : std::vector<std::size_t>{};
}

}  // namespace arcslip
