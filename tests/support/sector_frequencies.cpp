#include "sector_frequencies.hpp"

#include "arcslip/dense.hpp"
#include "arcslip/sectors/sector_reduction.hpp"
#include "sector_examples.hpp"

namespace arcslip::testing {

Vector squared_frequencies(const ComplexMatrix& stiffness, const ComplexMatrix& mass) {
  return pencil(stiffness, mass).value().values;
}

Vector squared_frequencies(const FiniteSector& sector, Index wave_number, Index sectors) {
  SectorReduction reduction(sector);
  reduction.set_forward(forward(wave_number, sectors));
  return squared_frequencies(ComplexMatrix(reduction.stiffness()), ComplexMatrix(reduction.mass()));
}

}  // namespace arcslip::testing
