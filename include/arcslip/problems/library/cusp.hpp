#pragma once

// The cusp catastrophe [demo `cusp` of AUTO-07p]:
//
//   x' = mu + lambda x - x^3
//
// Unknown: x. Parameters: mu, lambda. Folds at 27 mu^2 = 4 lambda^3, |x| = sqrt(lambda/3): at lambda = 1, mu
// = -2/(3 sqrt 3) = -0.384900179460 at x = 1/sqrt 3 and the mirror image; the cusp itself at (0, 0).

#include "arcslip/problems/library/library.hpp"
#include "arcslip/problems/library/named_unknowns.hpp"

namespace arcslip::problems {

/// The equation above.
class Cusp : public NamedUnknowns {
 public:
  Cusp() : NamedUnknowns({"x"}, {"mu", "lambda"}) {}

  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;
  bool is_equilibrium() const override { return true; }
};

/// `cusp`
LibraryModel cusp_model();

}  // namespace arcslip::problems
