#pragma once

// Newton's method with known solutions taken out [Farrell, Birkisson & Funke 2015].

#include <memory>
#include <vector>

#include "arcslip/continuation/linear/bordered_solver.hpp"
#include "arcslip/continuation/path/newton.hpp"
#include "arcslip/continuation/problem/linearization.hpp"

namespace arcslip::continuation {

/// With work space of its own: with m(u) = prod_i (1 + 1/|u - u_i|^2) the correction of m F = 0 is that of
/// F = 0, stretched.
class DeflatedNewton {
 public:
  DeflatedNewton(const Problem& problem, const NewtonOptions& options);

  /// From a guess, with the `known` solutions in its regime taken out.
  Solution run(const Guess& guess, const std::vector<Guess>& known);

  /// Whether F vanishes there but for its rounding, or for what is left of it elsewhere.
  bool vanishes(const Guess& at, double elsewhere);

 private:
  double level(const Vector& u);
  bool correct(Solution& solution, const Guess& guess, const std::vector<Guess>& known);
  double part_of_correction(const Vector& u, const Guess& guess, double whole);

  const Problem& problem_;
  NewtonOptions options_;
  Linearization at_;
  std::unique_ptr<BorderedSolver> solver_;
  Vector scale_;
  Vector parameter_scale_;
  Vector absolute_;
  Vector correction_;
};

}  // namespace arcslip::continuation
