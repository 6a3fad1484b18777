#include "arcslip/continuation/linear/bordered_solver.hpp"

#include <Eigen/LU>
#include <cmath>

#include "catch.hpp"

using namespace arcslip;
using continuation::BorderedSolver;
using continuation::make_bordered_solver;

namespace {

/// Fills all blocks with those of the whole matrix, with every entry of J that is not zero if that is sparse.
void fill(BorderedSolver& solver, const Matrix& whole, bool sparse) {
  const Index n = solver.size();
  const Index borders = solver.borders();
  const Matrix jacobian = whole.topLeftCorner(n, n);
  if (sparse) {
    solver.set_jacobian(SparseMatrix(jacobian.sparseView()), Vector::Ones(n));
  } else {
    solver.set_jacobian(jacobian, Vector::Ones(n));
  }
  solver.columns() = whole.topRightCorner(n, borders);
  solver.rows() = whole.bottomLeftCorner(borders, n);
  solver.corner() = whole.bottomRightCorner(borders, borders);
}

/// Random, but for entries of J that are made zero, on its diagonal too; those beside it keep J regular.
Matrix random_matrix(Index n, Index borders, double density) {
  Matrix whole = Matrix::Random(n + borders, n + borders);
  const Matrix chance = Matrix::Random(n, n);
  whole.topLeftCorner(n, n) =
      (chance.array() < 2 * density - 1).select(whole.topLeftCorner(n, n).array(), 0).matrix();
  for (Index i = 0; i < n; ++i) whole(i, (i + 1) % n) += 2;
  return whole;
}

void check_solutions(BorderedSolver& solver, const Matrix& whole, double tolerance) {
  const Vector expected = Vector::Random(whole.rows());
  Vector x = whole * expected;
  solver.solve(x);
  CHECK((x - expected).norm() < tolerance * expected.norm());
  x = whole.transpose() * expected;
  solver.solve_transposed(x);
  CHECK((x - expected).norm() < tolerance * expected.norm());
}

double sign_of_determinant(const Matrix& whole) { return whole.determinant() > 0 ? 1 : -1; }

}  // namespace

TEST_CASE("Bordered systems of one to four borders are solved, transposed too, with the determinant's sign") {
  const bool sparse = GENERATE(false, true);
  // On both sides of where the dense method changes.
  const Index n = GENERATE(1, 2, 7, 12, 13, 14, 15, 16, 40, 98, 298);
  const Index borders = GENERATE(1, 2, 3, 4);
  CAPTURE(sparse, n, borders);
  const auto solver = make_bordered_solver(n, borders, sparse);
  REQUIRE(solver->size() == n);
  REQUIRE(solver->borders() == borders);
  const Matrix whole = random_matrix(n, borders, 1);
  fill(*solver, whole, sparse);
  CHECK(solver->factor() == sign_of_determinant(whole));
  check_solutions(*solver, whole, 1e-9);
}

TEST_CASE("Columns of the Jacobian are scaled") {
  const bool sparse = GENERATE(false, true);
  const Index n = GENERATE(3, 30);
  Matrix whole = Matrix::Random(n + 1, n + 1);
  const auto solver = make_bordered_solver(n, 1, sparse);
  fill(*solver, whole, sparse);
  const Vector scale = Vector::LinSpaced(n + 1, 1, 5);  // longer than J is wide
  const Matrix jacobian = whole.topLeftCorner(n, n);
  if (sparse) {
    solver->set_jacobian(SparseMatrix(jacobian.sparseView()), scale);
  } else {
    solver->set_jacobian(jacobian, scale);
  }
  whole.topLeftCorner(n, n) *= scale.head(n).asDiagonal();
  CHECK(solver->factor() == sign_of_determinant(whole));
  check_solutions(*solver, whole, 1e-10);
}

TEST_CASE("The Jacobian itself may be singular, and any block zero") {
  const bool sparse = GENERATE(false, true);
  const int zero_blocks = GENERATE(range(0, 8));  // of B, C and D
  const bool zero_jacobian = GENERATE(false, true);
  Matrix whole(4, 4);
  whole << 1, 2, 1, 0,  //
      2, 4, 0, 1,       //
      1, 0, 3, 1,       //
      0, 1, 1, -2;
  if (zero_jacobian) whole.topLeftCorner(2, 2).setZero();
  if ((zero_blocks & 1) != 0) whole.topRightCorner(2, 2).setZero();
  if ((zero_blocks & 2) != 0) whole.bottomLeftCorner(2, 2).setZero();
  if ((zero_blocks & 4) != 0) whole.bottomRightCorner(2, 2).setZero();
  CAPTURE(sparse, zero_blocks, zero_jacobian);
  const auto solver = make_bordered_solver(2, 2, sparse);
  fill(*solver, whole, sparse);
  if (std::abs(whole.determinant()) < 1e-9) {
    CHECK(solver->factor() == 0);
    return;
  }
  CHECK(solver->factor() == sign_of_determinant(whole));
  check_solutions(*solver, whole, 1e-13);
}

TEST_CASE("A singular or undefined matrix has the sign 0, and does not spoil the next one") {
  const bool sparse = GENERATE(false, true);
  const Index n = GENERATE(2, 30, 130, 310);
  const auto solver = make_bordered_solver(n, 1, sparse);
  CHECK(solver->factor() == 0);  // nothing was set
  const Matrix identity = Matrix::Identity(n + 1, n + 1);
  const double bad = GENERATE(0.0, std::nan(""), HUGE_VAL);
  for (const Index at : {Index{0}, n}) {
    Matrix whole = identity;
    fill(*solver, whole, sparse);
    CHECK(solver->factor() == 1);
    whole(at, at) = bad;
    fill(*solver, whole, sparse);
    CHECK(solver->factor() == 0);
  }
  fill(*solver, -identity, sparse);
  CHECK(solver->factor() == (n % 2 == 0 ? -1 : 1));
  check_solutions(*solver, -identity, 1e-15);
}

TEST_CASE("A Jacobian of the wrong kind is refused") {
  CHECK_THROWS_AS(make_bordered_solver(2, 1, true)->set_jacobian(Matrix::Zero(2, 2).eval(), Vector::Ones(2)),
                  std::logic_error);
  CHECK_THROWS_AS(make_bordered_solver(2, 1, false)->set_jacobian(SparseMatrix(2, 2), Vector::Ones(2)),
                  std::logic_error);
  CHECK_THROWS_AS(make_bordered_solver(2, 1, true)->set_jacobian(SparseMatrix(3, 3), Vector::Ones(2)),
                  std::invalid_argument);
}

TEST_CASE("Sparse and dense agree, also where J has zeros on its diagonal") {
  const Index n = GENERATE(10, 60);
  const Index borders = GENERATE(1, 2, 3);
  const int repetition = GENERATE(range(0, 5));
  CAPTURE(n, borders, repetition);
  const Matrix whole = random_matrix(n, borders, 0.3);
  const auto dense = make_bordered_solver(n, borders, false);
  const auto sparse = make_bordered_solver(n, borders, true);
  fill(*dense, whole, false);
  fill(*sparse, whole, true);
  REQUIRE(dense->factor() != 0);
  CHECK(dense->factor() == sparse->factor());
  check_solutions(*sparse, whole, 1e-10);
}

TEST_CASE("A sparse matrix is factored again after its values changed, however strongly, and its pattern") {
  const Index n = 30;
  const Matrix pattern = random_matrix(n, 1, 0.2);
  const auto solver = make_bordered_solver(n, 1, true);
  fill(*solver, pattern, true);
  solver->factor();
  for (int change = 0; change < 8; ++change) {
    const double decades = change;  // either way, of each entry
    const Matrix factors = (decades * Matrix::Random(n + 1, n + 1)).array().unaryExpr([](double x) {
      return std::pow(10.0, x);
    });
    const Matrix whole = pattern.cwiseProduct(factors);
    CAPTURE(change);
    fill(*solver, whole, true);
    const double sign = solver->factor();
    REQUIRE(sign != 0);
    if (change < 6) CHECK(sign == sign_of_determinant(whole));
    const Vector expected = Vector::Random(n + 1);
    const Vector right = whole * expected;
    Vector x = right;
    solver->solve(x);
    // Backward error, by rows, whose sizes differ.
    const Vector size = whole.cwiseAbs() * x.cwiseAbs() + right.cwiseAbs();
    CHECK(((whole * x - right).array() / size.array()).abs().maxCoeff() < 1e-10);
  }
  const Matrix other = random_matrix(n, 1, 0.5);
  fill(*solver, other, true);
  CHECK(solver->factor() == sign_of_determinant(other));
  check_solutions(*solver, other, 1e-10);
}

TEST_CASE("A sparse Jacobian that is singular up to any distance loses no digits") {
  const Index n = 50;
  const double distance = std::pow(10.0, -GENERATE(range(0, 18)));
  CAPTURE(distance);
  Matrix whole = Matrix::Zero(n + 1, n + 1);
  const double pi = std::acos(-1.0);
  const double lowest = 2 - 2 * std::cos(pi / static_cast<double>(n + 1));
  for (Index i = 0; i < n; ++i) {
    whole(i, i) = 2 - lowest * (1 - distance);
    if (i + 1 < n) whole(i, i + 1) = whole(i + 1, i) = -1;
    whole(i, n) = whole(n, i) = 1;
  }
  const auto solver = make_bordered_solver(n, 1, true);
  fill(*solver, whole, true);
  CHECK(solver->factor() == sign_of_determinant(whole));
  check_solutions(*solver, whole, 1e-11);
}

TEST_CASE("A sparse Jacobian may lack as much rank as there are borders") {
  const Index borders = GENERATE(1, 2, 3);
  const Index length = 20;
  const Index n = borders * length;
  CAPTURE(borders);
  Matrix whole = Matrix::Random(n + borders, n + borders);
  whole.topLeftCorner(n, n).setZero();
  const double lowest = 2 - 2 * std::cos(std::acos(-1.0) / static_cast<double>(length + 1));
  for (Index i = 0; i < n; ++i) {  // as many chains, each with one null vector
    whole(i, i) = 2 - lowest;
    if ((i + 1) % length != 0) whole(i, i + 1) = whole(i + 1, i) = -1;
  }
  whole.bottomRightCorner(borders, borders).setZero();
  const auto dense = make_bordered_solver(n, borders, false);
  const auto sparse = make_bordered_solver(n, borders, true);
  fill(*dense, whole, false);
  fill(*sparse, whole, true);
  CHECK(dense->factor() == sign_of_determinant(whole));
  CHECK(sparse->factor() == dense->factor());
  for (const bool transposed : {false, true}) {
    const Vector right = Vector::Random(n + borders);
    Vector expected = right;
    Vector x = right;
    if (transposed) {
      dense->solve_transposed(expected);
      sparse->solve_transposed(x);
    } else {
      dense->solve(expected);
      sparse->solve(x);
    }
    CHECK((x - expected).norm() < 1e-10 * expected.norm());  // conditions up to 1e5
  }
}

TEST_CASE("Chains of blocks are solved as a dense matrix is, however much solutions grow along them") {
  const Index n = GENERATE(1, 2, 3, 5);  // unknowns at each end of a block
  const Index inner = GENERATE(0, 1, 4);
  const double decades = GENERATE(0.0, 1.0, 4.0);  // by which they grow or decay in each block
  const bool separated = GENERATE(false, true);    // conditions at one end each, or of both
  const Index blocks = 12;
  const Index rows = n + inner;
  const Index size = rows * blocks + n;
  CAPTURE(n, inner, decades, separated);
  std::srand(1);  // whatever other tests have drawn before
  Matrix whole = Matrix::Zero(size + 1, size + 1);
  for (Index j = 0; j < blocks; ++j) {
    auto block = whole.block(j * rows, j * rows, rows, rows + n);
    block = 0.3 * Matrix::Random(rows, rows + n);
    for (Index i = 0; i < inner; ++i) block(i, n + i) += 2;
    for (Index i = 0; i < n; ++i) {  // the first ones grow
      const double step = std::pow(10.0, i < n / 2 ? decades : -decades);
      block(inner + i, i) = -step;
      block(inner + i, rows + i) = 1;
    }
  }
  for (Index i = 0; i < n; ++i) {
    const Index row = rows * blocks + i;
    if (!separated || i >= n / 2) whole(row, i) = 1;  // those that decay are given where they begin
    if (!separated || i < n / 2) whole(row, rows * blocks + i) = separated ? 1 : -1;
  }
  whole.col(size) = Vector::Random(size + 1);
  whole.row(size) = Vector::Random(size + 1);
  const auto dense = make_bordered_solver(size, 1, false);
  const auto sparse = make_bordered_solver(size, 1, true);
  fill(*dense, whole, false);
  fill(*sparse, whole, true);
  CHECK(sparse->factor() == dense->factor());
  continuation::LogProduct expected;
  continuation::LogProduct found;
  dense->multiply_determinant(expected);
  sparse->multiply_determinant(found);
  CHECK(std::abs(found.log() - expected.log()) < 1e-9 * (1 + std::abs(expected.log())));
  const Vector solution = Vector::Random(size + 1);
  const auto check = [&](const Matrix& matrix, Vector x) {  // backward error, by rows
    const Vector right = matrix * solution;
    const Vector sizes = matrix.cwiseAbs() * x.cwiseAbs() + right.cwiseAbs();
    CHECK(((matrix * x - right).array() / sizes.array()).abs().maxCoeff() < 1e-12);
  };
  Vector x = whole * solution;
  sparse->solve(x);
  check(whole, x);
  x = whole.transpose() * solution;
  sparse->solve_transposed(x);
  check(whole.transpose(), x);
}
