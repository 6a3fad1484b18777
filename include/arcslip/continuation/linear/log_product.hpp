#pragma once

// Products of many factors, whose size may be beyond any number.

#include <cmath>

namespace arcslip::continuation {

/// The logarithm of |x_1 x_2 ...|, at the cost of one; -infinity if one of them is zero.
class LogProduct {
 public:
  /// One more factor, or one less; x != 0 in a division.
  void operator*=(double x) {
    product_ *= std::abs(x);
    if (product_ > 1e-100 && product_ < 1e100) return;
    log_ += std::log(product_);
    product_ = 1;
  }
  void operator/=(double x) { *this *= 1 / x; }             ///< the inverse
  double log() const { return log_ + std::log(product_); }  ///< of the product's size

 private:
  double product_ = 1;
  double log_ = 0;
};

}  // namespace arcslip::continuation
