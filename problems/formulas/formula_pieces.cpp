#include "arcslip/problems/formulas/formula_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "field_values.hpp"

namespace arcslip::problems {
namespace {

const char* const phase_name = "_phase";  // t over the period

/// The formula of this name, or another one.
const Formula& one_of(const std::vector<Formula>& formulas, const Formula& otherwise) {
  const auto found = std::find_if(formulas.begin(), formulas.end(),
                                  [&](const Formula& one) { return one.name == otherwise.name; });
  return found != formulas.end() ? *found : otherwise;
}

void check_piece(const FormulaSystem& system, const FormulaPiece& piece) {
  for (const std::vector<Formula>* formulas : {&piece.equations, &piece.reset}) {
    for (const Formula& formula : *formulas) {
      const bool known = std::any_of(system.equations.begin(), system.equations.end(),
                                     [&](const Formula& one) { return one.name == formula.name; });
      if (!known)
        throw FormulaError(formula.place.empty() ? formula.name : formula.place,
                           "there is no equation of this name in model.equations");
    }
  }
}

}  // namespace

FormulaPieces::FormulaPieces(const FormulaSystem& system) : told_(std::ssize(system.equations)) {
  check_names(system);
  for (const Formula& equation : system.equations) {
    names_.push_back(equation.name);
    const bool turns =
        std::find(system.angles.begin(), system.angles.end(), equation.name) != system.angles.end();
    turns_.push_back(turns ? two_pi : 0);
  }
  for (const FormulaParameter& parameter : system.parameters) parameters_.push_back(parameter.name);
  std::vector<Formula> definitions = system.definitions;
  std::vector<Formula> rates = system.equations;
  std::vector<Formula> stay;
  std::map<std::string, std::string> refused;
  for (const Formula& equation : system.equations) stay.push_back({equation.name, equation.name});
  if (system.period) {
    period_ = compile({parameters_, {}, {*system.period}});
    names_.emplace_back(phase_name);
    turns_.push_back(1);
    definitions.push_back({time_name, fmt::format("{} * ({})", phase_name, system.period->text)});
    rates.push_back({phase_name, fmt::format("1 / ({})", system.period->text)});
    stay.push_back({phase_name, phase_name});
  } else {
    refused = {{time_name, "is the time, which formulas have beside a period alone"}};
  }
  std::vector<std::string> variables{"_nothing"};
  variables.insert(variables.end(), names_.begin(), names_.end());
  scale_ = FormulaScale(system, names_, parameters_);
  variables.insert(variables.end(), parameters_.begin(), parameters_.end());

  std::vector<std::string> order = system.cycle;
  if (order.empty()) {
    for (const FormulaPiece& one : system.pieces) order.push_back(one.name);
  }
  for (const std::string& name : order) {
    const auto given = std::find_if(system.pieces.begin(), system.pieces.end(),
                                    [&](const FormulaPiece& one) { return one.name == name; });
    check_piece(system, *given);
    const auto before = std::count(order.begin(), order.begin() + std::ssize(pieces_), name);
    piece_names_.push_back(before == 0 ? name : fmt::format("{}_{}", name, before + 1));
    std::vector<Formula> own_rates;
    std::vector<Formula> reset;
    for (const Formula& rate : rates) own_rates.push_back(one_of(given->equations, rate));
    for (const Formula& one : stay) reset.push_back(one_of(given->reset, one));
    pieces_.push_back({compile({variables, definitions, own_rates, refused}),
                       compile({variables, definitions, {given->until}, refused}),
                       compile({variables, definitions, reset, refused})});
  }
}

/// By the last unknown, t/T.
double FormulaPieces::time_at(const Vector& u, const Vector& p) const {
  double period = 0;
  if (!period_ || !period_->evaluate(p.data(), &period)) return 0;
  const double phase = u(u.size() - 1);
  return (phase - std::floor(phase)) * period;
}

bool FormulaPieces::velocity(Index i, const Vector& u, const Vector& p,
                             const continuation::FieldValues& out) const {
  return evaluate_field(piece(i).rates, 0, u, p, out);
}

bool FormulaPieces::border(Index i, const Vector& u, const Vector& p,
                           const continuation::FieldValues& out) const {
  return evaluate_field(piece(i).until, 0, u, p, out);
}

bool FormulaPieces::jump(Index i, const Vector& u, const Vector& p,
                         const continuation::FieldValues& out) const {
  return evaluate_field(piece(i).reset, 0, u, p, out);
}

}  // namespace arcslip::problems
