#pragma once

// The Brusselator on a line, with the species of its rest at both ends, by differences on m intervals of h =
// 1/m:
//
//   x_t = D_x/L^2 x_zz + x^2 y - (B + 1) x + A,   x = A
//   y_t = D_y/L^2 y_zz - x^2 y + B x,             y = B/A    at z = 0 and 1
//
// Unknowns: x_1, y_1, x_2, ... at the inner points. The rest x = A, y = B/A loses its stability to the mode
// sin(k pi z) where L = k pi sqrt((D_x + D_y)/(B - 1 - A^2)): at L = 0.513, with the values below, to k = 1
// [M. Holodniok et al., in Bifurcation: Analysis, Algorithms, Applications, ISNM 79 (1987) 57; K. Lust et
// al., SIAM J. Sci. Comput. 19 (1998) 1188].

#include "arcslip/problems/library/library.hpp"

namespace arcslip::problems {

/// The right-hand sides, sparse. Parameters: L, A, B, D_x, D_y.
class BrusselatorLine : public continuation::Problem {
 public:
  /// `intervals` m >= 2.
  explicit BrusselatorLine(Index intervals) : points_(intervals - 1) {}

  Index size() const override { return 2 * points_; }
  std::vector<std::string> parameter_names() const override { return {"L", "A", "B", "D_x", "D_y"}; }
  bool sparse() const override { return true; }
  bool is_equilibrium() const override { return true; }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;

  /// x_middle: at z = 1/2, between points the mean of both.
  std::vector<continuation::Observable> observables() const override { return {{"x_middle", true}}; }
  void observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
               Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const continuation::Regime& regime, Index which,
                 continuation::Gradient& gradient) const override;

 private:
  void fill(const Vector& u, const Vector& p, SparseMatrix& jacobian) const;

  Index points_;  // inner ones
};

/// `brusselator_1d`
LibraryModel brusselator_1d_model();

}  // namespace arcslip::problems
