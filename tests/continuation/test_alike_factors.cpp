// Chains of blocks as orbits have them, eliminated side by side and two by two, against dense matrices.

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "arcslip/continuation/linear/sparse_bordered_solver.hpp"
#include "arcslip/continuation/linear/sparse_factors.hpp"
#include "catch.hpp"

using namespace arcslip;
using namespace arcslip::continuation;

namespace {

struct Chain {
  int links;
  int size;            // of the values at each node
  int inner;           // nodes within a link
  int borders;         // full rows and columns
  double growth = 1;   // of the first value over a link, the last one decays so
  bool loose = false;  // without what ties the ends together but for the borders
};

/// Conditions at the ends stand first, then the rows of each link in the values at its own nodes.
Matrix matrix_of(const Chain& chain, std::mt19937& numbers) {
  std::uniform_real_distribution<double> any(-1, 1);
  const auto random = [&](Index rows, Index columns) {
    return Matrix(Matrix::NullaryExpr(rows, columns, [&] { return any(numbers); }));
  };
  const Index n = chain.size;
  const Index rows = n * (chain.inner + 1);
  const Index size = n + chain.links * rows + chain.borders;
  Matrix all = Matrix::Zero(size, size);
  all.topLeftCorner(n, n) = random(n, n);
  if (!chain.loose) all.block(0, chain.links * rows, n, n) = random(n, n);
  for (Index j = 0; j < chain.links; ++j) {
    auto own = all.block(n + j * rows, j * rows, rows, rows + n);
    own = random(rows, rows + n);
    own.topRows(1) *= 1e3;  // rows of any size
    own.leftCols(1) *= chain.growth;
    own.col(n - 1) /= chain.growth;
  }
  all.rightCols(chain.borders) = random(size, chain.borders);
  all.bottomRows(chain.borders) = random(chain.borders, size);
  return all;
}

void check_factors(const Chain& chain, std::mt19937& numbers, double exact) {
  CAPTURE(chain.links, chain.size, chain.inner, chain.borders, chain.growth, chain.loose);
  SparseMatrix pattern;
  std::unique_ptr<SparseFactors> factors;
  for (int round = 0; round < 2; ++round) {
    const Matrix dense = matrix_of(chain, numbers);
    const SparseMatrix matrix = dense.sparseView();
    if (factors == nullptr) factors = make_alike_factors(matrix, chain.borders);
    REQUIRE(factors != nullptr);
    const Eigen::PartialPivLU<Matrix> all(dense);
    const Vector pivots = all.matrixLU().diagonal();
    const bool is_odd = (pivots.array() < 0).count() % 2 != 0;
    CHECK(factors->factor(matrix) == all.permutationP().determinant() * (is_odd ? -1 : 1));
    LogProduct size;
    factors->multiply_determinant(size);
    CHECK_THAT(size.log(), Catch::Matchers::WithinAbs(pivots.array().abs().log().sum(), exact));
    const Vector right = Vector::LinSpaced(dense.rows(), -1, 2);
    Vector x = right;
    factors->solve(x);
    CHECK((dense * x - right).norm() < exact * (right.norm() + x.norm()));
    x = right;
    factors->solve_transposed(x);
    CHECK((dense.transpose() * x - right).norm() < exact * (right.norm() + x.norm()));
  }
}

}  // namespace

TEST_CASE("Chains of any length have the solutions and determinants of dense matrices", "[sparse]") {
  std::mt19937 numbers(5);
  // As many pairs as there are at least, one less or more, odd numbers on each way down, and four by four.
  for (const int links : {8, 9, 15, 16, 17, 31, 32, 33, 35, 47, 64}) {
    for (const int size : {1, 2, 3}) {
      for (const int borders : {1, 2}) check_factors({links, size, 1, borders}, numbers, 1e-9);
    }
  }
  check_factors({33, 4, 3, 1}, numbers, 1e-9);
  check_factors({36, 2, 3, 1, 1, true}, numbers, 1e-9);
}

TEST_CASE("What grows and decays by decades along a chain loses no digits", "[sparse]") {
  std::mt19937 numbers(7);
  for (const double growth : {1e3, 1e-3, 1e6}) check_factors({34, 3, 1, 1, growth}, numbers, 1e-7);
}

TEST_CASE("Chains that grow to a tip and decay again are solved for to the last digits", "[sparse]") {
  // What has no condition on its phase is solved by u, which is largest at the tip: where its node is
  // eliminated nothing is left to pivot on but full rows.
  const double decades = GENERATE(4.0, 8.0, 10.0, 12.0);
  const int links = GENERATE(64, 100, 321);
  std::mt19937 numbers(7);
  std::uniform_real_distribution<double> any(-1, 1);
  const Index n = 2 * links + 1;  // values, the first and the last of which are one
  const Index tip = links / 3;
  constexpr double some = 1e-13;  // of an entry that the pattern has
  Matrix all = Matrix::NullaryExpr(n + 2, n + 2, [&] { return any(numbers); });
  all.topLeftCorner(n, n).setZero();
  all(0, 0) = 1;
  all(0, n - 1) = -1;
  for (Index j = 0; j < links; ++j) {
    const double growth =
        j < tip ? decades / static_cast<double>(tip) : -decades / static_cast<double>(links - tip);
    const double half = std::pow(10, growth / 2);
    all.block(1 + 2 * j, 2 * j, 2, 3) << -half, 1, some, some, -half, 1;
  }
  const SparseMatrix jacobian = all.topLeftCorner(n + 1, n + 1).sparseView();
  SparseBorderedSolver solver(n + 1, 1);
  solver.set_jacobian(jacobian, Vector::Ones(n + 1));
  solver.columns() = all.topRightCorner(n + 1, 1);
  solver.rows() = all.bottomLeftCorner(1, n + 1);
  solver.corner()(0, 0) = all(n + 1, n + 1);
  const Eigen::FullPivLU<Matrix> dense(all);
  CAPTURE(decades, links, dense.rcond());
  CHECK(solver.factor() == (dense.determinant() > 0 ? 1 : -1));
  const double exact = 1e-15 / dense.rcond();
  const Vector wanted = Vector::NullaryExpr(n + 2, [&] { return any(numbers); });
  Vector x = all * wanted;
  solver.solve(x);
  CHECK((x - wanted).lpNorm<Eigen::Infinity>() < exact);
  x = all.transpose() * wanted;
  solver.solve_transposed(x);
  CHECK((x - wanted).lpNorm<Eigen::Infinity>() < exact);
}
