#pragma once

// What the problems of base, damper and contacts in several harmonics share: the coordinates in which
// elements act, and the regimes, which contacts slip, bit i for contact i.

#include "arcslip/assembly/coordinates.hpp"
#include "arcslip/assembly/harmonic_system.hpp"
#include "arcslip/continuation/problem/problem.hpp"
#include "arcslip/problems/response/slip_regimes.hpp"

namespace arcslip::problems {

class HarmonicProblem : public continuation::Problem {
 public:
  Index size() const override { return 2 * coordinates_.size() * harmonics(); }

  std::vector<std::string> regime_names() const override { return slip_regimes(contacts()); }
  int border_count(int /*regime*/) const override { return static_cast<int>(contacts()); }
  int regime_beyond(int regime, int border) const override { return regime ^ (1 << border); }

  Index contacts() const { return coordinates_.contacts(); }
  Index coordinates() const { return coordinates_.size(); }
  Index harmonics() const { return std::ssize(system_.orders); }
  const HarmonicSystem& system() const { return system_; }

 protected:
  /// Throws std::invalid_argument where base, damper and contacts differ in number.
  explicit HarmonicProblem(HarmonicSystem system);

  /// P + P_2 eta^2.
  double load(double eta, double preload) const { return preload + system_.preload_growth * eta * eta; }

  /// The names of a quantity of the contacts but the first, and of the first in the harmonics above it.
  void add_further_contacts(std::vector<continuation::Observable>& all) const;
  void add_higher_harmonics(std::vector<continuation::Observable>& all) const;

  HarmonicSystem system_;
  Coordinates coordinates_;
};

}  // namespace arcslip::problems
