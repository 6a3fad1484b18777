#include "arcslip/structure/sector.hpp"

namespace arcslip {

ReducedStructure reduce(const ChainElement& element, Index wave_number, Index elements) {
  const PreciseReal a = propagation_constant(wave_number, elements);
  const PreciseComplex forward{cos(a), -sin(a)};
  const Index boundary = element.mass.rows() / 2;
  return {reduce_sector(element.mass, boundary, forward), reduce_sector(element.stiffness, boundary, forward),
          reduce_load(element.load, boundary, forward)};
}

}  // namespace arcslip
