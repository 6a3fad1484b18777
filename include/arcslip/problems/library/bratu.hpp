#pragma once

// Bratu's problem on an interval, by central differences on m intervals of h = 1/m:
//
//   u'' + lambda e^u = 0,  u(0) = u(1) = 0:
//   (u_(i-1) - 2 u_i + u_(i+1))/h + h lambda e^(u_i) = 0,   i = 1 .. m - 1
//
// Unknowns: u_1 .. u_(m-1). Parameter: lambda. Exact [Davis 1962; demo `exp` of AUTO-07p]: lambda = 8 (s/cosh
// s)^2 with u(1/2) = 2 ln cosh s and u'(0) = 4 s tanh s; the fold, at s tanh s = 1, is lambda =
// 3.51383071912516, u(1/2) = 1.1868421686343886. The differences err by O(h^2).

#include "arcslip/problems/library/library.hpp"

namespace arcslip::problems {

/// The equations above, sparse.
class Bratu : public continuation::Problem {
 public:
  /// u(1/2), between two points their mean, and u'(0), both to O(h^2).
  enum Quantity : Index { u_mid, slope };

  /// `intervals` m >= 2.
  explicit Bratu(Index intervals) : size_(intervals - 1), h_(1 / static_cast<double>(intervals)) {}

  Index size() const override { return size_; }
  std::vector<std::string> parameter_names() const override { return {"lambda"}; }
  bool sparse() const override { return true; }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;

  std::vector<continuation::Observable> observables() const override;
  void observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
               Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const continuation::Regime& regime, Index which,
                 continuation::Gradient& gradient) const override;

 private:
  Index size_;
  double h_;
};

/// `bratu`
LibraryModel bratu_model();

}  // namespace arcslip::problems
