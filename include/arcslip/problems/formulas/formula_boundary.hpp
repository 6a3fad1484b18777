#pragma once

// A boundary value problem of one's own:
//
//   u' = f(x, u, p) on a(p) <= x <= b(p),    g(u(a), u(b), p) = 0,    int_a^b h(x, u, p) dx = 0
//
// with as many conditions g and h as there are unknowns and parameters that these set free. Over s = (x -
// a)/(b
// - a), with free parameters and integrals so far as further unknowns, it is what BoundaryField has.

#include "arcslip/continuation/cycles/boundary_problem.hpp"
#include "arcslip/problems/formulas/formula_problem.hpp"

namespace arcslip::problems {

/// The equations above. Its parameters are those that are not free.
class FormulaBoundary : public continuation::BoundaryField {
 public:
  /// Of kind `boundary`. Throws FormulaError.
  explicit FormulaBoundary(const FormulaSystem& system);

  Index size() const override { return std::ssize(names_); }
  Index told() const override { return told_; }
  Index free() const override { return free_; }
  std::vector<std::string> names() const override { return names_; }
  std::vector<std::string> parameter_names() const override { return parameters_; }
  std::string place_name() const override { return variable_; }
  std::pair<double, double> interval(const Vector& u, const Vector& p) const override;
  [[nodiscard]] bool evaluate(double s, const Vector& u, const Vector& p,
                              const continuation::FieldValues& out) const override;
  [[nodiscard]] bool end_conditions(const Vector& left, const Vector& right, const Vector& p,
                                    const continuation::EndConditions& out) const override;
  void scale(const Vector& u, const Vector& p, Vector& unknowns, Vector& parameters) const override {
    scale_(u, p, unknowns, parameters);
  }

  /// The guess at s, at values of the free parameters and of the others; false where it has no value.
  [[nodiscard]] bool guess(double s, const Vector& free, const Vector& p, Vector& u) const;

 private:
  Index integrals() const { return size() - told_ - free_; }

  Index told_;
  Index free_;
  std::string variable_;
  std::vector<std::string> names_;       // of u: unknowns, free parameters, integrals
  std::vector<std::string> parameters_;  // p
  FormulaScale scale_;
  Tape rates_;     // of s, u, p
  Tape ends_;      // g of the told ones at both ends, free parameters, p
  Tape interval_;  // of free parameters, p
  Tape start_;     // of s, free parameters, p
};

/// Which parameters of a system are not free, in its order, then those that are.
std::vector<FormulaParameter> free_ones_last(const FormulaSystem& system);

}  // namespace arcslip::problems
