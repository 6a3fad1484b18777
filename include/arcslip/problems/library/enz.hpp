#pragma once

// Two compartments that exchange a substrate, which an enzyme consumes [Kernevez 1980; demo `enz` of
// AUTO-07p]:
//
//   s1' = (s0 - s1) + (s2 - s1) - rho R(s1)
//   s2' = (s0 + mu - s2) + (s1 - s2) - rho R(s2),    R(s) = s/(1 + s + k s^2)
//
// Unknowns: s1, s2. Parameters: s0, mu, rho, k. Published at rho = 100, k = 1, mu = 0 (s0): on the symmetric
// branch folds 34.3569, 18.8871 and branch points 34.2229, 22.1816; folds of the asymmetric one 25.3727,
// 26.6221.

#include "arcslip/problems/library/library.hpp"
#include "arcslip/problems/library/named_unknowns.hpp"

namespace arcslip::problems {

/// The equations above.
class EnzymeCompartments : public NamedUnknowns {
 public:
  EnzymeCompartments() : NamedUnknowns({"s1", "s2"}, {"s0", "mu", "rho", "k"}) {}

  /// No value where 1 + s + k s^2 is not positive.
  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;
  bool is_equilibrium() const override { return true; }
};

/// `enz`
LibraryModel enz_model();

}  // namespace arcslip::problems
