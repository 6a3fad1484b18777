#include "arcslip/sectors/sector_modes.hpp"
#include "arcslip/structure/sector.hpp"

#include <numbers>

#include "arcslip/assembly/sector_pair.hpp"
#include "arcslip/sectors/sector_reduction.hpp"
#include "catch.hpp"
#include "sector_examples.hpp"

using namespace arcslip;
using arcslip::testing::bladed_disk;
using arcslip::testing::chain;
using arcslip::testing::forward;
using arcslip::testing::sparse;

namespace {

double relative(Complex value, Complex expected) { return std::abs(value - expected) / std::abs(expected); }

double difference(const ContactResponse& a, const ContactResponse& b) {
  return std::max({relative(a.compliance, b.compliance), relative(a.compliance_eta, b.compliance_eta),
                   relative(a.free, b.free), relative(a.free_eta, b.free_eta)});
}

/// A chain with its first node in contact.
FiniteSector one_contact(const ChainElement& element, Index count, Index wave_number, Index elements) {
  FiniteSector sector = chain(element, count, forward(wave_number, elements));
  sector.contacts = {0};
  return checked(std::move(sector));
}

/// The modes of the same matrices in fifty digits. The dofs are those of the left boundary, inside, and of
/// the right.
ModalModel precise_modes(const FiniteSector& sector, const SectorWave& wave, const Loss& loss) {
  const PreciseReal a = propagation_constant(wave.wave_number, wave.sectors);
  const PreciseComplex forward{cos(a), -sin(a)};
  const Index boundary = std::ssize(sector.left);
  const auto reduced = [&](const SparseMatrix& matrix) {
    return reduce_sector(Matrix(matrix).cast<PreciseReal>().eval(), boundary, forward);
  };
  const auto load = sector.load.unaryExpr([](Complex f) { return PreciseComplex(f.real(), f.imag()); });
  return {ReducedStructure{reduced(sector.mass), reduced(sector.stiffness),
                           reduce_load(PreciseComplexVector(load), boundary, forward)},
          0, loss};
}

}  // namespace

TEST_CASE("The modes of rods and beams are those of the given matrices, to rounding on the sharpest peaks") {
  const bool beams = GENERATE(false, true);
  const Index count = GENERATE(1, 6);
  const Loss loss{.viscous = 5e-5};
  const SectorWave wave{1, 30 / count};
  const FiniteSector sector = one_contact((beams ? beam_element : rod_element)(5, 80, 1, 30), count, 1, 30);
  const ModalModel expected = precise_modes(sector, wave, loss);
  const SectorModes found = sector_modes(sector, wave, {0.5, 120, 1e-10, loss});
  REQUIRE(found.frequencies.size() == expected.modes().size());
  const ModalModel model = modal_model(found, 1, loss);
  double worst = 0;
  for (const double eta : {0.5, 3.0, expected.modes()[0].frequency, 4.1, 60.0, 120.0})
    worst = std::max(worst, difference(model.at(eta), expected.at(eta)));
  CAPTURE(worst, found.error, found.error_eta);
  // Rounding of frequencies, 1e-16, over half the loss of the sharpest peak, 1e-4, and of load sums.
  CHECK(worst < 1e-11);
}

TEST_CASE("Lanczos finds modes that give the response to the tolerance asked for, for few factorisations") {
  const bool beams = GENERATE(false, true);
  const double tolerance = GENERATE(1e-5, 1e-9);
  const Loss loss{.structural = 1e-2};
  // A hundred elements a sector, of which the window holds a few modes.
  const FiniteSector sector = one_contact((beams ? beam_element : rod_element)(1, 1, 3, 600), 100, 3, 600);
  const SectorWave wave{3, 6};
  const double high = beams ? 500 : 30;
  const SectorModes all = sector_modes(sector, wave, {1, high, 1e-10, loss, 1000});
  const SectorModes some = sector_modes(sector, wave, {1, high, tolerance, loss, 0});
  CAPTURE(some.frequencies.size(), some.error, some.error_eta, all.error, some.factorisations);
  CHECK(all.frequencies.size() == static_cast<std::size_t>(all.dofs));
  CHECK(some.frequencies.size() < 40);
  CHECK(some.factorisations <= 5 + static_cast<int>(some.frequencies.size()) / 10);
  const ModalModel reference = modal_model(all, 1, loss);
  const ModalModel model = modal_model(some, 1, loss);
  double worst = 0;
  for (int i = 0; i <= 500; ++i) {
    const double eta = 1 + (high - 1) * i / 500;
    const ContactResponse a = model.at(eta);
    const ContactResponse b = reference.at(eta);
    worst = std::max({worst, relative(a.compliance, b.compliance), relative(a.free, b.free)});
  }
  CHECK(worst < tolerance);
  CHECK(some.error < tolerance);
}

TEST_CASE("A static load moves the contact of a reduced sector as it does that of the whole") {
  const FiniteSector sector = one_contact(rod_element(1, 1, 3, 600), 100, 3, 600);
  const SectorWave wave{3, 6};
  const Loss loss{.structural = 1e-2};
  const SectorModes whole = sector_modes(sector, wave, {1, 30, 1e-10, loss, 1000});
  const ModalModel all = modal_model(whole, 1, loss);
  const SectorModes some = sector_modes(sector, wave, {1, 1.5, 1e-2, loss, 0});
  CHECK(some.frequencies.size() <= 12);
  CHECK(difference(modal_model(some, 1, loss).at(0), all.at(0)) < 1e-10);  // condition 1e4 of K(a)
}

TEST_CASE("The modes of the lumped bladed disk have the published frequencies, 0 to 6 nodal diameters") {
  const FiniteSector sector = checked(bladed_disk());
  for (Index diameters = 0; diameters <= 6; ++diameters) {
    const SectorModes found =
        sector_modes(sector, {diameters, 24}, {50, 1500, 1e-10, Loss{.structural = 2e-3}});
    REQUIRE(found.frequencies.size() == 3);
    for (std::size_t k = 0; k < 3; ++k)
      CHECK_THAT(found.frequencies[k], WithinRel(testing::bladed_disk_frequencies[diameters][k], 1e-8));
    // 1e-16 in the frequency at a loss of 2e-3.
    CHECK(found.error < 1e-11);
  }
}

TEST_CASE("Windows far above all resonances leave the modes their digits, up to the range of a double") {
  const Index all_modes = GENERATE(0, 100);
  FiniteSector disk = bladed_disk();
  disk.outputs = {};  // between two dofs the sums over modes cancel there
  disk.load = ComplexVector::Unit(4, 0);
  const FiniteSector sector = checked(disk);
  for (const double high : {1e6, 1e12, 1e75, 1e150}) {
    const SectorModes found =
        sector_modes(sector, {3, 24}, {50, high, 1e-10, Loss{.structural = 2e-3}, all_modes});
    CAPTURE(all_modes, high, found.error, found.error_eta);
    REQUIRE(found.frequencies.size() == 3);
    for (std::size_t k = 0; k < 3; ++k)
      CHECK_THAT(found.frequencies[k], WithinRel(testing::bladed_disk_frequencies[3][k], 1e-8));
    CHECK(found.error < 1e-11);  // as in a narrow window
  }
  CHECK_THROWS_WITH(
      sector_modes(sector, {3, 24}, {50, 1e160, 1e-10, Loss{.structural = 2e-3}, all_modes}),
      "the sector has no response at eta = 1e+160, where w*^2 M is beyond the range of a double");
}

TEST_CASE("A sector that moves as a rigid body has a mode at no frequency") {
  const FiniteSector sector = one_contact(rod_element(1, 1, 1, 30), 5, 0, 30);
  const Index all_modes = GENERATE(0, 100);
  const SectorModes found = sector_modes(sector, {0, 6}, {1, 50, 1e-10, Loss{.structural = 1e-2}, all_modes});
  // In the unit of eta: the square of the frequency rounds to 1e-19 of the largest one, 1e4.
  CHECK(found.frequencies.front() < 1e-6);
  CHECK(found.error < 1e-9);
}

TEST_CASE("Damping that is a sum of mass and stiffness is taken for such, and no other") {
  const FiniteSector sector = checked(bladed_disk());
  const SparseMatrix c = 3.0 * sector.mass + 2e-4 * sector.stiffness;
  const Loss loss = proportional_loss(c, sector.mass, sector.stiffness);
  CHECK_THAT(loss.mass, WithinRel(3 / (2 * std::numbers::pi), 1e-10));
  CHECK_THAT(loss.viscous, WithinRel(2e-4 * 2 * std::numbers::pi, 1e-10));
  SparseMatrix other = c;
  other.coeffRef(1, 1) *= 1.01;
  CHECK_THROWS_WITH(proportional_loss(other, sector.mass, sector.stiffness),
                    "the damping matrix is not a sum alpha M + beta K, which the modes of the sector need");
}

TEST_CASE("A stiffness that is not semidefinite is refused") {
  FiniteSector sector = bladed_disk();
  sector.stiffness.coeffRef(2, 2) = -1e6;
  CHECK_THROWS_WITH(sector_modes(checked(sector), {3, 24}, {50, 1500, 1e-10, Loss{.structural = 2e-3}}),
                    "the stiffness matrix is not positive semidefinite under this wave");
}
