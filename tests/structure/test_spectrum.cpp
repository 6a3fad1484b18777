#include "arcslip/structure/spectrum.hpp"

#include "arcslip/dense.hpp"
#include "catch.hpp"

using namespace arcslip;

namespace {

double largest(const ComplexMatrix& values) { return values.cwiseAbs().maxCoeff(); }

}  // namespace

TEST_CASE("What a map leaves as it is is found near a vector that it hardly changes") {
  const Matrix turned = exponential(Matrix{{0, 1, 2, 3}, {-1, 0, 4, 5}, {-2, -4, 0, 6}, {-3, -5, -6, 0}});
  const Matrix map = turned * Vector{{1.0, 0.5, -0.3, 0.1}}.asDiagonal() * turned.transpose();
  const Matrix near = turned.col(0) + 1e-4 * turned.col(2);
  const Matrix lasting = lasting_near(map, near);  // of no length in particular
  REQUIRE(largest(map * lasting - lasting) < 1e-12);
  const ComplexMatrix found = lasting_near(ComplexMatrix(map.cast<Complex>()), near.cast<Complex>());
  REQUIRE(largest(map.cast<Complex>() * found - found) < 1e-12);
}
