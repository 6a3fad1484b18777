#pragma once

// Harmonics of what is a trigonometric polynomial on some arcs of a period and zero on the others.

#include <span>
#include <vector>

#include "arcslip/elements/pressed/pressed_contact.hpp"
#include "arcslip/motion/arc_integrals.hpp"
#include "arcslip/motion/periodic_motion.hpp"

namespace arcslip {

/// Adds factor times value over the harmonics of a change at one angle, e^{jm theta}/2 for each.
inline void add_product(HarmonicDerivative& sum, double factor, const ComplexVector& value,
                        const ComplexVector& turns) {
  sum.linear.noalias() += factor * value * turns.transpose();
  sum.conjugate.noalias() += factor * value * turns.adjoint();
}

/// Harmonics of theta on an arc and 0 elsewhere, in these orders.
inline ComplexVector ramp_harmonics(double begin, double width, std::span<const int> orders) {
  ComplexVector sums(std::ssize(orders));
  const double half = 0.5 * width;
  for (std::size_t a = 0; a < orders.size(); ++a) {
    const int h = orders[a];
    const Complex middle = (begin + half) * arc_integral(begin, width, -h);
    const double odd = h == 0 ? 0 : (std::sin(h * half) / h - half * std::cos(h * half)) / h;
    const Complex sum = middle - Complex(0, 2 * odd) * std::polar(1.0, -h * (begin + half));
    sums(static_cast<Index>(a)) = sum / (h == 0 ? two_pi : pi);
  }
  return sums;
}

/// Sums over arcs of int e^{jm theta} dtheta with a sign each.
class ArcSums {
 public:
  /// For |m| <= highest, of no arc.
  explicit ArcSums(int highest) : sums_(static_cast<std::size_t>(highest) + 1) {}

  /// Of one arc in theta.
  ArcSums(int highest, double begin, double width) : ArcSums(highest) {
    for (std::size_t m = 0; m < sums_.size(); ++m) sums_[m] = arc_integral(begin, width, static_cast<int>(m));
  }

  void add(const ArcSums& other, int sign = 1) {
    for (std::size_t m = 0; m < sums_.size(); ++m) sums_[m] += static_cast<double>(sign) * other.sums_[m];
  }

  /// Those of x on the arcs and 0 elsewhere, in these orders.
  ComplexVector harmonics(const PeriodicMotion& x, std::span<const int> orders) const {
    ComplexVector sums(std::ssize(orders));
    for (std::size_t a = 0; a < orders.size(); ++a) {
      const int h = orders[a];
      Complex sum = x.coefficients()(0) * at(-h);
      for (int m = 1; m <= x.highest(); ++m) {
        const Complex half = 0.5 * x.coefficients()(m);
        sum += half * at(m - h) + std::conj(half * at(m + h));
      }
      sums(static_cast<Index>(a)) = sum / (h == 0 ? two_pi : pi);
    }
    return sums;
  }

  /// Of `factor` times the harmonics above by x.
  HarmonicDerivative derivative(std::span<const int> orders, double factor) const {
    const Index count = std::ssize(orders);
    HarmonicDerivative by{ComplexMatrix(count, count), ComplexMatrix(count, count)};
    for (Index a = 0; a < count; ++a) {
      const int h = orders[static_cast<std::size_t>(a)];
      const double scale = factor / (h == 0 ? 2 * two_pi : two_pi);
      for (Index b = 0; b < count; ++b) {
        const int m = orders[static_cast<std::size_t>(b)];
        by.linear(a, b) = scale * at(m - h);
        by.conjugate(a, b) = scale * std::conj(at(m + h));
      }
    }
    return by;
  }

 private:
  Complex at(int m) const {
    return m < 0 ? std::conj(sums_[static_cast<std::size_t>(-m)]) : sums_[static_cast<std::size_t>(m)];
  }

  std::vector<Complex> sums_;
};

}  // namespace arcslip
