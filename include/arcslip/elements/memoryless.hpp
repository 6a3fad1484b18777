#pragma once

// Elements whose force is a function of the momentary displacement, odd, f(-x) = -f(x).

#include "arcslip/elements/element.hpp"

namespace arcslip {

/// Derive from it and say the force.
class MemorylessElement : public Element {
 public:
  bool is_linear(bool /*slips*/) const final { return false; }
  void force(std::span<const int> orders, const HarmonicVector& x, double load, bool slips, bool derivatives,
             ElementForce& out) const final;
  VaryingStiffness stiffness_in_time(std::span<const int> orders, const HarmonicVector& x) const final;

 protected:
  virtual double value(double x) const = 0;      ///< f
  virtual double slope(double x) const = 0;      ///< df/dx
  virtual double curvature(double x) const = 0;  ///< d2f/dx2

  /// The degree of a polynomial, of which the harmonics are exact.
  virtual int degree() const = 0;

 private:
  void second(const ElementForce& at, std::span<const int> orders, const HarmonicVector& x, double load,
              const HarmonicVector& motion, double log_load, ElementForce& change) const final;
};

/// f = k_3 x^3.
class CubicSpring final : public MemorylessElement {
 public:
  /// `reference` > 0 is the stiffness relative to which the force is measured.
  CubicSpring(double coefficient, double reference) : coefficient_(coefficient), reference_(reference) {}

  double reference_stiffness() const override { return reference_; }

 private:
  double value(double x) const override { return coefficient_ * x * x * x; }
  double slope(double x) const override { return 3 * coefficient_ * x * x; }
  double curvature(double x) const override { return 6 * coefficient_ * x; }
  int degree() const override { return 3; }

  double coefficient_;
  double reference_;
};

}  // namespace arcslip
