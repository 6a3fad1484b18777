#include "arcslip/problems/formulas/formula_field.hpp"

#include <algorithm>

#include "numbers.hpp"

namespace arcslip::problems {

FormulaField::FormulaField(const FormulaSystem& system) : equations_(right_hand_side(system)) {
  for (const Formula& equation : system.equations) {
    names_.push_back(equation.name);
    const bool turns =
        std::find(system.angles.begin(), system.angles.end(), equation.name) != system.angles.end();
    turns_.push_back(turns ? two_pi : 0);
  }
  for (const FormulaParameter& parameter : system.parameters) parameters_.push_back(parameter.name);
  period_ = compile({parameters_, {}, {*system.period}});
}

bool FormulaField::evaluate(double t, const Vector& u, const Vector& p,
                            const continuation::FieldValues& out) const {
  const Index n = size();
  Numbers at{t};
  at.insert(at.end(), u.begin(), u.end());
  at.insert(at.end(), p.begin(), p.end());
  const bool differentiated =
      out.by_unknowns != nullptr || out.by_parameters != nullptr || out.by_time != nullptr;
  Numbers values = room(n);
  Numbers gradients = room(differentiated ? n * std::ssize(at) : 0);
  if (!(differentiated ? equations_.evaluate(at.data(), values.data(), gradients.data())
                       : equations_.evaluate(at.data(), values.data())))
    return false;
  if (out.velocity != nullptr) *out.velocity = Eigen::Map<const Vector>(values.data(), n);
  const Eigen::Map<const Rows> rows(gradients.data(), differentiated ? n : 0, std::ssize(at));
  if (out.by_unknowns != nullptr) *out.by_unknowns = rows.middleCols(1, n);
  if (out.by_parameters != nullptr) *out.by_parameters = rows.rightCols(p.size());
  if (out.by_time != nullptr) *out.by_time = rows.leftCols(1);
  return true;
}

double FormulaField::period(const Vector& p, Vector* by_parameters) const {
  double value = 0;
  Numbers gradient = room(p.size());
  const bool known = period_.evaluate(p.data(), &value, gradient.data());
  if (by_parameters != nullptr) *by_parameters = Eigen::Map<const Vector>(gradient.data(), p.size());
  return known && value > 0 ? value : std::nan("");
}

}  // namespace arcslip::problems
