#pragma once

// The vector and matrix types that every layer shares.

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <complex>

namespace arcslip {

using Index = Eigen::Index;
using Complex = std::complex<double>;
using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using SparseMatrix = Eigen::SparseMatrix<double>;
using ComplexVector = Eigen::VectorXcd;
using ComplexMatrix = Eigen::MatrixXcd;

}  // namespace arcslip
