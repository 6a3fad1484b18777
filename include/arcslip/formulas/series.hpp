#pragma once

// Taylor series along a curve,
//
//   x(h) = sum_k x_k h^k,   k = 0 .. 5,
//
// and what formulas make of them, by recurrences that are exact to rounding [Griewank & Walther, Evaluating
// Derivatives, 2nd ed., SIAM 2008, ch. 13].

#include <array>

namespace arcslip {

namespace taylor {
inline constexpr int order = 5;  ///< the highest
}
using Series = std::array<double, taylor::order + 1>;

namespace taylor {

Series times(const Series& a, const Series& b);
Series over(const Series& a, const Series& b);

/// a^c: nan at a = 0, but for whole c, at and above 0.
Series to_power(const Series& a, double c);
Series to_integer(const Series& a, int n);

Series exp(const Series& a);
Series log(const Series& a);
Series sin(const Series& a);
Series cos(const Series& a);
Series tan(const Series& a);
Series asin(const Series& a);
Series acos(const Series& a);
Series atan(const Series& a);
Series sinh(const Series& a);
Series cosh(const Series& a);
Series tanh(const Series& a);
Series log10(const Series& a);
Series sqrt(const Series& a);
/// At their corners nan.
Series abs(const Series& a);
Series sign(const Series& a);
Series atan2(const Series& a, const Series& b);

}  // namespace taylor
}  // namespace arcslip
