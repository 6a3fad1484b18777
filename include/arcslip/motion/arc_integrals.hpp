#pragma once

#include <array>
#include <cmath>
#include <cstdlib>
#include <tuple>
#include <utility>

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
    const Complex opening = std::polar(1.0, half);
    const Complex turn = std::polar(1.0, begin) * opening;  // the sum of both angles would be rounded
    double cosine = 1;  // of m (begin + half), by real products: complex ones look for infinities
    double sine = 0;
    double opened = 1;  // of m half
    double open = 0;
    values_[0] = {2 * half, 0};
    for (int m = 1; m <= highest; ++m) {
      std::tie(cosine, sine) =
          std::pair(cosine * turn.real() - sine * turn.imag(), cosine * turn.imag() + sine * turn.real());
      std::tie(opened, open) = std::pair(opened * opening.real() - open * opening.imag(),
                                         opened * opening.imag() + open * opening.real());
      values_[static_cast<std::size_t>(m)] = {cosine * (2 * open / m), sine * (2 * open / m)};
    }
  }

  /// Of e^{jm theta}, m of either sign.
  Complex operator[](int m) const {
    const Value& value = values_[static_cast<std::size_t>(std::abs(m))];
    return {value.real, m < 0 ? -value.imag : value.imag};
  }

 private:
  struct Value {  // which unlike a complex number is not set to zero at first
    double real;
    double imag;
  };
  std::array<Value, std::size_t{4} * most_harmonics> values_;
};

}  // namespace arcslip
