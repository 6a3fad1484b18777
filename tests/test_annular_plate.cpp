#include "arcslip/annular_plate.hpp"

#include <Eigen/Eigenvalues>

#include "arcslip/matrix_market.hpp"
#include "arcslip/sector_reduction.hpp"
#include "catch.hpp"
#include "sector_examples.hpp"

using namespace arcslip;

namespace {

/// Clamped inside, free outside [code_aster, V2.03.004, case SDLS04].
AnnularPlate disk(Index sectors, Index radial_elements, Index angular_elements) {
  return {0.1,
          0.2,
          1e-3,
          2e11,
          0.3,
          7800,
          EdgeSupport::clamped,
          EdgeSupport::free,
          sectors,
          radial_elements,
          angular_elements};
}

/// Lowest w R_e^2 sqrt(rho h/D) with these nodal diameters.
double frequency(const AnnularPlate& plate, Index diameters) {
  SectorReduction reduction(annular_plate_sector(plate));
  reduction.set_forward(testing::forward(diameters, plate.sectors));
  const Eigen::GeneralizedSelfAdjointEigenSolver<ComplexMatrix> modes(
      ComplexMatrix(reduction.stiffness()), ComplexMatrix(reduction.mass()), Eigen::EigenvaluesOnly);
  const double bending = plate.youngs_modulus * std::pow(plate.thickness, 3) /
                         (12 * (1 - plate.poisson_ratio * plate.poisson_ratio));
  const double area_mass = plate.density * plate.thickness;
  return std::sqrt(modes.eigenvalues()(0) * area_mass / bending) * plate.outer_radius * plate.outer_radius;
}

// Bessel solution, to the last digit.
constexpr double exact[] = {13.024257, 13.289781, 14.703812, 18.561989};

}  // namespace

TEST_CASE("A plate clamped inside and free outside has the frequencies of the Bessel solution") {
  for (Index n = 0; n <= 3; ++n) {
    // (n angle)^4/1440 is the error of a beam under such a wave, angle = 5 degrees; 5e-7: digits given.
    const double angle = std::numbers::pi / 36;
    const double error = std::pow(static_cast<double>(n) * angle, 4) / 1440 + 2e-6;
    CHECK_THAT(frequency(disk(18, 8, 4), n), WithinRel(exact[n], error));
  }
}

TEST_CASE("Frequencies of the plate converge as the fourth power of the element's length, from above") {
  const Index n = GENERATE(0, 1, 2, 3);
  const double coarse = frequency(disk(9, 2, 2), n) - exact[n];
  const double fine = frequency(disk(9, 4, 4), n) - exact[n];
  CHECK(fine > 0);
  CHECK_THAT(std::log2(coarse / fine), WithinAbs(4, 0.5));  // not yet asymptotic
}

TEST_CASE("The same mesh cut into other sectors has the same frequencies, through Matrix Market too") {
  const double expected = frequency(disk(24, 2, 1), 2);
  CHECK_THAT(frequency(disk(6, 2, 4), 2), WithinRel(expected, 1e-10));
  const FiniteSector sector = annular_plate_sector(disk(24, 2, 1));
  const SparseMatrix again =
      read_matrix_market(write_matrix_market(sector.stiffness, MatrixSymmetry::symmetric), "stiffness.mtx");
  CHECK((again - sector.stiffness).norm() == 0);
}

TEST_CASE("A free plate moves as a rigid body: w = 1 and w = r cos theta") {
  AnnularPlate plate = disk(12, 3, 1);
  plate.inner_edge = EdgeSupport::free;
  CHECK(frequency(plate, 2) > 1);
  // A rigid motion costs no energy but for rounding of the stiffness, of which this is the square root.
  const FiniteSector sector = annular_plate_sector(plate);
  SectorReduction reduction(sector);
  ComplexVector lift = ComplexVector::Zero(reduction.size());
  ComplexVector tilt = ComplexVector::Zero(reduction.size());
  for (Index i = 0; i < 4; ++i) {
    const double r = 0.1 + 0.1 * static_cast<double>(i) / 3;
    lift(4 * i) = 1;
    tilt.segment<4>(4 * i) << r, 1.0, Complex(0, -r), Complex(0, -1);  // r e^{-j theta} at theta = 0
  }
  const double size = ComplexMatrix(reduction.stiffness()).diagonal().norm();
  CHECK((reduction.stiffness() * lift).norm() < 1e-10 * size);
  reduction.set_forward(testing::forward(0, 12));
  CHECK(lift.dot(reduction.mass() * lift).real() > 0);
  // r cos theta is no polynomial of theta: (angle)^4/720 of the elements' own error remains.
  reduction.set_forward(testing::forward(1, 12));
  const double energy = tilt.dot(reduction.stiffness() * tilt).real();
  const double scale = tilt.cwiseAbs2().dot(ComplexMatrix(reduction.stiffness()).diagonal().real());
  CHECK(energy < std::pow(std::numbers::pi / 6, 4) / 720 * scale);
}

TEST_CASE("Supports hold the dofs of their edge and no others") {
  AnnularPlate plate = disk(12, 3, 2);
  CHECK(annular_plate_sector(plate).mass.rows() == 3 * 3 * 4);
  plate.inner_edge = EdgeSupport::supported;
  CHECK(annular_plate_sector(plate).mass.rows() == 3 * (3 * 4 + 2));
  plate.outer_edge = EdgeSupport::clamped;
  CHECK(annular_plate_sector(plate).mass.rows() == 3 * (2 * 4 + 2));
  CHECK(annular_plate_sector(plate).contacts.empty());
  plate.inner_radius = 0;
  CHECK_THROWS_AS(annular_plate_sector(plate), std::invalid_argument);
}
