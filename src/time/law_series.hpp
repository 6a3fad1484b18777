#pragma once

#include <vector>

#include "arcslip/elements/piecewise_law.hpp"
#include "arcslip/types.hpp"

namespace arcslip {

/// The zones of a law at displacements; `direction` decides within `loose` of an end.
std::vector<int> zones_of(const PiecewiseLaw& law, const Vector& displacements, const Vector& direction,
                          const Vector& loose);

/// Force and stiffness of elements of one law as Taylor series in time, term by term as those of their
/// displacements become known.
class LawSeries {
 public:
  /// Of nodes in these zones, up to `order`.
  LawSeries(const PiecewiseLaw& law, const std::vector<int>& zones, Index order);

  /// Takes the next term of the displacements.
  void take(const Vector& displacements);

  // The terms that belong to it.
  Vector force() const;
  Vector slope() const;

 private:
  Vector power(Index k) const;

  Matrix coefficients_;         ///< nodes x (degree + 1), of x
  std::vector<Matrix> powers_;  ///< x, x^2, ...: nodes x (order + 1)
  Index last_ = -1;
};

}  // namespace arcslip
