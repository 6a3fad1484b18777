#include "arcslip/problems/formulas/formula_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "field_values.hpp"
#include "series_by.hpp"

namespace arcslip::problems {

FormulaField::FormulaField(const FormulaSystem& system) : equations_(right_hand_side(system)) {
  for (const Formula& equation : system.equations) {
    names_.push_back(equation.name);
    const bool turns =
        std::find(system.angles.begin(), system.angles.end(), equation.name) != system.angles.end();
    turns_.push_back(turns ? two_pi : 0);
  }
  for (const FormulaParameter& parameter : system.parameters) parameters_.push_back(parameter.name);
  scale_ = FormulaScale(system, names_, parameters_);
  period_ = compile({parameters_, {}, {*system.period}});
}

bool FormulaField::evaluate(double t, const Vector& u, const Vector& p,
                            const continuation::FieldValues& out) const {
  return evaluate_field(equations_, t, u, p, out);
}

bool FormulaField::evaluate_columns(const Vector& times, const Matrix& u, const Vector& p,
                                    const continuation::FieldColumns& out) const {
  return problems::evaluate_columns(equations_, &times, u, p, out);
}

bool FormulaField::series(double t, const Matrix& u, const Vector& p, Matrix& out) const {
  return series_by(equations_, &t, u, p, out);
}

double period_of(const Tape& tape, const Vector& p, Vector* by_parameters) {
  double value = 0;
  Numbers gradient(static_cast<std::size_t>(p.size()), 0);
  const bool known = tape.evaluate(p.data(), &value, gradient.data());
  if (by_parameters != nullptr) *by_parameters = Eigen::Map<const Vector>(gradient.data(), p.size());
  return known && value > 0 ? value : std::nan("");
}

void require_period(const Tape& tape, const Vector& p) {
  double value = 0;
  if (!tape.evaluate(p.data(), &value)) value = std::nan("");
  if (!(value > 0) || std::isinf(value))
    throw std::invalid_argument(
        fmt::format("period: {:g} at the parameters of the start; expected a number > 0", value));
}

}  // namespace arcslip::problems
