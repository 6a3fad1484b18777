#pragma once

// Fields that depend on time, as functions written in Python.

#include "arcslip/continuation/cycles/field.hpp"
#include "arcslip/formulas/tape.hpp"
#include "arcslip/problems/formulas/formula_field.hpp"
#include "python/binding/python_problem.hpp"

namespace arcslip::python {

/// f(t, u, p) of a problem of which t is the last parameter.
class TimedField : public continuation::Field {
 public:
  /// `period` is a formula of the other parameters. Throws FormulaError.
  TimedField(std::shared_ptr<const PythonProblem> problem, const std::string& period);

  Index size() const override { return problem_->size(); }
  std::vector<std::string> names() const override { return names_; }
  std::vector<std::string> parameter_names() const override { return parameters_; }
  [[nodiscard]] bool evaluate(double t, const Vector& u, const Vector& p,
                              const continuation::FieldValues& out) const override;
  bool is_periodic() const override { return true; }
  double period(const Vector& p, Vector* by_parameters) const override {
    return problems::period_of(period_, p, by_parameters);
  }
  /// See problems::require_period.
  void require_period(const Vector& p) const { problems::require_period(period_, p); }
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override;

 private:
  std::shared_ptr<const PythonProblem> problem_;
  std::vector<std::string> names_;
  std::vector<std::string> parameters_;
  Tape period_;  // of p
};

}  // namespace arcslip::python
