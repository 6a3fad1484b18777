#include <Eigen/SparseCholesky>
#include <random>

#include "arcslip/dense.hpp"
#include "catch.hpp"
#include "sector_examples.hpp"
#include "sectors/cholesky.hpp"

using namespace arcslip;

namespace {

template <class Scalar>
using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

/// Of a random graph with so many edges, its diagonal just larger than the rest of each row.
template <class Scalar>
Eigen::SparseMatrix<Scalar> random_definite(int size, int edges, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_int_distribution<int> any(0, size - 1);
  Dense<Scalar> matrix = Dense<Scalar>::Zero(size, size);
  for (int i = 0; i < edges; ++i) {
    const int row = any(generator);
    const int column = any(generator);
    if (row == column) continue;
    const Scalar value = Dense<Scalar>::Random(1, 1)(0);
    matrix(row, column) += value;
    matrix(column, row) += Eigen::numext::conj(value);
  }
  matrix.diagonal() = (matrix.cwiseAbs().rowwise().sum().array() * 1.01 + 0.01).template cast<Scalar>();
  return matrix.sparseView();
}

/// Solves for several columns, and says by how much the products with the matrix miss them.
template <class Scalar>
double missed_by(const Eigen::SparseMatrix<Scalar>& matrix, Cholesky<Scalar>& factors) {
  REQUIRE(factors.factor(matrix));
  const Dense<Scalar> right = Dense<Scalar>::Random(matrix.rows(), 3);
  Dense<Scalar> x = right;
  factors.solve(x);
  return (matrix * x - right).norm() / right.norm();
}

}  // namespace

TEMPLATE_TEST_CASE("Fronts solve what dense matrices solve, of any graph", "", double, Complex) {
  const int size = GENERATE(1, 2, 7, 60, 300);
  const double edges_each = GENERATE(0.0, 0.5, 2.0, 20.0);  // in parts, as trees and as one block
  CAPTURE(size, edges_each);
  const auto matrix =
      random_definite<TestType>(size, static_cast<int>(edges_each * size), static_cast<unsigned>(size));
  Cholesky<TestType> factors(matrix);
  CHECK(missed_by(matrix, factors) < 1e-13);
  // Other values on the same pattern.
  Eigen::SparseMatrix<TestType> other = matrix;
  for (int j = 0; j < size; ++j) other.coeffRef(j, j) *= 2 + j % 3;
  CHECK(missed_by(other, factors) < 1e-13);
}

TEMPLATE_TEST_CASE("A matrix is found indefinite exactly where its least eigenvalue is below zero", "",
                   double, Complex) {
  const int size = GENERATE(2, 40);
  Eigen::SparseMatrix<TestType> matrix = random_definite<TestType>(size, 3 * size, 5);
  const double least = pencil(Dense<TestType>(matrix)).value().values(0);
  Cholesky<TestType> factors(matrix);
  for (const double shift : {0.999, 1.001}) {
    Eigen::SparseMatrix<TestType> shifted = matrix;
    for (int j = 0; j < size; ++j) shifted.coeffRef(j, j) -= shift * least;
    CHECK(factors.factor(shifted) == (shift < 1));
  }
  CHECK(factors.indefinite_at() >= 0);
  CHECK(factors.indefinite_at() < size);
}

TEST_CASE("Of a diagonal matrix the row that is not positive is named, also where it has no entry") {
  Vector diagonal = Vector::Ones(9);
  diagonal(4) = GENERATE(-1.0, 0.0);
  SparseMatrix matrix = testing::sparse(diagonal.asDiagonal());
  Cholesky<double> factors(matrix);
  CHECK_FALSE(factors.factor(matrix));
  CHECK(factors.indefinite_at() == 4);
}

TEST_CASE(
    "A grid in three dimensions is eliminated with no more entries than by minimum degree and a fifth") {
  const int side = 12;
  const auto dof = [](int x, int y, int z) { return (x * side + y) * side + z; };
  std::vector<Eigen::Triplet<double>> entries;
  const auto connect = [&](int a, int b) {
    entries.emplace_back(a, b, -1.0);
    entries.emplace_back(b, a, -1.0);
  };
  for (int x = 0; x < side; ++x) {
    for (int y = 0; y < side; ++y) {
      for (int z = 0; z < side; ++z) {
        entries.emplace_back(dof(x, y, z), dof(x, y, z), 6.1);
        if (x > 0) connect(dof(x, y, z), dof(x - 1, y, z));
        if (y > 0) connect(dof(x, y, z), dof(x, y - 1, z));
        if (z > 0) connect(dof(x, y, z), dof(x, y, z - 1));
      }
    }
  }
  SparseMatrix matrix(side * side * side, side * side * side);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Elimination elimination(symmetric_pattern(matrix));
  std::size_t kept = 0;
  std::vector<int> seen(static_cast<std::size_t>(matrix.rows()), 0);
  for (const Elimination::Front& front : elimination.fronts()) {
    kept += front.height() * static_cast<std::size_t>(front.width);
    for (int j = 0; j < front.width; ++j) ++seen[static_cast<std::size_t>(front.first + j)];
  }
  CHECK(seen == std::vector<int>(seen.size(), 1));
  const Eigen::SimplicialLLT<SparseMatrix> reference(matrix);
  CHECK(static_cast<double>(kept) < 1.2 * static_cast<double>(SparseMatrix(reference.matrixL()).nonZeros()));
  Cholesky<double> factors(matrix);
  CHECK(missed_by(matrix, factors) < 1e-13);
}
