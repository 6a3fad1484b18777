#include <numbers>

#include "arcslip/dense.hpp"
#include "arcslip/sectors/dynamic_stiffness.hpp"
#include "arcslip/structure/sector.hpp"
#include "catch.hpp"

using namespace arcslip;

namespace {

Matrix rounded(const PreciseMatrix& matrix) { return matrix.cast<double>(); }

/// Ring of `count` elements assembled whole, J dofs to a node.
Matrix assemble_ring(const Matrix& element, Index count) {
  const Index j = element.rows() / 2;
  Matrix ring = Matrix::Zero(count * j, count * j);
  for (Index e = 0; e < count; ++e) {
    const Index nodes[2] = {e * j, (e + 1) % count * j};
    for (Index a = 0; a < 2; ++a) {
      for (Index b = 0; b < 2; ++b) ring.block(nodes[a], nodes[b], j, j) += element.block(a * j, b * j, j, j);
    }
  }
  return ring;
}

}  // namespace

TEST_CASE("Without interior dofs a sector reduces to A11 + A22 + A12 e^{-ja} + A21 e^{ja}") {
  const Index j = GENERATE(1, 2, 3, 5);
  const Matrix a = Matrix::Random(2 * j, 2 * j);
  const Complex forward = std::polar(1.0, -0.83);
  const ComplexMatrix expected = a.topLeftCorner(j, j) + a.bottomRightCorner(j, j) +
                                 a.topRightCorner(j, j) * forward +
                                 a.bottomLeftCorner(j, j) * std::conj(forward);
  CHECK((reduce_sector(a, j, forward) - expected).norm() < 1e-14 * expected.norm());
}

TEST_CASE("A sector with interior dofs reduces to T^H A T") {
  const Index boundary = 2;
  const Index interior = 3;
  Matrix a = Matrix::Random(7, 7);
  a = (a + a.transpose()).eval();
  const Complex forward = std::polar(1.0, -1.1);
  ComplexMatrix t = ComplexMatrix::Zero(7, 5);
  t.topLeftCorner(5, 5).setIdentity();
  t.bottomLeftCorner(boundary, boundary) = forward * ComplexMatrix::Identity(boundary, boundary);
  const ComplexMatrix reduced = reduce_sector(a, boundary, forward);
  CHECK(reduced.rows() == boundary + interior);
  CHECK((reduced - t.adjoint() * a * t).norm() < 1e-13);
  CHECK((reduced - reduced.adjoint()).norm() < 1e-14);
  const Vector load = Vector::Random(7);
  CHECK((reduce_load(load, boundary, forward) - t.adjoint() * load).norm() < 1e-14);
}

TEST_CASE(
    "Two elements taken as one sector with an interior node give the response of the ring of elements") {
  const Index elements = 12;
  const ChainElement element = beam_element(1, 1, 1, elements);
  const Complex forward = std::polar(1.0, -4 * std::numbers::pi / static_cast<double>(elements));
  const auto pair = [&](const PreciseMatrix& precise) {  // nodes left, middle, right
    const Matrix a = rounded(precise);
    Matrix sector = Matrix::Zero(6, 6);
    sector.topLeftCorner(4, 4) += a;
    sector.bottomRightCorner(4, 4) += a;
    return reduce_sector(sector, 2, forward);
  };
  const double w = 2 * std::numbers::pi * 1.3;
  const ComplexMatrix z = pair(element.stiffness) - w * w * pair(element.mass);
  const DynamicStiffness one = dynamic_stiffness(reduce(element, 1, elements), 0);
  // A wave that forces every node alike, but for the phase: the left node then moves as in the reduced ring.
  const Complex half = std::polar(1.0, -2 * std::numbers::pi / static_cast<double>(elements));
  ComplexVector force = ComplexVector::Zero(4);
  force(0) = 1;
  force(2) = half;
  const Complex moved = solution_of(z, force)(0);
  const Complex expected = one.contact_response(1.3, 0).compliance;
  CHECK(std::abs(moved - expected) < 1e-9 * std::abs(expected));
}

TEST_CASE("The reduced structure moves as node 1 of the whole ring under the travelling load") {
  const Index n = GENERATE(1, 2, 4);
  const bool beams = GENERATE(false, true);
  const Index elements = 13;
  const ChainElement element = (beams ? beam_element : rod_element)(1, 1, n, elements);
  const Index j = element.mass.rows() / 2;
  const double w = 2 * std::numbers::pi * 0.7;
  const Matrix whole = assemble_ring(rounded(element.stiffness), elements) -
                       w * w * assemble_ring(rounded(element.mass), elements);
  ComplexVector load = ComplexVector::Zero(elements * j);
  for (Index e = 0; e < elements; ++e) {
    const Complex phase = std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(n * e) / 13.0);
    for (Index d = 0; d < 2 * j; ++d) {
      const Complex f(static_cast<double>(element.load(d).real()),
                      static_cast<double>(element.load(d).imag()));
      load((e * j + d) % (elements * j)) += phase * f;
    }
  }
  const ComplexVector moved = solution_of(ComplexMatrix(whole.cast<Complex>()), load);
  const DynamicStiffness reduced = dynamic_stiffness(reduce(element, n, elements), 0);
  const ComplexVector node = reduced.solve(0.7, reduced.load);
  CHECK((moved.head(j) - node).norm() < 1e-10 * node.norm());
  const Complex lag = std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(n) / 13.0);
  CHECK((moved.segment(j, j) - lag * node).norm() < 1e-10 * node.norm());  // (2)
}

TEST_CASE("A matrix that is no sector is refused") {
  CHECK_THROWS_AS(reduce_sector(Matrix::Zero(3, 4), 1, Complex(1)), std::invalid_argument);
  CHECK_THROWS_AS(reduce_sector(Matrix::Zero(3, 3), 2, Complex(1)), std::invalid_argument);
}
