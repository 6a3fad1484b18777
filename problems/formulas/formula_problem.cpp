#include "arcslip/problems/formulas/formula_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/interval/enclosed_tape.hpp"
#include "field_values.hpp"
#include "numbers.hpp"
#include "series_by.hpp"

namespace arcslip::problems {
namespace {

using continuation::Evaluation;
using continuation::Regime;

Eigen::Map<const Vector> vector_of(const Numbers& numbers) { return {numbers.data(), std::ssize(numbers)}; }

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

/// Of unknowns and parameters.
Tape tape_of(const FormulaSystem& system, const std::vector<Formula>& results, int iterations) {
  FormulaSet set{names_of(system.equations),
                 system.definitions,
                 results,
                 {{time_name, "is the time, on which systems of kind \"forced\" alone may depend"}},
                 iterations};
  if (system.kind == FormulaKind::forced || system.kind == FormulaKind::piecewise) {
    set.refused.clear();
    set.definitions.push_back({time_name, "0"});
  }
  if (system.interval) set.definitions.push_back({system.interval->variable, system.interval->from.text});
  for (const FormulaParameter& parameter : system.parameters) set.variables.push_back(parameter.name);
  return compile(set);
}

}  // namespace

Tape right_hand_side(const FormulaSystem& system) {
  check_names(system);
  FormulaSet set{{time_name}, system.definitions, system.equations};
  for (const Formula& equation : system.equations) set.variables.push_back(equation.name);
  for (const FormulaParameter& parameter : system.parameters) set.variables.push_back(parameter.name);
  return compile(set);
}

FormulaProblem::FormulaProblem(const FormulaSystem& system)
    : system_(std::make_shared<const FormulaSystem>(system)),
      kind_(system.kind),
      unknowns_(names_of(system.equations)),
      parameters_(names_of(system.parameters)),
      observables_(names_of(system.observables)),
      angles_(system.angles),
      scale_(system, unknowns_, parameters_) {
  check_names(system);
  equations_ = tape_of(system, system.equations, kind_ == FormulaKind::map ? system.iterate : 1);
  for (const Formula& one : system.observables) observed_.push_back(tape_of(system, {one}, 1));
}

bool FormulaProblem::evaluate(const Vector& u, const Vector& p, const Regime& /*regime*/,
                              const Evaluation& out) const {
  const Index n = size();
  const bool differentiated = out.jacobian != nullptr || out.parameter_jacobian != nullptr;
  const Numbers at = joined(u, p);
  Numbers values = room(n);
  Numbers gradients = room(differentiated ? n * std::ssize(at) : 0);
  if (!(differentiated ? equations_.evaluate(at.data(), values.data(), gradients.data())
                       : equations_.evaluate(at.data(), values.data())))
    return false;
  const bool returns = kind_ == FormulaKind::map;
  if (out.residual != nullptr) {
    *out.residual = vector_of(values);
    if (returns) *out.residual -= u;
  }
  const Eigen::Map<const Rows> rows(gradients.data(), differentiated ? n : 0, std::ssize(at));
  if (out.jacobian != nullptr) {
    *out.jacobian = rows.leftCols(n);
    if (returns) out.jacobian->diagonal().array() -= 1;
  }
  if (out.parameter_jacobian != nullptr) *out.parameter_jacobian = rows.rightCols(p.size());
  return true;
}

bool FormulaProblem::evaluate_columns(const Matrix& u, const Vector& p, Matrix* values, Matrix* by_unknowns,
                                      Matrix* by_parameters) const {
  return kind_ != FormulaKind::map &&
         problems::evaluate_columns(equations_, nullptr, u, p, {values, by_unknowns, by_parameters});
}

bool FormulaProblem::second(const Vector& u, const Vector& p, const Regime& /*regime*/, const Vector& w,
                            const Vector& du, const Vector& dp, Vector& out) const {
  out.resize(u.size() + p.size());
  return equations_.second(joined(u, p).data(), w.data(), joined(du, dp).data(), out.data());
}

bool FormulaProblem::series(const Matrix& u, const Vector& p, const Regime& /*regime*/, Matrix& out) const {
  if (!series_by(equations_, nullptr, u, p, out)) return false;
  if (kind_ == FormulaKind::map) out -= u;
  return true;
}

std::vector<continuation::Observable> FormulaProblem::observables() const {
  std::vector<continuation::Observable> all;
  for (const std::vector<std::string>* names : {&unknowns_, &observables_}) {
    for (const std::string& name : *names) {
      const bool turns = std::find(angles_.begin(), angles_.end(), name) != angles_.end();
      all.push_back({.name = name, .has_gradient = true, .period = turns ? two_pi : 0});
    }
  }
  return all;
}

void FormulaProblem::observe(const Vector& u, const Vector& p, const Regime& /*regime*/,
                             Vector& values) const {
  values.resize(u.size() + std::ssize(observed_));
  values.head(u.size()) = u;
  const Numbers at = joined(u, p);
  for (std::size_t i = 0; i < observed_.size(); ++i) {
    double& value = values(u.size() + static_cast<Index>(i));
    if (!observed_[i].evaluate(at.data(), &value)) value = std::nan("");
  }
}

double FormulaProblem::observe(const Vector& u, const Vector& p, const Regime& /*regime*/, Index which,
                               continuation::Gradient& gradient) const {
  if (which < u.size()) {
    gradient.unknowns.setUnit(which);
    gradient.parameters.setZero();
    return u(which);
  }
  const Numbers at = joined(u, p);
  double value = 0;
  Numbers slopes = room(std::ssize(at));
  if (!observed_[static_cast<std::size_t>(which - u.size())].evaluate(at.data(), &value, slopes.data())) {
    value = std::nan("");
    std::fill(slopes.begin(), slopes.end(), value);
  }
  gradient.unknowns = vector_of(slopes).head(u.size());
  gradient.parameters = vector_of(slopes).tail(p.size());
  return value;
}

FormulaProblem FormulaProblem::twice() const {
  FormulaSystem system = *system_;
  system.iterate *= 2;
  if (system.iterate > most_iterates)
    throw std::invalid_argument(fmt::format("iterate: {} is more than {}", system.iterate, most_iterates));
  return FormulaProblem(system);
}

EnclosedMap FormulaProblem::enclosed(const Vector& p) const {
  if (not_enclosed(equations_)) return {};
  const bool returns = kind_ == FormulaKind::map;
  return [tape = equations_, p, returns](const Box& u, std::vector<Interval>& values,
                                         std::vector<Interval>& jacobian) {
    Box at = u;
    at.insert(at.end(), p.begin(), p.end());
    enclose(tape, at.data(), std::ssize(u), values, jacobian);
    for (std::size_t i = 0; returns && i < u.size(); ++i) {
      values[i] -= u[i];
      jacobian[i * (u.size() + 1)] -= Interval(1);
    }
  };
}

}  // namespace arcslip::problems
