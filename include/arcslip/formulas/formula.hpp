#pragma once

// Formulas as texts: numbers, names, + - * / ^ and parentheses, functions and the constants pi and e.
//
//   formula  = term {(+ | -) term}        power   = operand [^ signed]
//   term     = signed {(* | /) signed}    operand = number | name | function(formula, ...) | (formula)
//   signed   = {+ | -} power
//
// so that -x^2 = -(x^2), 2^-x is allowed and a^b^c = a^(b^c). A power with a whole number as its exponent has
// values at negative bases as well, every other one has none there.

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "arcslip/formulas/tape.hpp"

namespace arcslip {

/// What a name stands for.
struct Formula {
  std::string name;        ///< a word
  std::string text;        ///< the formula itself
  std::string place = {};  ///< what messages call it, as "model.equations.x"; empty: its name
};

/// A formula that cannot be read; says what was expected, and where.
class FormulaError : public std::invalid_argument {
 public:
  /// Both, as below.
  FormulaError(std::string place, std::string why);
  const std::string& place() const { return place_; }  ///< of the formula
  const std::string& why() const { return why_; }      ///< without it

 private:
  std::string place_;
  std::string why_;
};

/// Formulas that belong together.
struct FormulaSet {
  std::vector<std::string> variables;            ///< in the order of the tape's
  std::vector<Formula> definitions = {};         ///< of names that all others may use, in any order
  std::vector<Formula> results;                  ///< in the order of the tape's
  std::map<std::string, std::string> refused{};  ///< other names, with what is said of them
  int iterations = 1;  ///< how often results take the place of the variables of their names, all told
};

/// Each different expression once, those of constants as their value. Throws FormulaError.
Tape compile(const FormulaSet& set);

/// The name of the time.
inline constexpr const char* time_name = "t";

/// Why a formula could not use this name: it is no word of letters, digits and _, or means something else.
/// Empty where nothing is wrong.
std::string why_no_name(const std::string& name);

}  // namespace arcslip
