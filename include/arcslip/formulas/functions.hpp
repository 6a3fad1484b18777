#pragma once

// The functions of one number that formulas may have, with their derivatives.

#include <string>
#include <vector>

#include "arcslip/formulas/series.hpp"

namespace arcslip {

/// y = f(x), y' and y'', and what it makes of a series.
struct FormulaFunction {
  std::string name;                      ///< in formulas
  double (*value)(double x);             ///< y
  double (*first)(double x, double y);   ///< y'
  double (*second)(double x, double y);  ///< y''
  Series (*series)(const Series& x);
};

/// All of them; operations have their numbers.
const std::vector<FormulaFunction>& functions();

/// The functions of two numbers.
const std::vector<std::string>& functions_of_two();

}  // namespace arcslip
