#pragma once

// The function of Freudenstein & Roth [J. ACM 10 (1963) 550], as problem 1 of PITCON [Rheinboldt & Burkardt,
// ACM TOMS 9 (1983) 236]:
//
//   x1 - x2^3 + 5 x2^2 -  2 x2 - 13 + 34 (x3 - 1) = 0
//   x1 + x2^3 +   x2^2 - 14 x2 - 29 + 10 (x3 - 1) = 0
//
// Unknowns: x1, x2. Parameter: x3. From (15, -2) at x3 = 0 to (5, 4) at x3 = 1; with t = x2 all of it is x1 =
// (-11 t^3 + 4 t^2 + 114 t + 214)/6, x3 = (t^3 - 2 t^2 - 6 t + 4)/12. Published: folds in x3 0.5875874,
// -0.6863528; in x1 14.28309 and 61.66936.

#include "arcslip/problems/library/library.hpp"
#include "arcslip/problems/library/named_unknowns.hpp"

namespace arcslip::problems {

/// The equations above.
class FreudensteinRoth : public NamedUnknowns {
 public:
  FreudensteinRoth() : NamedUnknowns({"x1", "x2"}, {"x3"}) {}

  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;
};

/// `freudenstein_roth`
LibraryModel freudenstein_roth_model();

}  // namespace arcslip::problems
