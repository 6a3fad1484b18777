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
ComplexMatrix solution_of(const ComplexMatrix& a, const ComplexMatrix& b);
Eigen::Vector2d solution_of(const Eigen::Matrix2d& a, const Eigen::Vector2d& b);

/// X of A X = B by B, of an A that is factored once.
std::function<ComplexMatrix(const ComplexMatrix& b)> solver_of(const ComplexMatrix& a);

/// By complete pivoting; none of a matrix that is singular but for rounding.
std::optional<Matrix> inverse_of(const Matrix& matrix);

double determinant_of(const Matrix& matrix);

/// What a square matrix leaves of itself to be divided by, each the largest of its column.
struct Pivots {
  Vector sizes;  ///< the determinant's is their product
  int sign;      ///< the determinant's
};
Pivots pivots_of(const Matrix& matrix);

/// All eigenvalues of a square matrix, conjugates together, and their vectors of length 1 in the columns of
/// `vectors`, where that is asked for.
ComplexVector eigenvalues(const Matrix& matrix, ComplexMatrix* vectors = nullptr);

/// The sign of the determinant of a square matrix.
int orientation(const Matrix& matrix);

/// How far a square matrix is from being singular: 1/(|A| |A^-1|), about; nan where a pivot is 0.
double reciprocal_condition(const Matrix& matrix);

/// The shortest x of least |A x - b|.
Vector shortest(const Matrix& a, const Vector& b);
Matrix shortest(const Matrix& a, const Matrix& b);
ComplexVector shortest(const ComplexMatrix& a, const ComplexVector& b);
ComplexMatrix shortest(const ComplexMatrix& a, const ComplexMatrix& b);

/// The matrix that makes this x of b.
Matrix pseudo_inverse(const Matrix& matrix);
ComplexMatrix pseudo_inverse(const ComplexMatrix& matrix);

/// x of least |A x - b| by b, of an A that is factored once: of full rank, or the shortest one where pivots
/// below `rank` times the largest are none.
std::function<Vector(const Vector& b)> least_squares_of(const Matrix& a, std::optional<double> rank);

/// As many orthonormal columns that span what these do, which are independent.
Matrix orthonormal(const Matrix& columns);

/// columns = Q R, of as many orthonormal columns and an upper triangle.
void orthogonalise(const Matrix& columns, Matrix& q, Matrix& r);

/// Orthonormal columns that span all that is perpendicular to these; none where one of these, of those that
/// are left the longest first, is but for `rank` a sum of others.
Matrix perpendicular(const Matrix& columns, double rank = 0);

/// Columns x, as many as there are, with matrix x = 0; all unit vectors of a matrix without rows. Pivots
/// below `rank` times the largest are none, without it those that rounding leaves.
Matrix kernel_of(const Matrix& matrix, std::optional<double> rank = {});
ComplexMatrix kernel_of(const ComplexMatrix& matrix, std::optional<double> rank = {});

/// As few rows r as there can be, with the sum of r^H r that the rows of the matrix have.
ComplexMatrix fewest_rows(const ComplexMatrix& matrix);

/// The least pivot of a matrix by columns, of those that are left the longest first.
double least_pivot(const ComplexMatrix& matrix);

/// Orthonormal directions and how large a matrix is along each, the largest first: it maps the unit ball onto
/// the ellipsoid with these axes, and there the columns of `from`.
template <class Dense>
struct SingularAxes {
  Dense directions;
  Vector sizes;
  Dense from;
};
SingularAxes<Matrix> singular_axes(const Matrix& matrix);
SingularAxes<ComplexMatrix> singular_axes(const ComplexMatrix& matrix);

/// x of length 1 of least |A x|, A square.
Vector least_moved(const Matrix& matrix);

/// Whether a symmetric or Hermitian matrix is positive definite; with `rounding`, not nearly singular either,
/// by its reciprocal condition.
bool is_definite(const Matrix& matrix, double rounding);
bool is_definite(const ComplexMatrix& matrix);

/// Values lambda, the least first, and vectors x of A x = lambda B x, x^H B x = 1, B positive definite or,
/// where none is given, 1.
template <class Dense>
struct Pencil {
  Vector values;
  Dense vectors;
};
/// None where the iterations have not converged.
std::optional<Pencil<Matrix>> pencil(const Matrix& a, const Matrix& b);
std::optional<Pencil<Matrix>> pencil(const Matrix& a);
std::optional<Pencil<ComplexMatrix>> pencil(const ComplexMatrix& a, const ComplexMatrix& b);
std::optional<Pencil<ComplexMatrix>> pencil(const ComplexMatrix& a);

/// e^A of a square matrix.
Matrix exponential(const Matrix& matrix);
ComplexMatrix exponential(const ComplexMatrix& matrix);

}  // namespace arcslip
