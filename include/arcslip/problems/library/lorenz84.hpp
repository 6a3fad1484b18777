#pragma once

// Lorenz's model of 1984 of the atmosphere, extended by a mode U [Shilnikov, Nicolis & Nicolis 1995;
// Kuznetsov, Meijer, Govaerts & Sautois 2008; test `lorenz84` of BifurcationKit.jl]:
//
//   X' = -Y^2 - Z^2 - a X + a F - g U^2
//   Y' = X Y - b X Z - Y + G
//   Z' = b X Y + X Z - Z
//   U' = -d U + g U X + T
//
// Unknowns: X, Y, Z, U. Parameters: F, T, a, b, G, d, g. Published at a = 1/4, b = 1, G = 0.25, d = 1.04, g =
// 0.987, T = 0.04, down from F = 3 (F): Hopf points 2.859875, 2.467222, 1.619658 and the fold 1.546648; on
// its curve in (F, T) Bogdanov-Takens points (1.446717, +-0.020940), zero-Hopf points (1.283419,
// +-1.2654e-4).

#include "arcslip/problems/library/library.hpp"
#include "arcslip/problems/library/named_unknowns.hpp"

namespace arcslip::problems {

/// The equations above.
class Lorenz84 : public NamedUnknowns {
 public:
  Lorenz84() : NamedUnknowns({"X", "Y", "Z", "U"}, {"F", "T", "a", "b", "G", "d", "g"}) {}

  [[nodiscard]] bool evaluate(const Vector& u, const Vector& p, const continuation::Regime& regime,
                              const continuation::Evaluation& out) const override;
  bool is_equilibrium() const override { return true; }
};

/// `lorenz84`
LibraryModel lorenz84_model();

}  // namespace arcslip::problems
