#include "arcslip/continuation/linear/row_scale.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace arcslip::continuation {

/// By its bits; calls would take a twentieth of all.
double scale_to_one(double x) {
  constexpr int fraction = 52;
  constexpr std::uint64_t most = 2046;  // exponents, from 1
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(x) >> fraction;
  if (exponent < 1 || exponent >= most) return std::ldexp(1.0, -std::ilogb(x));
  return std::bit_cast<double>((most - exponent) << fraction);
}

bool find_row_scale(const SparseMatrix& matrix, Vector& scale) {
  scale.setZero(matrix.rows());
  double* __restrict const largest = scale.data();
  const double* __restrict const values = matrix.valuePtr();
  const int* __restrict const rows = matrix.innerIndexPtr();
  const Index count = matrix.nonZeros();
  for (Index k = 0; k < count; ++k) largest[rows[k]] = std::max(largest[rows[k]], std::abs(values[k]));
  if (!(scale.minCoeff() > 0)) return false;
  for (double& row : scale) row = scale_to_one(row);
  return true;
}

}  // namespace arcslip::continuation
