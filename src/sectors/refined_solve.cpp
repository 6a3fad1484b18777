#include "sectors/refined_solve.hpp"

namespace arcslip {

ExtendedSector::NumberVector refined_solve(const ExtendedSector& sector, ComplexFactors& factors,
                                           ExtendedSector::Number k, ExtendedSector::Number m,
                                           const ExtendedSector::NumberVector& force,
                                           ExtendedSector::Real accuracy) {
  constexpr int most = 10;
  ExtendedSector::NumberVector motion = ExtendedSector::NumberVector::Zero(force.size());
  ExtendedSector::NumberVector residual = force;
  for (int i = 0; i < most; ++i) {
    ComplexMatrix step = residual.cast<Complex>();
    factors.solve(step);
    motion += step.col(0).cast<ExtendedSector::Number>();
    if (static_cast<ExtendedSector::Real>(step.norm()) <= accuracy * motion.norm()) break;
    const ExtendedSector::NumberVector unfolded = sector.unfold(motion);
    residual = force - k * sector.stiffness_times(unfolded) - m * sector.mass_times(unfolded);
  }
  return motion;
}

}  // namespace arcslip
