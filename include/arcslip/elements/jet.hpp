#pragma once

// Numbers with their first and second derivative by one setting of an element, so that a law written once
// tells how it changes with any of its settings.

#include <cmath>
#include <span>

namespace arcslip {

/// Such a number.
struct Jet {
  double value = 0;   ///< of itself
  double first = 0;   ///< derivative
  double second = 0;  ///< second derivative

  /// Zero, a constant, or one with its derivatives.
  Jet() = default;
  Jet(double constant) : value(constant) {}
  Jet(double constant, double rate, double bend) : value(constant), first(rate), second(bend) {}
};

/// Arithmetic.
inline Jet operator-(const Jet& a) { return {-a.value, -a.first, -a.second}; }
inline Jet operator+(const Jet& a, const Jet& b) {
  return {a.value + b.value, a.first + b.first, a.second + b.second};
}
inline Jet operator-(const Jet& a, const Jet& b) { return a + -b; }
inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.first * b.value + a.value * b.first,
          a.second * b.value + 2 * a.first * b.first + a.value * b.second};
}
inline Jet operator/(const Jet& a, const Jet& b) {
  const double value = a.value / b.value;
  const double first = (a.first - value * b.first) / b.value;
  return {value, first, (a.second - 2 * first * b.first - value * b.second) / b.value};
}

/// With so much added to the setting.
inline Jet shifted(const Jet& number, double by) {
  return {number.value + by * (number.first + 0.5 * by * number.second), number.first + by * number.second,
          number.second};
}

/// A typical magnitude of the setting by which these numbers have derivatives, the one that it is; 0 if none
/// has any.
inline double setting_scale(std::span<const Jet> numbers) {
  for (const Jet& one : numbers) {
    if (one.first != 0) return (one.value != 0 ? std::abs(one.value) : 1) / std::abs(one.first);
  }
  return 0;
}

}  // namespace arcslip
