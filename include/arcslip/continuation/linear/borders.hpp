#pragma once

// What the choice of borders has in common.

#include <cmath>

#include "arcslip/continuation/problem/linearization.hpp"

namespace arcslip::continuation {

/// A vector without symmetry, of unit length, as a first border: it must not be orthogonal to a null vector.
inline Vector spread(Index size, int which) {
  Vector v(size);
  for (Index i = 0; i < size; ++i) v(i) = 1 + 0.5 * std::sin(1.7 * static_cast<double>(i) + which);
  return v.normalized();
}

/// As the first entries of so many, 0 behind them.
inline Vector padded(const Eigen::Ref<const Vector>& v, Index size) {
  Vector result = Vector::Zero(size);
  result.head(v.size()) = v;
  return result;
}

/// The largest entry.
inline Complex largest_entry(const ComplexVector& v) {
  Index largest = 0;
  v.cwiseAbs().maxCoeff(&largest);
  return v(largest);
}

/// The size of dF/du D, its largest row sum, for columns beside it. Where dF/du vanishes as a whole, as at
/// the folds of a single unknown, 1, which is large for F.
inline double column_size(const Linearization& at, const Vector& scale) {
  Vector sums(scale.size());
  at.multiply_absolute(scale, sums);
  const double size = sums.lpNorm<Eigen::Infinity>();
  return size > 1e-3 ? size : 1;
}

/// Which of the values is nearest to a way off what is known, by the function that tells how far off each is.
template <class Off>
Index nearest_to(const ComplexVector& values, const Off& off, Complex way) {
  Index nearest = 0;
  for (Index i = 1; i < values.size(); ++i)
    if (std::abs(off(values(i)) - way) < std::abs(off(values(nearest)) - way)) nearest = i;
  return nearest;
}

/// Takes the value that is the least off out of the list, and tells how far it is.
template <class Off>
Complex take_nearest(ComplexVector& values, const Off& off) {
  const Index nearest = nearest_to(values, off, 0);
  const Complex away = off(values(nearest));
  std::swap(values(nearest), values(values.size() - 1));
  values = ComplexVector(values.head(values.size() - 1));
  return away;
}

/// The same of one that is known to be `real`. Next to a second one rounding may have made a pair of the two:
/// then the other one is their sum, which is as exact as the trace.
template <class Off>
void take_real(ComplexVector& values, const Off& off, Complex real) {
  const Complex away = take_nearest(values, off);
  if (away.imag() == 0 || values.size() == 0) return;
  values(nearest_to(values, off, std::conj(away))) = real + 2 * away.real();
}

/// Takes the eigenvalue that is nearest to `away` out of the list.
inline void remove_nearest(ComplexVector& values, Complex away) {
  take_nearest(values, [=](Complex value) { return value - away; });
}

/// Takes an eigenvalue out that is known to be zero.
inline void remove_zero(ComplexVector& values) {
  take_real(
      values, [](Complex value) { return value; }, 0);
}

}  // namespace arcslip::continuation
