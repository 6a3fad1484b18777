#pragma once

// The vector and matrix types that every layer shares.

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <complex>
#include <numbers>

// Other settings would overrun or free wrongly what the library has allocated.
static_assert(EIGEN_MAX_ALIGN_BYTES == 16 && EIGEN_MALLOC_ALREADY_ALIGNED == 0,
              "compile with the definitions that the CMake target arcslip::arcslip brings");

namespace arcslip {

using Index = Eigen::Index;
using Complex = std::complex<double>;
using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using SparseMatrix = Eigen::SparseMatrix<double>;
using ComplexVector = Eigen::VectorXcd;
using ComplexMatrix = Eigen::MatrixXcd;

inline constexpr double pi = std::numbers::pi;
inline constexpr double two_pi = 2 * pi;

}  // namespace arcslip
