#pragma once

// Formulas as a list of operations that is gone through from end to end,
//
//   v_i = f_i(v_a, v_b),  a, b < i,
//
// for values; then on, for gradients, through what going backwards by the adjoints dF/dv_a += dF/dv_i
// df_i/dv_a of each result comes to; backwards with dual numbers v + h v' for second derivatives along a
// direction; and with series for higher ones along a curve [Griewank & Walther, Evaluating Derivatives, 2nd
// ed., SIAM 2008, ch. 3, 5 and 13]. All are exact to rounding.

#include <cstdint>
#include <utility>
#include <vector>

#include "arcslip/formulas/series.hpp"
#include "arcslip/types.hpp"

namespace arcslip {

/// What an operation does with its one or two operands.
enum class Operator : std::uint8_t {
  add,
  subtract,
  multiply,
  divide,
  power,          ///< a^b; no value at a < 0
  fixed_power,    ///< a^b of a constant b
  integer_power,  ///< a^n, n in place of b
  function,       ///< of one operand, by its number in `functions()` in place of b
  atan2,
  minimum,
  maximum
};

/// Whether b is a place, and not part of what an operation does.
constexpr bool has_two(Operator kind) {
  return kind != Operator::integer_power && kind != Operator::function;
}

/// v = f(a, b); a and b are places of variables, constants and earlier operations, in this order. At the
/// corners of abs, sign, min and max derivatives are those of one side, or 0 between two of opposite signs.
struct Operation {
  Operator kind;  ///< f
  int left;       ///< place of a
  int right;      ///< place of b, or what stands there
};

/// What is done one after the other: places are those of variables, constants and operations, in this order.
struct OperationList {
  Index variables = 0;
  std::vector<double> constants;
  std::vector<Operation> operations;
  std::vector<int> results;  ///< their places

  std::size_t first() const { return static_cast<std::size_t>(variables) + constants.size(); }  ///< operation
  std::size_t slots() const { return first() + operations.size(); }
};

/// Results by variables x, as many as `variables()`; may be shared by threads. Up to some hundred operations
/// nothing is allocated.
class Tape {
 public:
  Tape() = default;

  /// Operations that no result needs are best left out.
  explicit Tape(OperationList values) : values_(std::move(values)) { find_gradient(); }

  Index variables() const { return values_.variables; }                ///< how many
  Index results() const { return std::ssize(values_.results); }        ///< how many
  Index operations() const { return std::ssize(values_.operations); }  ///< how many are done for all results
  bool uses(Index variable) const;                                     ///< whether any result depends on it

  /// What there is to do, for arithmetic of another kind: after the places of variables and constants come
  /// those of the operations.
  const std::vector<double>& constants() const { return values_.constants; }
  const std::vector<Operation>& steps() const { return values_.operations; }
  const std::vector<int>& places() const { return values_.results; }  ///< of the results

  /// Fills `values`, one for each result. False where one is not finite.
  [[nodiscard]] bool evaluate(const double* x, double* values) const;

  /// Also their gradients, row by row: results x variables.
  [[nodiscard]] bool evaluate(const double* x, double* values, double* gradients) const;

  /// The same at several points, one after the other: as many x, values and gradients, or
  /// none of these where they are null.
  [[nodiscard]] bool evaluate(const double* x, Index points, double* values, double* gradients) const;

  /// w^T d/dh [dF/dx](x + h dx) at h = 0: one entry for each variable. False where one is not finite.
  [[nodiscard]] bool second(const double* x, const double* w, const double* dx, double* out) const;

  /// Series of the results, by those of the variables. False where one is not finite.
  [[nodiscard]] bool series(const Series* x, Series* values) const;

 private:
  template <std::size_t lanes>
  bool evaluate_lanes(const double* x, double* values, double* gradients) const;
  void find_gradient();

  OperationList values_;
  OperationList gradient_;   // results x variables, of the places of the values and of slopes
  std::vector<int> curved_;  // the operations of which these are, two of each
};

}  // namespace arcslip
