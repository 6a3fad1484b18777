#pragma once

// Enclosures of the functions that formulas have.

#include <string>
#include <vector>

#include "arcslip/interval/interval.hpp"

namespace arcslip {

/// A function of one number over an interval; f may have no value outside of its domain.
struct EnclosedFunction {
  std::string name;  ///< as `functions()` has it
  Interval (*value)(
      const Interval& x);  ///< all f(x). Throws NoEnclosure where f is not sure to have a value.
  Interval (*slope)(const Interval& x);  ///< all f'(x), at a corner those of both sides. Throws the same.
};

/// The one of this name; null where there is none.
const EnclosedFunction* find_enclosed(const std::string& name);

/// sin x and cos x; to rounding where |x| is not large.
Interval sine(const Interval& x);
Interval cosine(const Interval& x);

/// a^n, and a^b of a > 0. Throw NoEnclosure where they are not sure to have a value.
Interval power(const Interval& a, int n);
Interval power(const Interval& a, const Interval& b);

}  // namespace arcslip
