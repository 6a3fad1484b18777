#include "arcslip/problems/response/power_balance.hpp"

#include <algorithm>
#include <cmath>

namespace arcslip::problems {

double PowerBalance::error() const { return std::abs(input - base - damper - friction) / magnitude; }

double PowerBalance::cancellation() const {
  return magnitude / std::max({std::abs(input), std::abs(base), std::abs(damper), std::abs(friction)});
}

PowerBalance power_balance(const HarmonicResponse& problem, const Vector& u, const Vector& p,
                           const continuation::Regime& regime) {
  std::optional<HarmonicSystem> varied;
  const HarmonicSystem& system = problem.system_at(p, varied);
  const double eta = p(HarmonicResponse::eta);
  const HarmonicResponse::ElementForces forces = problem.element_forces(u, p, regime);
  PowerBalance balance{0, forces.drag, 0, forces.energy, std::abs(forces.energy)};
  for (std::size_t a = 0; a < system.orders.size(); ++a) {
    const int cycles = system.orders[a];
    const double frequency = system.multiple(static_cast<Index>(a)) * eta;
    const CycleWork base = system.base[a].work(frequency, forces.base[a]);
    const CycleWork damper = system.damper[a].work(frequency, forces.damper[a]);
    balance.input += cycles * base.load;
    balance.base += cycles * base.damping;
    balance.damper += cycles * damper.damping;
    balance.magnitude += cycles * (base.magnitude + damper.magnitude);
  }
  return balance;
}

double motion_error(const HarmonicResponse& problem, const Vector& u, const Vector& p,
                    const continuation::Regime& regime) {
  std::optional<HarmonicSystem> varied;
  const HarmonicSystem& system = problem.system_at(p, varied);
  const HarmonicResponse::ElementForces forces = problem.element_forces(u, p, regime);
  double gap = 0;
  double largest = 0;
  for (std::size_t a = 0; a < system.orders.size(); ++a) {
    const double frequency = system.multiple(static_cast<Index>(a)) * p(HarmonicResponse::eta);
    const ContactReceptance at_base = system.base[a].at(frequency);
    ContactVector base = at_base.free + at_base.compliance * forces.base[a];
    ContactVector damper = system.damper[a].at(frequency).compliance * forces.damper[a];
    if (system.orders[a] == 0 && forces.base_moved.size() > 0) {
      base += forces.base_moved;
      damper += forces.damper_moved;
    }
    for (Index i = 0; i < problem.contacts(); ++i) {
      Complex relative = problem.motion(u, i)(static_cast<Index>(a));
      if (system.orders[a] == 0) relative = relative.real();  // without a drift
      gap = std::max(gap, std::abs(damper(i) - base(i) - relative));
      largest = std::max({largest, std::abs(damper(i)), std::abs(base(i)), std::abs(relative)});
    }
  }
  return gap / largest;
}

}  // namespace arcslip::problems
