// The response that modes are compared with is that of the matrices, whatever the modes are worth.

#include "arcslip/sectors/sector_solver.hpp"
#include "catch.hpp"
#include "rim_plate.hpp"
#include "sectors/full_response.hpp"
#include "sectors/turning_modes.hpp"

using namespace arcslip;

namespace {

constexpr Loss plate_loss{.structural = 2e-3};
constexpr SectorWave three_waves{3, 24};

FiniteSector plate() {
  FiniteSector sector = testing::rim_plate(three_waves.sectors, 12, 4);
  sector.outputs = {sector.contacts.front() + 5};
  return checked(sector);
}

ComplexMatrix solved(const FiniteSector& sector, double eta) {
  SectorSolver solver(sector, three_waves.forward(), plate_loss);
  const SectorResponse& found = solver.at(eta);
  ComplexMatrix all(2, 2);
  all << found.compliance, found.free, found.output_compliance, found.output_free;
  return all;
}

}  // namespace

TEST_CASE("The full response is that of a factorisation at every eta, from however few modes") {
  const FiniteSector sector = plate();
  SectorReduction reduction(sector);
  reduction.set_forward(three_waves.forward());
  const ModesRequest request{1800, 2400, 1e-10, plate_loss};
  RitzSpace space(sector, three_waves, false);
  KrylovSpace krylov(space.sector(), reduction, request);
  const int blocks = GENERATE(1, 2, 4, 10);
  for (int i = 0; i < blocks; ++i) space.add(krylov.next());
  const SectorModes modes = space.modes(request);
  const FullResponse full(space, &krylov, reduction, modes, plate_loss);
  for (const double eta : {1800.0, modes.frequencies.front(), 2400.0, 9000.0}) {
    const ComplexMatrix expected = solved(sector, eta);
    CAPTURE(blocks, eta, modes.frequencies.size());
    const double left =
        (modes.shapes *
             (modal_denominators(modes, plate_loss, eta).cwiseInverse().asDiagonal() *
              ComplexMatrix((ComplexMatrix(modes.frequencies.size(), 2) << modes.shapes.topRows(1).adjoint(),
                             modes.loads)
                                .finished())) -
         expected)
            .norm();
    // To a hundredth of what the modes leave, and to the rounding of solves in double.
    CHECK((full.at(eta) - expected).norm() <= 0.02 * left + 1e-7 * expected.norm());
  }
}
