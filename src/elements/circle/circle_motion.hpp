#pragma once

// What a friction circle sees over a period: its centre w = k_t r in the contact plane, written as a complex
// number, and its radius b = mu n. The mean of r does not count while the contact slips, so that w is without
// it.

#include <span>

#include "arcslip/elements/pressed/pressed_arcs.hpp"

namespace arcslip {

/// Products of vectors of the plane.
inline double dot(Complex a, Complex b) { return a.real() * b.real() + a.imag() * b.imag(); }
inline double cross(Complex a, Complex b) { return a.real() * b.imag() - a.imag() * b.real(); }

/// Centre and radius, with what they are made of.
class CircleMotion {
 public:
  /// Both sliding displacements and the closing one, of the same highest harmonic. Throws
  /// std::invalid_argument of settings out of their range.
  CircleMotion(const PressedSettings& settings, const PeriodicMotion& x, const PeriodicMotion& y,
               const PeriodicMotion& closing);

  /// Of the motion with these orders, x, y and perhaps g one behind the other. Throws the same of orders that
  /// do not fit and of mu = 0.
  static CircleMotion of(const PressedSettings& settings, std::span<const int> orders,
                         const ComplexVector& motion);

  /// At one theta, with derivatives by it.
  struct Local {
    Complex centre;      ///< w
    Complex rate;        ///< w'
    Complex bend;        ///< w''
    double radius;       ///< b
    double radius_rate;  ///< b'
    double radius_bend;  ///< b''
  };
  Local at(double theta) const;  ///< theta

  /// |w - offset|^2 - (b + more)^2, of twice the harmonics.
  PeriodicMotion excess(Complex offset, double more) const;

  /// With b smaller by so much, through n.
  CircleMotion tightened(double less) const;

  const PressedSettings& settings() const { return settings_; }
  const PeriodicMotion& x() const { return x_; }              ///< r, with its mean
  const PeriodicMotion& y() const { return y_; }              ///< the other direction
  const PeriodicMotion& closing() const { return closing_; }  ///< g
  const PeriodicMotion& press() const { return press_; }      ///< n
  int highest() const { return x_.highest(); }                ///< H
  Complex mean() const { return mean_; }                      ///< k_t r_0
  double size() const { return size_; }                       ///< what |w| + |b| does not exceed

 private:
  PressedSettings settings_;
  PeriodicMotion x_;
  PeriodicMotion y_;
  PeriodicMotion closing_;
  PeriodicMotion press_;
  Complex mean_;
  ComplexVector wx_;  // coefficients of w and b
  ComplexVector wy_;
  ComplexVector b_;
  ComplexVector square_;  // of |w|^2 - b^2
  double size_;
};

}  // namespace arcslip
