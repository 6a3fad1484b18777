#pragma once

// What is known along a period as sums for its harmonics. With e_h = e^{jh theta} and means over a period, or
// half of one of odd orders,
//
//   f_h = 2 mean(f conj(e_h)),   df_h = sum_l c_hl dx_l + c'_hl conj(dx_l),
//   c_hl = mean(conj(g_l) conj(e_h)),   c'_hl = mean(g_l conj(e_h)),   df = Re sum_l conj(g_l) dx_l,
//
// and half of that for h = 0.

#include <boost/math/quadrature/gauss.hpp>
#include <span>

#include "arcslip/motion/odd_motion.hpp"

namespace arcslip {

/// Calls `use` with angles and weights that integrate over [begin, end) what is smooth there and has
/// harmonics up to about `highest`, to rounding.
template <class Use>
void each_gauss_node(double begin, double end, int highest, const Use& use) {
  using Gauss = boost::math::quadrature::gauss<double, 20>;
  constexpr double longest = 24;  // panel, in radians of the highest harmonic
  const double width = end - begin;
  if (!(width > 0)) return;
  const int panels = static_cast<int>(highest * width / longest) + 1;
  const double half = 0.5 * width / panels;
  for (int k = 0; k < panels; ++k) {
    const double middle = begin + (2 * k + 1) * half;
    for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
      const double weight = Gauss::weights()[i] * half;
      use(middle - Gauss::abscissa()[i] * half, weight);
      use(middle + Gauss::abscissa()[i] * half, weight);
    }
  }
}

/// One angle of the period.
class HarmonicTurn {
 public:
  explicit HarmonicTurn(std::span<const int> orders)
      : orders_(orders), back_(std::ssize(orders)), rows_(std::ssize(orders)) {}

  void go_to(double theta) {
    for (Index a = 0; a < back_.size(); ++a)
      back_(a) = std::polar(1.0, -orders_[static_cast<std::size_t>(a)] * theta);
    rows_ = back_;
    for (Index a = 0; a < back_.size(); ++a) {
      if (orders_[static_cast<std::size_t>(a)] == 0) rows_(a) = 0.5;
    }
  }

  /// conj(e_h), the g_h of x itself, and x.
  const HarmonicVector& back() const { return back_; }
  double value(const HarmonicVector& x) const { return back_.dot(x).real(); }

  /// Adds so large a part of the means: of a force, of a change g, and of a slope that x is multiplied by.
  void add_force(double part, HarmonicVector& harmonics) const { harmonics += (2 * part) * rows_; }
  void add_change(double part, const HarmonicVector& change, ComplexMatrix& linear,
                  ComplexMatrix& conjugate) const {
    for (Index l = 0; l < change.size(); ++l) {
      linear.col(l) += (part * std::conj(change(l))) * rows_;
      conjugate.col(l) += (part * change(l)) * rows_;
    }
  }
  void add_slope(double part, ComplexMatrix& linear, ComplexMatrix& conjugate) const {
    add_change(part, back_, linear, conjugate);
  }

 private:
  std::span<const int> orders_;
  HarmonicVector back_;
  HarmonicVector rows_;
};

}  // namespace arcslip
