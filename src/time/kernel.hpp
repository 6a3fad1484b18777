#pragma once

#include <Eigen/LU>

namespace arcslip {

/// Columns x, as many as there are, with matrix x = 0; all unit vectors of a matrix without rows.
template <class Dense>
Dense kernel_of(const Dense& matrix) {
  if (matrix.rows() == 0) return Dense::Identity(matrix.cols(), matrix.cols());
  if (matrix.cols() == 0) return Dense(0, 0);
  const Eigen::FullPivLU<Dense> factors(matrix);
  if (factors.dimensionOfKernel() == 0) return Dense(matrix.cols(), 0);
  return factors.kernel();
}

}  // namespace arcslip
