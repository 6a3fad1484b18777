#include "arcslip/problems/response/sector_motions.hpp"

namespace arcslip::problems {

SectorMotions sector_motions(const HarmonicResponse& problem, const continuation::Guess& at, Index order) {
  const auto a = static_cast<std::size_t>(order);
  std::optional<HarmonicSystem> varied;
  const HarmonicSystem& system = problem.system_at(at.parameters, varied);
  const double frequency = system.multiple(order) * at.parameters(HarmonicResponse::eta);
  const HarmonicResponse::ElementForces forces =
      problem.element_forces(at.unknowns, at.parameters, at.regime);
  const Index n = system.sectors;
  const Index each = problem.contacts() / n;
  const ContactReceptance of_base = system.base[a].at(frequency);
  const ContactVector base = of_base.free + of_base.compliance * forces.base[a];
  const ContactVector damper = system.damper[a].at(frequency).compliance * forces.damper[a];
  SectorMotions all{ComplexMatrix(each, n), base.reshaped(each, n), damper.reshaped(each, n),
                    ComplexMatrix(std::ssize(system.outputs), n)};
  for (Index i = 0; i < problem.contacts(); ++i)
    all.relative(i % each, i / each) = problem.motion(at.unknowns, i)(order);
  for (Index k = 0; k < all.outputs.rows(); ++k) {
    const ContactOutput& output = system.output(k, order);
    const ContactVector& force = output.on_base ? forces.base[a] : forces.damper[a];
    const ContactReceptance seen = output.modes.at(frequency);
    for (Index i = 0; i < n; ++i) {
      const Index row = problem.contacts() + i;
      all.outputs(k, i) = seen.free(row) + (seen.compliance.row(row).head(force.size()) * force).value();
    }
  }
  return all;
}

}  // namespace arcslip::problems
