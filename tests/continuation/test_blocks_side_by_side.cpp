#include "arcslip/continuation/linear/blocks_side_by_side.hpp"

#include <Eigen/LU>

#include "arcslip/dense.hpp"
#include "catch.hpp"

using namespace arcslip;
using arcslip::continuation::BlocksSideBySide;

TEST_CASE("Matrices eliminated side by side have the solutions that each has alone") {
  constexpr Index n = 6;
  constexpr Index behind = 3;
  constexpr Index wanted = 2;
  std::srand(3);
  BlocksSideBySide blocks(n, n + behind, n);
  std::vector<Matrix> all;
  for (Index l = 0; l < BlocksSideBySide::lanes; ++l) {
    Matrix one = Matrix::Random(n, n + behind);
    one(0, 0) = 0;  // a pivot from below, in another row of each
    one(l + 1, 0) = 10;
    for (Index j = 0; j < one.cols(); ++j) {
      for (Index i = 0; i < n; ++i) blocks.at(i, j)[l] = one(i, j);
    }
    all.push_back(std::move(one));
  }
  blocks.eliminate();
  blocks.solve_last(wanted);
  for (Index l = 0; l < BlocksSideBySide::lanes; ++l) {
    const Matrix& one = all[static_cast<std::size_t>(l)];
    const Matrix expected =
        solution_of(Matrix(one.leftCols(n)), Matrix(one.rightCols(behind))).bottomRows(wanted);
    for (Index j = 0; j < behind; ++j) {
      for (Index i = 0; i < wanted; ++i)
        CHECK_THAT(blocks.at(n - wanted + i, n + j)[l], Catch::Matchers::WithinAbs(expected(i, j), 1e-12));
    }
  }
}
