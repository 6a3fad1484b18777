#pragma once

#include <array>
#include <cmath>

#include "arcslip/motion/odd_motion.hpp"

namespace arcslip {

/// I_m = int e^{jm theta} dtheta over an arc, to rounding however short the arc is.
inline Complex arc_integral(double begin, double width, int m) {
  if (m == 0) return width;
  const double half = 0.5 * m * width;
  return std::polar(1.0, m * begin) * std::polar(1.0, half) * (2 * std::sin(half) / m);
}

/// All of these.
class ArcIntegrals {
 public:
  /// For |m| <= highest < 4 most_harmonics.
  ArcIntegrals(double begin, double width, int highest) {
    const double half = 0.5 * width;
    const Complex half_turn = std::polar(1.0, half);
    const Complex turn = std::polar(1.0, begin) * half_turn;  // of short arcs, too
    Complex power = 1;
    Complex half_power = 1;
    values_[0] = width;
    for (int m = 1; m <= highest; ++m) {
      power *= turn;
      half_power *= half_turn;
      values_[static_cast<std::size_t>(m)] = power * (2 * half_power.imag() / m);  // 2 sin(m half)/m
    }
  }

  /// Of e^{jm theta}, m of either sign.
  Complex operator[](int m) const {
    return m < 0 ? std::conj(values_[static_cast<std::size_t>(-m)]) : values_[static_cast<std::size_t>(m)];
  }

 private:
  std::array<Complex, std::size_t{4} * most_harmonics> values_;
};

}  // namespace arcslip
