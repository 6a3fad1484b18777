#include "arcslip/continuation/linear/nearest_eigenvalues.hpp"

#include <algorithm>
#include <cmath>

#include "catch.hpp"

using namespace arcslip;
using arcslip::continuation::nearest_eigenvalues;
using Catch::Matchers::WithinAbs;

namespace {

/// Rotations by `turn` that decay by `rate`, each as a block, coupled to none but the next.
SparseMatrix blocks(Index count, double first) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < count; ++k) {
    const double rate = -first * (k - 2);  // the first ones grow
    const double turn = 0.5 + k;
    entries.emplace_back(2 * k, 2 * k, rate);
    entries.emplace_back(2 * k + 1, 2 * k + 1, rate);
    entries.emplace_back(2 * k, 2 * k + 1, turn);
    entries.emplace_back(2 * k + 1, 2 * k, -turn);
    if (k + 1 < count) entries.emplace_back(2 * k, 2 * k + 2, 0.3);
  }
  SparseMatrix matrix(2 * count, 2 * count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

TEST_CASE("The eigenvalues nearest to 0 are found with their vectors, pairs whole") {
  const Index pairs = GENERATE(60, 400);
  const Index count = GENERATE(9, 20);  // an odd number would part a pair
  const SparseMatrix matrix = blocks(pairs, 0.01);
  ComplexMatrix vectors;
  const ComplexVector values = nearest_eigenvalues(matrix, count, &vectors);
  REQUIRE(values.size() >= count - 1);
  REQUIRE(vectors.cols() == values.size());
  for (Index i = 0; i < values.size(); ++i) {
    const double k = std::abs(values(i).imag()) - 0.5;
    CHECK_THAT(k, WithinAbs(std::round(k), 1e-9));
    CHECK_THAT(values(i).real(), WithinAbs(-0.01 * (k - 2), 1e-9));
    CHECK((values.array() - std::conj(values(i))).abs().minCoeff() < 1e-9);
    const ComplexVector error = matrix * vectors.col(i) - values(i) * vectors.col(i);
    CHECK(error.norm() < 1e-8);
  }
  // none is left out in between
  const double largest = values.cwiseAbs().maxCoeff();
  CHECK(values.size() >= 2 * static_cast<Index>(std::floor(largest - 0.5)));
}

TEST_CASE("A sparse matrix may be singular, and have no entries on its diagonal") {
  const Index n = 300;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i + 1 < n; ++i) {  // a chain without ends: i (2 sin) of the angles k pi/(n + 1)
    entries.emplace_back(i, i + 1, 1);
    entries.emplace_back(i + 1, i, -1);
  }
  SparseMatrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const ComplexVector turning = nearest_eigenvalues(matrix, 8);
  REQUIRE(turning.size() >= 8);
  CHECK(turning.real().cwiseAbs().maxCoeff() < 1e-10);
  for (const Complex& value : turning) {
    const double k = std::acos(value.imag() / 2) / pi * (n + 1);
    CHECK_THAT(k, WithinAbs(std::round(k), 1e-6));
  }
  SparseMatrix singular = blocks(150, 0.01);
  for (Index j = 0; j < 2; ++j) {
    for (SparseMatrix::InnerIterator entry(singular, j); entry; ++entry) entry.valueRef() = 0;
  }
  const ComplexVector values = nearest_eigenvalues(singular, 10);
  REQUIRE(values.size() >= 9);
  CHECK(values.cwiseAbs().minCoeff() < 1e-8);
}
