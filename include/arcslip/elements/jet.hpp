#pragma once

// Numbers with their first and second derivative by one setting of an element, so that a law written once
// tells how it changes with any of its settings.

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

}  // namespace arcslip
