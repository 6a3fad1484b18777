#include "arcslip/interval/interval.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace arcslip {
namespace {

bool is_proper(const Interval& x) { return x.lower() <= x.upper(); }

void require_proper(const Interval& a, const Interval& b) {
  if (!is_proper(a) || !is_proper(b)) throw NoEnclosure("a bound is no number");
}

/// e^x by Taylor's series of x - m ln 2, |x - m ln 2| <= 0.36.
Interval exponential_at(double x) {
  constexpr int terms = 14;
  constexpr double remainder = 3e-19;  // 0.36^15/15! e^0.36 is below it
  static const std::array<Interval, terms + 1> reciprocals = [] {
    std::array<Interval, terms + 1> values;
    for (int k = 1; k <= terms; ++k) values[static_cast<std::size_t>(k)] = Interval(1) / Interval(k);
    return values;
  }();
  // ln 2 = high + low, where high has 32 bits, so that m high is exact, and the double nearest to ln 2 - high
  // is 1.9082149292705877e-10.
  constexpr double high = 0x1.62e42feep-1;
  static const Interval low(1.9082149292705874e-10, 1.908214929270588e-10);
  const double m = std::nearbyint(x * 1.4426950408889634);
  const Interval rest = (Interval(x) - Interval(m * high)) - Interval(m) * low;
  if (!(std::abs(x) <= 700 && norm(rest) <= 0.36)) throw NoEnclosure("e^x is beyond its range");
  Interval sum = 1;
  for (std::size_t k = terms; k >= 1; --k) sum = Interval(1) + rest * sum * reciprocals[k];
  const double scale = std::ldexp(1.0, static_cast<int>(m));
  return (sum + Interval(-remainder, remainder)) * Interval(scale);
}

/// ln x = m ln 2 + 2 artanh((y - 1)/(y + 1)) of x = 2^m y, |y - 1|/(y + 1) <= 1/3.
Interval logarithm_at(double x) {
  static const Interval of_two(0x1.62e42fefa39efp-1, 0x1.62e42fefa39f0p-1);
  if (x < 0.5 || x > 2) {
    int exponent = 0;
    const double fraction = std::frexp(x, &exponent);
    return logarithm_at(fraction) + Interval(exponent) * of_two;
  }
  const Interval ratio = (Interval(x) - Interval(1)) / (Interval(x) + Interval(1));
  const Interval ratio_square = square(ratio);
  Interval sum = 0;
  Interval power = 1;
  for (int k = 0; k < 40; ++k) {
    if (power.upper() < 1e-18) break;
    sum += power / Interval(2 * k + 1);
    power *= ratio_square;
  }
  // What is left out is a series of positive terms, below that of the powers, with a ratio of at most 1/9.
  return Interval(2) * ratio * (sum + Interval(0, 1.2 * power.upper()));
}

}  // namespace

Interval inverse(const Interval& x) {
  if (!(x.lower() > 0 || x.upper() < 0)) throw NoEnclosure("zero is not excluded");
  return Interval(1) / x;
}

ComplexInterval inverse(const ComplexInterval& z) {
  const Interval factor = inverse(norm(z));
  return {z.real * factor, -(z.imaginary * factor)};
}

Interval joined(const Interval& a, const Interval& b) {
  require_proper(a, b);
  return {std::min(a.lower(), b.lower()), std::max(a.upper(), b.upper())};
}

Interval common(const Interval& a, const Interval& b) {
  require_proper(a, b);
  return {std::max(a.lower(), b.lower()), std::min(a.upper(), b.upper())};
}

ComplexInterval joined(const ComplexInterval& a, const ComplexInterval& b) {
  return {joined(a.real, b.real), joined(a.imaginary, b.imaginary)};
}

ComplexInterval common(const ComplexInterval& a, const ComplexInterval& b) {
  return {common(a.real, b.real), common(a.imaginary, b.imaginary)};
}

Interval exponential(const Interval& x) {
  const Interval low = exponential_at(x.lower());
  return {low.lower(), x.upper() == x.lower() ? low.upper() : exponential_at(x.upper()).upper()};
}

Interval logarithm(const Interval& x) {
  if (x.upper() <= 0) throw NoValue("ln of what is not positive");
  if (!(x.lower() > 0 && x.upper() < std::numeric_limits<double>::infinity()))
    throw NoEnclosure("ln of what may not be positive");
  return {logarithm_at(x.lower()).lower(), logarithm_at(x.upper()).upper()};
}

Interval inverse_pi() { return {0.31830988618379066, 0.31830988618379070}; }

}  // namespace arcslip
