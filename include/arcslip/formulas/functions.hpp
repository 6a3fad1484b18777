#pragma once

// The functions of one number that formulas may have, with their derivatives.

#include <string>
#include <vector>

namespace arcslip {

/// y = f(x), y' and y''.
struct FormulaFunction {
  std::string name;
  double (*value)(double x);
  double (*first)(double x, double y);
  double (*second)(double x, double y);
};

/// All of them; operations have their numbers.
const std::vector<FormulaFunction>& functions();

/// The functions of two numbers.
const std::vector<std::string>& functions_of_two();

}  // namespace arcslip
