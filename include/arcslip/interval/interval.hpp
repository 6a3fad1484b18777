#pragma once

// Interval arithmetic that encloses: every result holds all values that real arithmetic has for operands in
// the intervals.
//
// Bounds are rounded outwards without the processor's rounding modes, which compilers do not respect: each
// operation is done to nearest and its result moved out by 3/2 epsilon, three times the error that IEEE 754
// allows, and by 1e-280, above any error of underflow. Assumed: +, -, *, / and sqrt of double are IEEE 754's
// to nearest, also where a compiler contracts two of them. Of the mathematical library nothing is assumed:
// exp and ln are series with their remainders.

#include <boost/numeric/interval.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace arcslip {

/// There is no finite enclosure, as of a quotient by an interval that holds zero.
class NoEnclosure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// There is no value at all, as of the root of a negative interval.
class NoValue : public NoEnclosure {
 public:
  using NoEnclosure::NoEnclosure;
};

/// The rounding policy that Boost.Interval asks for.
class OutwardRounding {
 public:
  template <class Number>
  /// Numbers that a double holds.
  double conv_down(const Number& x) const {
    return static_cast<double>(x);
  }
  template <class Number>
  double conv_up(const Number& x) const {
    return static_cast<double>(x);
  }
  /// Bounds of the results of real arithmetic, from below and from above.
  double add_down(double x, double y) const { return below(x + y); }
  double add_up(double x, double y) const { return above(x + y); }
  double sub_down(double x, double y) const { return below(x - y); }
  double sub_up(double x, double y) const { return above(x - y); }
  double mul_down(double x, double y) const { return below(x * y); }
  double mul_up(double x, double y) const { return above(x * y); }
  double div_down(double x, double y) const { return below(x / y); }
  double div_up(double x, double y) const { return above(x / y); }
  double sqrt_down(double x) const { return below(std::sqrt(x)); }
  double sqrt_up(double x) const { return above(std::sqrt(x)); }
  /// Somewhere near the middle.
  double median(double x, double y) const { return 0.5 * x + 0.5 * y; }

 private:
  static double margin(double x) {
    return 1.5 * std::numeric_limits<double>::epsilon() * std::abs(x) + 1e-280;
  }
  static double below(double x) { return x - margin(x); }
  static double above(double x) { return x + margin(x); }
};

/// Of doubles, closed, both bounds finite where nothing has overflowed.
using Interval = boost::numeric::interval<
    double,
    boost::numeric::interval_lib::policies<boost::numeric::interval_lib::save_state_nothing<OutwardRounding>,
                                           boost::numeric::interval_lib::checking_base<double>>>;

/// A rectangle of complex numbers.
struct ComplexInterval {
  Interval real = 0;       ///< Re z
  Interval imaginary = 0;  ///< Im z
};

/// All sums and products of values in the two.
inline ComplexInterval operator+(const ComplexInterval& a, const ComplexInterval& b) {
  return {a.real + b.real, a.imaginary + b.imaginary};
}
inline ComplexInterval operator*(const Interval& a, const ComplexInterval& b) {
  return {a * b.real, a * b.imaginary};
}
inline ComplexInterval operator*(const ComplexInterval& a, const ComplexInterval& b) {
  return {a.real * b.real - a.imaginary * b.imaginary, a.real * b.imaginary + a.imaginary * b.real};
}

/// |z|^2.
inline Interval norm(const ComplexInterval& z) { return square(z.real) + square(z.imaginary); }

/// 1/x and 1/z. Throw NoEnclosure where zero is not excluded.
Interval inverse(const Interval& x);
ComplexInterval inverse(const ComplexInterval& z);

/// The smallest interval that holds both, and what they have in common: two enclosures of the same values.
/// Throw NoEnclosure where one is no interval, for it has a bound that is no number.
Interval joined(const Interval& a, const Interval& b);
Interval common(const Interval& a, const Interval& b);
ComplexInterval joined(const ComplexInterval& a, const ComplexInterval& b);
ComplexInterval common(const ComplexInterval& a, const ComplexInterval& b);

/// e^x for |x| <= 700. Throws NoEnclosure beyond.
Interval exponential(const Interval& x);

/// ln x. Throws NoEnclosure where x > 0 is not sure, NoValue where it is not so.
Interval logarithm(const Interval& x);

/// Encloses 1/pi.
Interval inverse_pi();

}  // namespace arcslip
