#pragma once

// The zero of a function between two places at which its values have opposite signs.

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>

namespace arcslip {

/// Between a and b, in either order, where f is at_a and at_b: to `bits` of its place, by Alefeld, Potra &
/// Shi's algorithm 748. Values of one sign, of which one has been rounded away from zero, give the place of
/// the smaller one; so nothing is thrown whatever they are.
template <class Function>
double zero_between(const Function& f, double a, double b, double at_a, double at_b, int bits = 50) {
  if (a > b) return zero_between(f, b, a, at_b, at_a, bits);
  const bool opposite = (at_a < 0 && at_b > 0) || (at_a > 0 && at_b < 0);
  if (!opposite || !(a < b)) return std::abs(at_b) < std::abs(at_a) ? b : a;
  std::uintmax_t iterations = 200;
  const auto [low, high] = boost::math::tools::toms748_solve(
      f, a, b, at_a, at_b, boost::math::tools::eps_tolerance<double>(bits), iterations);
  return 0.5 * (low + high);
}

}  // namespace arcslip
