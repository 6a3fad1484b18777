#pragma once

// What an operation of a tape is worth, and how it changes with its operands.

#include "arcslip/formulas/series.hpp"
#include "arcslip/formulas/tape.hpp"

namespace arcslip {

/// Its derivatives.
struct Slopes {
  double left = 0, right = 0;                             ///< df/da, df/db
  double left_left = 0, left_right = 0, right_right = 0;  ///< the second ones
};

/// Whether its derivatives are operations like these.
constexpr bool is_differentiated(Operator kind) {
  return kind == Operator::add || kind == Operator::subtract || kind == Operator::multiply ||
         kind == Operator::divide || kind == Operator::integer_power;
}

/// The value of one operation, and its derivatives there, of which `second` are not always wanted.
double value_of(const Operation& operation, double a, double b);
Slopes slopes_of(const Operation& operation, double a, double b, double value, bool second);

/// What it makes of series; nan where they have no value.
Series series_of(const Operation& operation, const Series& a, const Series& b);

}  // namespace arcslip
