#pragma once

// A stirred tank in which A turns into B [Uppal, Ray & Poore 1974; demo `ab` of AUTO-07p]:
//
//   u1' = -u1 + p1 (1 - u1) e^u2
//   u2' = -u2 + p1 p2 (1 - u1) e^u2 - p3 u2
//
// Unknowns: u1 (conversion), u2 (temperature). Parameters: p1, p2, p3. Equilibria from u = 0 at p1 = 0 lie on
// u2 = B u1, p1 = u1/(1 - u1) e^(-B u1), B = p2/(1 + p3), and fold where u1 (1 - u1) = 1/B. Published, at p3
// = 3 (p1): Hopf points 0.165042 (p2 = 14), 0.146882 (15), 0.132538 (16), 0.120866 and 0.217081 (17); folds
// at p2 = 17: 0.121901, 0.117015.

#include "arcslip/problems/library/library.hpp"
#include "arcslip/problems/library/named_unknowns.hpp"

namespace arcslip::problems {

/// The equations above.
class StirredTank : public NamedUnknowns {
 public:
  StirredTank() : NamedUnknowns({"u1", "u2"}, {"p1", "p2", "p3"}) {}

  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;
  bool is_equilibrium() const override { return true; }
};

/// `ab`
LibraryModel ab_model();

}  // namespace arcslip::problems
