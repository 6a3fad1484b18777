#pragma once

// Kirchhoff's annular plate solved in Bessel functions [Leissa, Vibration of plates, NASA SP-160 (1969),
// chapters 1 to 3]: w = (A J_n + B Y_n + C I_n + D K_n)(k r) cos n theta.

#include <Eigen/LU>
#include <boost/math/special_functions/bessel.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include "arcslip/sectors/annular_plate.hpp"

namespace arcslip::testing {

/// One of the four functions f at x, with laplace f = sign f and its first derivative.
struct PlateFunction {
  double sign;
  double value;
  double first;
};

inline std::array<PlateFunction, 4> plate_functions(int n, double x) {
  using namespace boost::math;
  const double j = cyl_bessel_j(n, x), y = cyl_neumann(n, x), i = cyl_bessel_i(n, x), k = cyl_bessel_k(n, x);
  return {{{-1, j, n / x * j - cyl_bessel_j(n + 1, x)},
           {-1, y, n / x * y - cyl_neumann(n + 1, x)},
           {1, i, n / x * i + cyl_bessel_i(n + 1, x)},
           {1, k, n / x * k - cyl_bessel_k(n + 1, x)}}};
}

/// What an edge holds at zero: two of displacement, slope, moment and Kirchhoff's shear force.
inline std::pair<double, double> held(EdgeSupport edge, const PlateFunction& f, int n, double x, double nu) {
  const double n2 = n * n;
  const double moment = f.sign * f.value - (1 - nu) * (f.first / x - n2 * f.value / (x * x));
  const double shear = f.sign * f.first - (1 - nu) * n2 * (f.first - f.value / x) / (x * x);
  if (edge == EdgeSupport::clamped) return {f.value, f.first};
  if (edge == EdgeSupport::supported) return {f.value, moment};
  return {moment, shear};
}

/// k R_e = sqrt(w R_e^2 sqrt(rho h/D)) of a mode with n nodal diameters between `low` and `high`.
inline double exact_wave_number(const AnnularPlate& plate, int n, double low, double high) {
  const double ratio = plate.inner_radius / plate.outer_radius;
  const auto determinant = [&](double x) {
    Eigen::Matrix4d conditions;
    const auto inner = plate_functions(n, x * ratio);
    const auto outer = plate_functions(n, x);
    for (int c = 0; c < 4; ++c) {
      const auto at = static_cast<std::size_t>(c);
      const auto [a, b] = held(plate.inner_edge, inner[at], n, x * ratio, plate.poisson_ratio);
      const auto [p, q] = held(plate.outer_edge, outer[at], n, x, plate.poisson_ratio);
      conditions.col(c) << a, b, p, q;
      conditions.col(c) /= conditions.col(c).cwiseAbs().maxCoeff();
    }
    return conditions.determinant();
  };
  std::uintmax_t iterations = 200;
  const auto [a, b] = boost::math::tools::toms748_solve(
      determinant, low, high, boost::math::tools::eps_tolerance<double>(50), iterations);
  return 0.5 * (a + b);
}

}  // namespace arcslip::testing
