#pragma once

#include <utility>
#include <vector>

#include "arcslip/types.hpp"

namespace arcslip {

/// sum_k c_k x^k, k >= 1, and its slope as Taylor series in time, term by term as those of x become known.
class LawSeries {
 public:
  /// The c_k of each displacement, and how many terms there may be.
  LawSeries(const std::vector<std::vector<double>>& powers, Index terms);

  /// Takes the next term of the displacements.
  void take(const Vector& displacements);

  // The terms that belong to it.
  Vector force() const;
  Vector slope() const;

 private:
  Vector power(Index k) const;

  Matrix coefficients_;         ///< displacements x degree, of x^1, ...
  std::vector<Matrix> powers_;  ///< x, x^2, ...: displacements x terms
  Index last_ = -1;
};

}  // namespace arcslip
