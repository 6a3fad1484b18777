#pragma once

// How tests of the library trace a model and judge what was found.

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "arcslip/continuation/path/trace.hpp"
#include "arcslip/continuation/points/branch_point_problem.hpp"
#include "arcslip/continuation/points/fold_problem.hpp"
#include "arcslip/continuation/points/hopf_problem.hpp"
#include "arcslip/problems/library/library.hpp"
#include "branches.hpp"

namespace arcslip::testing {

/// A model of the library with some of its settings changed.
struct Instance {
  using Changes = std::vector<std::pair<std::string, double>>;

  explicit Instance(const std::string& name, const Changes& changes = {})
      : model(*problems::find_model(name)) {
    for (const problems::Setting& setting : model.settings) values.push_back(setting.value);
    for (const auto& [key, value] : changes) values[position(key)] = value;
    problem = model.build(values);
  }

  std::size_t position(const std::string& key) const {
    const auto found = std::find_if(model.settings.begin(), model.settings.end(),
                                    [&](const problems::Setting& setting) { return setting.name == key; });
    return static_cast<std::size_t>(found - model.settings.begin());
  }
  Index parameter(const std::string& key) const {
    return continuation::index_of(problem->parameter_names(), key);
  }
  continuation::Guess guess() const { return model.guess(*problem, values); }

  /// The branch from the model's own guess.
  continuation::Branch trace(const continuation::TraceOptions& options) const {
    continuation::Guess start = Instance(*this, options.parameter, options.from).guess();
    return continuation::trace(*problem, start, options);
  }

  const problems::LibraryModel& model;
  problems::LibraryModel::Values values;
  std::shared_ptr<continuation::Problem> problem;

 private:
  Instance(const Instance& other, const std::string& key, double value) : Instance(other) {
    values[position(key)] = value;
  }
};

/// omega of a Hopf point: the imaginary part of the eigenvalue next to the imaginary axis.
inline double omega_of(const continuation::BranchPoint& hopf) {
  Complex nearest(1e300, 0);
  for (const Complex& value : hopf.eigenvalues) {
    if (value.imag() > 0 && std::abs(value.real()) < std::abs(nearest.real())) nearest = value;
  }
  return nearest.imag();
}

/// Largest entry of F and of the conditions that define a fold, a branch point or a Hopf point.
inline double defining_residual(const continuation::Problem& problem, Index active,
                                const continuation::BranchPoint& point) {
  using continuation::PointType;
  std::unique_ptr<continuation::ExtendedProblem> extended;
  continuation::BasePoint at{point.unknowns, point.parameters, point.regime, {}};
  if (point.type == PointType::fold) {
    extended = std::make_unique<continuation::FoldProblem>(problem, active);
  } else if (point.type == PointType::branch_point) {
    extended = std::make_unique<continuation::BranchPointProblem>(problem, active);
    at.extras = Vector::Zero(1);
  } else {
    extended = std::make_unique<continuation::HopfProblem>(problem, active);
    at.extras = Vector::Constant(1, omega_of(point) * omega_of(point));
  }
  Vector u, p;
  extended->join(at, u, p);
  Vector residual(extended->size());
  continuation::Evaluation out;
  out.residual = &residual;
  if (!extended->adapt(at) || !extended->evaluate(u, p, at.regime, out)) return 1e300;
  return residual.lpNorm<Eigen::Infinity>();
}

}  // namespace arcslip::testing
