#include "arcslip/continuation/bordered_solver.hpp"
#include "catch.hpp"

using namespace arcslip;
using continuation::BorderedSolver;

namespace {

/// Fills all blocks and returns the whole matrix.
Matrix fill(BorderedSolver& solver, const Matrix& whole) {
  const Index n = solver.size();
  const Index borders = solver.borders();
  solver.jacobian() = whole.topLeftCorner(n, n);
  solver.columns() = whole.topRightCorner(n, borders);
  solver.rows() = whole.bottomLeftCorner(borders, n);
  solver.corner() = whole.bottomRightCorner(borders, borders);
  return whole;
}

}  // namespace

TEST_CASE(
    "Bordered systems of one to three borders are solved, transposed too, with the determinant's sign") {
  const Index n = GENERATE(1, 2, 7, 13, 14, 15, 40);  // on both sides of the size where the method changes
  const Index borders = GENERATE(1, 2, 3);
  BorderedSolver solver(n, borders);
  const Matrix whole = fill(solver, Matrix::Random(n + borders, n + borders));
  const double sign = solver.factor();
  CHECK(sign == (whole.determinant() > 0 ? 1 : -1));
  const Vector expected = Vector::Random(n + borders);
  Vector x = whole * expected;
  solver.solve(x);
  CHECK((x - expected).norm() < 1e-9 * expected.norm());
  x = whole.transpose() * expected;
  solver.solve_transposed(x);
  CHECK((x - expected).norm() < 1e-9 * expected.norm());
}

TEST_CASE("The Jacobian itself may be singular, and any block zero") {
  const bool zero_jacobian = GENERATE(false, true);
  const bool zero_corner = GENERATE(false, true);
  BorderedSolver solver(2, 2);
  Matrix whole(4, 4);
  whole << 1, 2, 1, 0,  //
      2, 4, 0, 1,       //
      1, 0, 3, 1,       //
      0, 1, 1, -2;
  if (zero_jacobian) whole.topLeftCorner(2, 2).setZero();
  if (zero_corner) whole.bottomRightCorner(2, 2).setZero();
  fill(solver, whole);
  REQUIRE(solver.factor() != 0);
  Vector x = whole * Vector::LinSpaced(4, 1, 4);
  solver.solve(x);
  CHECK((x - Vector::LinSpaced(4, 1, 4)).norm() < 1e-13);
}

TEST_CASE("A singular or undefined matrix has the sign 0") {
  const Index n = GENERATE(2, 30);
  BorderedSolver solver(n, 1);
  fill(solver, Matrix::Zero(n + 1, n + 1));
  CHECK(solver.factor() == 0);
  Matrix undefined = Matrix::Identity(n + 1, n + 1);
  undefined(0, 0) = std::nan("");
  fill(solver, undefined);
  CHECK(solver.factor() == 0);
}
