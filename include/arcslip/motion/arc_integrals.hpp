#pragma once

#include <array>
#include <cmath>

#include "arcslip/motion/odd_motion.hpp"

namespace arcslip {

/// I_m = int e^{jm theta} dtheta over an arc, to rounding however short the arc is.
inline Complex arc_integral(double begin, double width, int m) {
  if (m == 0) return width;
  return std::polar(1.0, m * (begin + 0.5 * width)) * (2 * std::sin(0.5 * m * width) / m);
}

/// All of these.
class ArcIntegrals {
 public:
  /// For |m| <= highest < 4 most_harmonics.
  ArcIntegrals(double begin, double width, int highest) {
    const double half = 0.5 * width;
    const Complex turn = std::polar(1.0, begin + half);
    Complex power = 1;
    values_[0] = 2 * half;
    for (int m = 1; m <= highest; ++m) {
      power *= turn;
      values_[static_cast<std::size_t>(m)] = power * (2 * std::sin(m * half) / m);
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
