#pragma once

// A system of one's own that depends on time, with a period:
//
//   u' = f(t, u, p),   f(t + T(p), u, p) = f(t, u, p)

#include "arcslip/continuation/cycles/field.hpp"
#include "arcslip/problems/formulas/formula_problem.hpp"

namespace arcslip::problems {

/// T(p) by its tape, with its derivatives where they are wanted; nan where it has no value above 0.
double period_of(const Tape& tape, const Vector& p, Vector* by_parameters);

/// Throws std::invalid_argument, with its value, where it has none above 0 at the parameters of a start.
void require_period(const Tape& tape, const Vector& p);

/// The equations above.
class FormulaField : public continuation::Field {
 public:
  /// Of kind `forced`, with a period. Throws FormulaError.
  explicit FormulaField(const FormulaSystem& system);

  Index size() const override { return equations_.results(); }
  std::vector<std::string> names() const override { return names_; }
  std::vector<std::string> parameter_names() const override { return parameters_; }
  [[nodiscard]] bool evaluate(double t, const Vector& u, const Vector& p,
                              const continuation::FieldValues& out) const override;
  [[nodiscard]] bool evaluate_columns(const Vector& times, const Matrix& u, const Vector& p,
                                      const continuation::FieldColumns& out) const override;
  [[nodiscard]] bool series(double t, const Matrix& u, const Vector& p, Matrix& out) const override;
  double turn(Index unknown) const override { return turns_[static_cast<std::size_t>(unknown)]; }
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override {
    scale_(u, p, unknowns, parameters);
  }
  bool is_periodic() const override { return true; }
  double period(const Vector& p, Vector* by_parameters) const override {
    return period_of(period_, p, by_parameters);
  }
  /// See problems::require_period.
  void require_period(const Vector& p) const { problems::require_period(period_, p); }

 private:
  std::vector<std::string> names_;
  std::vector<double> turns_;
  std::vector<std::string> parameters_;
  FormulaScale scale_;
  Tape equations_;  // of t, u, p
  Tape period_;     // of p
};

}  // namespace arcslip::problems
