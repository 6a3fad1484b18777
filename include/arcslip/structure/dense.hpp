#pragma once

// What is worked out of dense matrices by Eigen's factorisations, each of which takes seconds to compile:
// here it is once for all, and its header is one of functions.

#include <functional>
#include <optional>

#include "arcslip/types.hpp"

namespace arcslip {

/// x of A x = b, A square.
Vector solution_of(const Matrix& a, const Vector& b);
Matrix solution_of(const Matrix& a, const Matrix& b);
ComplexVector solution_of(const ComplexMatrix& a, const ComplexVector& b);

/// The sign of the determinant of a square matrix.
int orientation(const Matrix& matrix);

/// The shortest x of least |A x - b|.
Vector shortest(const Matrix& a, const Vector& b);
Matrix shortest(const Matrix& a, const Matrix& b);
ComplexVector shortest(const ComplexMatrix& a, const ComplexVector& b);

/// The matrix that makes this x of b.
Matrix pseudo_inverse(const Matrix& matrix);
ComplexMatrix pseudo_inverse(const ComplexMatrix& matrix);

/// x of least |A x - b| by b, of an A that is factored once: of full rank, or the shortest one where pivots
/// below `rank` times the largest are none.
std::function<Vector(const Vector& b)> least_squares_of(const Matrix& a, std::optional<double> rank);

/// As many orthonormal columns that span what these do, which are independent.
Matrix orthonormal(const Matrix& columns);

/// Columns x, as many as there are, with matrix x = 0; all unit vectors of a matrix without rows. Pivots
/// below `rank` times the largest are none, without it those that rounding leaves.
Matrix kernel_of(const Matrix& matrix);
ComplexMatrix kernel_of(const ComplexMatrix& matrix, std::optional<double> rank = {});

/// As few rows r as there can be, with the sum of r^H r that the rows of the matrix have.
ComplexMatrix fewest_rows(const ComplexMatrix& matrix);

/// The least pivot of a matrix by columns, of those that are left the longest first.
double least_pivot(const ComplexMatrix& matrix);

/// Orthonormal directions and how large a matrix is along each, the largest first: it maps the unit ball onto
/// the ellipsoid with these axes.
template <class Dense>
struct SingularAxes {
  Dense directions;
  Vector sizes;
};
SingularAxes<Matrix> singular_axes(const Matrix& matrix);
SingularAxes<ComplexMatrix> singular_axes(const ComplexMatrix& matrix);

/// x of length 1 of least |A x|, A square.
Vector least_moved(const Matrix& matrix);

/// Whether a symmetric or Hermitian matrix is positive definite; with `rounding`, not nearly singular either,
/// by its reciprocal condition.
bool is_definite(const Matrix& matrix, double rounding);
bool is_definite(const ComplexMatrix& matrix);

/// Values lambda, the least first, and vectors x of A x = lambda B x, x^H B x = 1, B positive definite.
template <class Dense>
struct Pencil {
  Vector values;
  Dense vectors;
};
/// None where the iterations have not converged.
std::optional<Pencil<Matrix>> pencil(const Matrix& a, const Matrix& b);
std::optional<Pencil<ComplexMatrix>> pencil(const ComplexMatrix& a, const ComplexMatrix& b);

/// e^A of a square matrix.
Matrix exponential(const Matrix& matrix);
ComplexMatrix exponential(const ComplexMatrix& matrix);

}  // namespace arcslip
