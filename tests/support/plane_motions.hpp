#pragma once

// Motions of contacts in a plane, drawn at random, and differences of what follows from them.

#include <vector>

#include "pressed_motions.hpp"

namespace arcslip::testing {

/// One behind the other.
inline ComplexVector joined(const ComplexVector& x, const ComplexVector& y, const ComplexVector& g) {
  ComplexVector all(x.size() + y.size() + g.size());
  all << x, y, g;
  return all;
}

inline ComplexVector random_motion(RandomSystems& draw, int highest) {
  const ComplexVector x = random_course(draw, highest, 1);
  const ComplexVector y = random_course(draw, highest, 1);
  return joined(x, y, random_course(draw, highest, 0.5));
}

inline PressedSettings moved(const PressedSettings& s, const std::vector<double>& way, double by) {
  return {s.friction + by * way[0], s.tangential_stiffness + by * way[1], s.normal_stiffness + by * way[2],
          s.normal_force + by * way[3]};
}

/// Of the fourth order.
template <class Function>
auto difference(const Function& function, double step) {
  using Value = decltype(function(step));
  return Value((8.0 * (function(step) - function(-step)) - (function(2 * step) - function(-2 * step))) /
               (12 * step));
}

}  // namespace arcslip::testing
