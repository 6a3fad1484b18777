#include "formulas/operation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arcslip/formulas/functions.hpp"

namespace arcslip {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

double integer_power(double a, int n) {
  switch (n) {
    case 0: return 1;
    case 1: return a;
    case 2: return a * a;
    case 3: return a * a * a;
    default: return std::pow(a, n);
  }
}

/// Of a^b by both; at a = 0 the limits, where there are any.
Slopes slopes_of_power(double a, double b, double value, bool second) {
  Slopes slopes;
  slopes.left = b * std::pow(a, b - 1);
  const bool at_zero = a == 0 && b > 0;
  const double logarithm = std::log(a);
  slopes.right = at_zero ? 0 : value * logarithm;
  if (!second) return slopes;
  slopes.left_left = b * (b - 1) * std::pow(a, b - 2);
  slopes.left_right = a == 0 && b > 1 ? 0 : std::pow(a, b - 1) * (1 + b * logarithm);
  slopes.right_right = at_zero ? 0 : value * logarithm * logarithm;
  return slopes;
}

Slopes slopes_of_fixed(double a, double b, bool second) {
  Slopes slopes;
  slopes.left = b * std::pow(a, b - 1);
  if (second) slopes.left_left = b * (b - 1) * std::pow(a, b - 2);
  return slopes;
}

Slopes slopes_of_integer(double a, int n, bool second) {
  Slopes slopes;
  slopes.left = n * integer_power(a, n - 1);
  if (second) slopes.left_left = static_cast<double>(n) * (n - 1) * integer_power(a, n - 2);
  return slopes;
}

Slopes slopes_of_quotient(double a, double b, double value) {
  Slopes slopes;
  slopes.left = 1 / b;
  slopes.right = -value / b;
  slopes.left_right = -1 / (b * b);
  slopes.right_right = 2 * a / (b * b * b);
  return slopes;
}

Slopes slopes_of_angle(double a, double b) {
  const double square = a * a + b * b;
  Slopes slopes;
  slopes.left = b / square;
  slopes.right = -a / square;
  slopes.left_left = -2 * (a / square) * (b / square);
  slopes.right_right = -slopes.left_left;
  slopes.left_right = (a - b) / square * ((a + b) / square);
  return slopes;
}

bool is_left(const Operation& operation, double a, double b) {
  if (std::isnan(a)) return true;
  return operation.kind == Operator::minimum ? a < b : a > b;
}

/// Of a^b, where b mostly stands still.
Series series_of_power(const Series& a, const Series& b) {
  const bool stands = std::all_of(b.begin() + 1, b.end(), [](double one) { return one == 0; });
  if (!stands) return taylor::exp(taylor::times(b, taylor::log(a)));
  const bool is_whole = b[0] == std::floor(b[0]) && std::abs(b[0]) <= std::numeric_limits<int>::max();
  return is_whole ? taylor::to_integer(a, static_cast<int>(b[0])) : taylor::to_power(a, b[0]);
}

}  // namespace

double value_of(const Operation& operation, double a, double b) {
  switch (operation.kind) {
    case Operator::add: return a + b;
    case Operator::subtract: return a - b;
    case Operator::multiply: return a * b;
    case Operator::divide: return a / b;
    case Operator::power: return a < 0 ? none : std::pow(a, b);
    case Operator::fixed_power: return std::pow(a, b);
    case Operator::integer_power: return integer_power(a, operation.right);
    case Operator::function: return functions()[static_cast<std::size_t>(operation.right)].value(a);
    case Operator::atan2: return std::atan2(a, b);
    case Operator::minimum:
    case Operator::maximum: return is_left(operation, a, b) ? a : b;
  }
  return none;
}

Slopes slopes_of(const Operation& operation, double a, double b, double value, bool second) {
  switch (operation.kind) {
    case Operator::add: return {1, 1};
    case Operator::subtract: return {1, -1};
    case Operator::multiply: return {b, a, 0, 1, 0};
    case Operator::divide: return slopes_of_quotient(a, b, value);
    case Operator::power: return slopes_of_power(a, b, value, second);
    case Operator::fixed_power: return slopes_of_fixed(a, b, second);
    case Operator::integer_power: return slopes_of_integer(a, operation.right, second);
    case Operator::atan2: return slopes_of_angle(a, b);
    case Operator::function: {
      const FormulaFunction& one = functions()[static_cast<std::size_t>(operation.right)];
      return {one.first(a, value), 0, second ? one.second(a, value) : 0};
    }
    case Operator::minimum:
    case Operator::maximum: return is_left(operation, a, b) ? Slopes{1, 0} : Slopes{0, 1};
  }
  return {none, none};
}

Series series_of(const Operation& operation, const Series& a, const Series& b) {
  Series sum = a;
  switch (operation.kind) {
    case Operator::add:
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += b[k];
      return sum;
    case Operator::subtract:
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] -= b[k];
      return sum;
    case Operator::multiply: return taylor::times(a, b);
    case Operator::divide: return taylor::over(a, b);
    case Operator::power: return series_of_power(a, b);
    case Operator::fixed_power: return taylor::to_power(a, b[0]);
    case Operator::integer_power: return taylor::to_integer(a, operation.right);
    case Operator::function: return functions()[static_cast<std::size_t>(operation.right)].series(a);
    case Operator::atan2: return taylor::atan2(a, b);
    case Operator::minimum:
    case Operator::maximum: return is_left(operation, a[0], b[0]) ? a : b;
  }
  sum.fill(none);
  return sum;
}

}  // namespace arcslip
