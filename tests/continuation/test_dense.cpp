#include "arcslip/dense.hpp"

#include <random>

#include "arcslip/continuation/linear/complex_sparse_factors.hpp"
#include "catch.hpp"

using namespace arcslip;

namespace {

Matrix random_matrix(Index rows, Index columns, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Matrix::NullaryExpr(rows, columns, [&] { return uniform(engine); });
}

ComplexMatrix random_complex(Index rows, Index columns, unsigned seed) {
  return random_matrix(rows, columns, seed) + Complex(0, 1) * random_matrix(rows, columns, seed + 100);
}

template <class Dense>
double largest(const Dense& values) {
  return values.size() == 0 ? 0 : values.cwiseAbs().maxCoeff();
}

/// The four conditions of Penrose, of which one matrix alone fulfils all.
template <class Dense>
void require_inverse(const Dense& a, const Dense& inverse) {
  const Dense onto = a * inverse;
  const Dense back = inverse * a;
  REQUIRE(largest(Dense(onto * a - a)) < 1e-12);
  REQUIRE(largest(Dense(back * inverse - inverse)) < 1e-12);
  REQUIRE(largest(Dense(onto - onto.adjoint())) < 1e-12);
  REQUIRE(largest(Dense(back - back.adjoint())) < 1e-12);
}

}  // namespace

TEST_CASE("Linear equations are solved, and the sign of a determinant changes with two rows") {
  const Index n = GENERATE(1, 2, 7, 20);
  const Matrix a = random_matrix(n, n, 1);
  const ComplexMatrix c = random_complex(n, n, 2);
  const Vector b = random_matrix(n, 1, 3).col(0);
  const Matrix many = random_matrix(n, 3, 4);
  const ComplexVector right = random_complex(n, 1, 5).col(0);
  REQUIRE(largest(Vector(a * solution_of(a, b) - b)) < 1e-11);
  REQUIRE(largest(Matrix(a * solution_of(a, many) - many)) < 1e-11);
  REQUIRE(largest(ComplexVector(c * solution_of(c, right) - right)) < 1e-11);
  const ComplexMatrix columns = random_complex(n, 2, 6);
  REQUIRE(largest(ComplexMatrix(c * solution_of(c, columns) - columns)) < 1e-11);
  const auto solver = solver_of(c);
  REQUIRE(largest(ComplexMatrix(c * solver(columns) - columns)) < 1e-11);
  REQUIRE(largest(ComplexMatrix(c * solver(right) - right)) < 1e-11);
  const auto inverse = inverse_of(a);
  REQUIRE(inverse);
  REQUIRE(largest(Matrix(a * *inverse - Matrix::Identity(n, n))) < 1e-11);
  REQUIRE(reciprocal_condition(a) > 1e-4);
  const Pivots pivots = pivots_of(a);
  REQUIRE(pivots.sign * pivots.sizes.prod() == Approx(determinant_of(a)));
  REQUIRE(pivots.sign == orientation(a));
  REQUIRE(orientation(Matrix::Identity(n, n)) == 1);
  REQUIRE(orientation(-Matrix::Identity(n, n)) == (n % 2 == 0 ? 1 : -1));
  if (n == 1) return;
  Matrix swapped = a;
  swapped.row(0).swap(swapped.row(1));
  REQUIRE(orientation(swapped) == -orientation(a));
  swapped.row(0) = swapped.row(1);
  REQUIRE_FALSE(inverse_of(swapped));
  REQUIRE_FALSE(reciprocal_condition(swapped) > 1e-14);
  const Eigen::Matrix2d two = a.topLeftCorner<2, 2>();
  REQUIRE(largest(Vector(two * solution_of(two, Eigen::Vector2d(3, -1)) - Eigen::Vector2d(3, -1))) < 1e-11);
}

TEST_CASE("Sparse complex equations are solved, and those of the adjoint matrix") {
  const Index n = GENERATE(1, 5, 60);
  const ComplexMatrix dense = random_complex(n, n, 1);
  ComplexSparse matrix = dense.sparseView(1, 0.3);
  for (Index i = 0; i < n; ++i) matrix.coeffRef(i, i) += 5;
  const ComplexVector right = random_complex(n, 1, 2).col(0);
  const ComplexSparseFactors factors(matrix);
  REQUIRE(largest(ComplexVector(matrix * factors.solve(right) - right)) < 1e-11);
  const ComplexSparse adjoint = matrix.adjoint();
  REQUIRE(largest(ComplexVector(adjoint * factors.solve_adjoint(right) - right)) < 1e-11);
  for (ComplexSparse::InnerIterator entry(matrix, 0); entry; ++entry) entry.valueRef() = 0;
  const ComplexSparseFactors none(matrix);
  REQUIRE_FALSE(none.solve(right).allFinite());
  REQUIRE_FALSE(none.solve_adjoint(right).allFinite());
}

TEST_CASE("Equations of lower rank have their shortest least squares") {
  const Index rank = GENERATE(1, 3, 4);
  const Matrix a = random_matrix(6, rank, 1) * random_matrix(rank, 4, 2);
  const ComplexMatrix c = random_complex(6, rank, 3) * random_complex(rank, 4, 4);
  require_inverse(a, pseudo_inverse(a));
  require_inverse(c, pseudo_inverse(c));
  const Matrix many = random_matrix(6, 2, 5);
  const Vector b = many.col(0);
  const ComplexVector right = random_complex(6, 1, 6).col(0);
  REQUIRE(largest(Vector(shortest(a, b) - pseudo_inverse(a) * b)) < 1e-12);
  REQUIRE(largest(Matrix(shortest(a, many) - pseudo_inverse(a) * many)) < 1e-12);
  REQUIRE(largest(ComplexVector(shortest(c, right) - pseudo_inverse(c) * right)) < 1e-12);
  const ComplexMatrix rights = random_complex(6, 2, 7);
  REQUIRE(largest(ComplexMatrix(shortest(c, rights) - pseudo_inverse(c) * rights)) < 1e-12);
  REQUIRE(largest(Vector(least_squares_of(a, 1e-10)(b) - shortest(a, b))) < 1e-12);
  if (rank == 4) REQUIRE(largest(Vector(least_squares_of(a, {})(b) - shortest(a, b))) < 1e-12);
}

TEST_CASE("A kernel has all that a matrix makes nothing of") {
  const Index rank = GENERATE(1, 3, 5);
  const ComplexMatrix c = random_complex(6, rank, 1) * random_complex(rank, 5, 2);
  const ComplexMatrix kernel = kernel_of(c, 1e-10);
  REQUIRE(kernel.rows() == 5);
  REQUIRE(kernel.cols() == 5 - rank);
  REQUIRE(largest(ComplexMatrix(c * kernel)) < 1e-12);
  const Matrix integers{{1, 2, 3}, {2, 4, 6}};
  REQUIRE(kernel_of(integers).cols() == 2);
  REQUIRE(largest(Matrix(integers * kernel_of(integers))) < 1e-14);
  const Matrix nearly{{1, 0}, {0, 1e-6}};
  REQUIRE(kernel_of(nearly).cols() == 0);
  REQUIRE(kernel_of(nearly, 1e-5).cols() == 1);
  REQUIRE(kernel_of(Matrix(0, 3)) == Matrix::Identity(3, 3));
  REQUIRE(kernel_of(Matrix(3, 0)).size() == 0);
}

TEST_CASE("Columns are made orthonormal in their span, rows fewer with the same products") {
  const Matrix columns = random_matrix(7, 3, 1);
  const Matrix unit = orthonormal(columns);
  REQUIRE(largest(Matrix(unit.transpose() * unit - Matrix::Identity(3, 3))) < 1e-14);
  REQUIRE(largest(Matrix(unit * unit.transpose() * columns - columns)) < 1e-14);
  Matrix q;
  Matrix r;
  orthogonalise(columns, q, r);
  REQUIRE(largest(Matrix(q - unit)) < 1e-14);
  REQUIRE(r.isUpperTriangular());
  REQUIRE(largest(Matrix(q * r - columns)) < 1e-14);
  const Matrix others = perpendicular(columns);
  REQUIRE(others.cols() == 4);
  REQUIRE(largest(Matrix(others.transpose() * others - Matrix::Identity(4, 4))) < 1e-14);
  REQUIRE(largest(Matrix(others.transpose() * columns)) < 1e-14);
  Matrix alike(7, 2);
  alike << columns.col(0), columns.col(0) + 1e-6 * columns.col(1);
  REQUIRE(perpendicular(alike).cols() == 5);
  REQUIRE(perpendicular(alike, 1e-5).cols() == 0);
  const ComplexMatrix rows = random_complex(8, 2, 2) * random_complex(2, 5, 3);
  const ComplexMatrix few = fewest_rows(rows);
  REQUIRE(few.rows() == 2);
  REQUIRE(largest(ComplexMatrix(few.adjoint() * few - rows.adjoint() * rows)) < 1e-12);
  REQUIRE(least_pivot(rows) < 1e-12);
  REQUIRE(least_pivot(ComplexMatrix(Complex(0, 3) * ComplexMatrix::Identity(4, 2))) == Approx(3));
}

TEST_CASE("Axes of what a matrix makes of a ball are those of its square, the largest first") {
  const ComplexMatrix c = random_complex(5, 3, 1);
  const SingularAxes<ComplexMatrix> axes = singular_axes(c);
  REQUIRE(axes.sizes.size() == 3);
  const ComplexMatrix square =
      axes.directions * axes.sizes.cwiseAbs2().asDiagonal() * axes.directions.adjoint();
  REQUIRE(largest(ComplexMatrix(square - c * c.adjoint())) < 1e-13);
  REQUIRE(largest(ComplexMatrix(c * axes.from - axes.directions * axes.sizes.asDiagonal())) < 1e-13);
  const Matrix scaled{{0, 2}, {-5, 0}, {0, 0}};
  const SingularAxes<Matrix> known = singular_axes(scaled);
  REQUIRE(known.sizes(0) == Approx(5));
  REQUIRE(known.sizes(1) == Approx(2));
  REQUIRE(std::abs(known.directions(1, 0)) == Approx(1));
  const Index n = GENERATE(2, 5, 40);
  const Matrix a = random_matrix(n, n, 2);
  const Vector least = least_moved(a);
  REQUIRE(least.norm() == Approx(1));
  REQUIRE((a * least).norm() == Approx(singular_axes(a).sizes(n - 1)).epsilon(1e-9));
}

TEST_CASE("Pencils have their values and vectors, and only definite matrices are definite") {
  const Index n = 6;
  const Matrix half = random_matrix(n, n, 1);
  const Matrix b = half * half.transpose() + Matrix::Identity(n, n);
  const Matrix a = half + half.transpose();
  const auto real = pencil(a, b);
  REQUIRE(real);
  REQUIRE(largest(Matrix(a * real->vectors - b * real->vectors * real->values.asDiagonal())) < 1e-11);
  REQUIRE(largest(Matrix(real->vectors.transpose() * b * real->vectors - Matrix::Identity(n, n))) < 1e-12);
  const ComplexMatrix root = random_complex(n, n, 2);
  const ComplexMatrix mass = root * root.adjoint() + ComplexMatrix::Identity(n, n);
  const ComplexMatrix stiffness = root + root.adjoint();
  const auto found = pencil(stiffness, mass);
  REQUIRE(found);
  REQUIRE(largest(ComplexMatrix(stiffness * found->vectors -
                                mass * found->vectors * found->values.cast<Complex>().asDiagonal())) < 1e-11);
  REQUIRE(std::is_sorted(found->values.begin(), found->values.end()));
  REQUIRE(is_definite(b, 1e-12));
  REQUIRE_FALSE(is_definite(Matrix(-b), 1e-12));
  REQUIRE_FALSE(is_definite(Matrix(Vector{{1.0, 1e-14}}.asDiagonal()), 1e-12));
  REQUIRE(is_definite(mass));
  REQUIRE_FALSE(is_definite(stiffness));
}

TEST_CASE("Exponentials turn, grow and follow one another") {
  const double angle = GENERATE(1e-3, 0.1, 0.7, 2.0, 30.0);  // of all the orders in which they are worked out
  const Matrix turn = exponential(Matrix(angle * Matrix{{0, -1}, {1, 0}}));
  REQUIRE(turn(0, 0) == Approx(std::cos(angle)).margin(1e-13));
  REQUIRE(turn(1, 0) == Approx(std::sin(angle)).margin(1e-13));
  const ComplexMatrix c = angle * random_complex(4, 4, 1);
  const ComplexMatrix whole = exponential(c);
  const ComplexMatrix half = exponential(ComplexMatrix(0.5 * c));
  REQUIRE(largest(ComplexMatrix(half * half - whole)) < 1e-12 * largest(whole));
}
