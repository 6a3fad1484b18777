#pragma once

// e^{jh angle} of odd h by real products, which unlike complex ones look for no infinities.

#include <complex>

#include "arcslip/types.hpp"

namespace arcslip {

/// A complex number.
struct Turned {
  double real;
  double imag;

  static Turned by(double angle) { return of(std::polar(1.0, angle)); }  ///< e^{j angle}
  static Turned of(Complex value) { return {value.real(), value.imag()}; }
  operator Complex() const { return {real, imag}; }
  Turned operator*(const Turned& by) const {
    return {real * by.real - imag * by.imag, real * by.imag + imag * by.real};
  }
};

/// Those of one angle. The sine of a small one is as exact as itself.
class OddTurns {
 public:
  explicit OddTurns(double angle) : one_(Turned::by(angle)), two_(one_ * one_), power_(one_) {}

  /// Of h, fastest where they ascend.
  const Turned& to(int h) {
    if (reached_ > h) {
      power_ = one_;
      reached_ = 1;
    }
    for (; reached_ < h; reached_ += 2) power_ = power_ * two_;
    return power_;
  }

 private:
  Turned one_;
  Turned two_;
  Turned power_;
  int reached_ = 1;
};

}  // namespace arcslip
