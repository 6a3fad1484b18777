#pragma once

// A predator and its prey, which is fished [demo `pp2` of AUTO-07p]:
//
//   u' = 3 u (1 - u) - u v - p (1 - e^(-5 u))
//   v' = -v + 3 u v
//
// Unknowns: u (prey), v (predator). Parameter: p (fishing). From u = v = 0 at p = 0. Published (p): branch
// points 3/5 and (2/3)/(1 - e^(-5/3)) = 0.821904 at u = 1/3, v = 0; fold 0.832929; Hopf point 0.671594 at u =
// 1/3 on the branch of v > 0, period 10.38917.

#include "arcslip/problems/library/library.hpp"
#include "arcslip/problems/library/named_unknowns.hpp"

namespace arcslip::problems {

/// The equations above.
class PredatorPrey : public NamedUnknowns {
 public:
  PredatorPrey() : NamedUnknowns({"u", "v"}, {"p"}) {}

  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;
  bool is_equilibrium() const override { return true; }
};

/// `pp2`
LibraryModel pp2_model();

}  // namespace arcslip::problems
