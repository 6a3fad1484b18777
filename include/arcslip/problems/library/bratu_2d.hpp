#pragma once

// Bratu's problem on the unit square, by the five-point formula on m x m squares of h = 1/m:
//
//   u_xx + u_yy + lambda e^u = 0,  u = 0 on the boundary:
//   u_(i-1,j) + u_(i+1,j) + u_(i,j-1) + u_(i,j+1) - 4 u_ij + h^2 lambda e^(u_ij) = 0,   i, j = 1 .. m - 1
//
// Unknowns: u_ij, by rows. Parameter: lambda. Published: the fold lambda = 6.808124423 [Boyd, J. Sci. Comput.
// 1 (1986) 183]; there u = 1.391661206 at the centre, by extrapolation. The differences err by O(h^2).

#include "arcslip/problems/library/library.hpp"

namespace arcslip::problems {

/// The equations above, sparse.
class BratuSquare : public continuation::Problem {
 public:
  /// `intervals` m >= 2 along each side.
  explicit BratuSquare(Index intervals) : side_(intervals - 1), h_(1 / static_cast<double>(intervals)) {}

  Index size() const override { return side_ * side_; }
  std::vector<std::string> parameter_names() const override { return {"lambda"}; }
  bool sparse() const override { return true; }
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;

  /// u_centre: at (1/2, 1/2), between points the mean of four, to O(h^2).
  std::vector<continuation::Observable> observables() const override { return {{"u_centre", true}}; }
  void observe(const Vector& u, const Vector& p, const continuation::Regime& regime,
               Vector& values) const override;
  double observe(const Vector& u, const Vector& p, const continuation::Regime& regime, Index which,
                 continuation::Gradient& gradient) const override;

 private:
  void fill(const Vector& u, double lambda, SparseMatrix& jacobian) const;

  Index side_;  // inner points along it
  double h_;
};

/// `bratu_2d`
LibraryModel bratu_2d_model();

}  // namespace arcslip::problems
