#pragma once

// The closed forms (27)-(32) of the paper, as printed, for N/n -> infinity: a route to the rods' response
// that shares nothing with the program but the parameters.

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <utility>

#include "arcslip/assembly/system.hpp"

namespace arcslip::testing {

/// Phasors of base and damper.
struct Motion {
  Complex y, u;
};

/// (29)-(32) in the paper's own symbols.
class PrintedRods {
 public:
  PrintedRods(const SystemParameters& q, double eta)
      : force_(q.force * q.stiffness_ratio() / q.interface_stiffness) {
    const double pi = std::numbers::pi;
    const auto n = static_cast<double>(q.wave_number);
    D1_ = 4 * pi * pi / q.interface_stiffness * (q.stiffness_ratio() * n * n - q.mass_ratio * eta * eta);
    D2_ = 8 * pi * pi / (q.interface_stiffness * q.frequency_ratio) * q.stiffness_ratio() * q.base_damping *
          eta * n * n;
    D3_ = 4 * pi * pi / q.interface_stiffness * (n * n - eta * eta);
    D4_ = 8 * pi * pi / q.interface_stiffness * q.damper_damping * eta * n * n;
    S_ = q.preload * q.stiffness_ratio() / q.interface_stiffness;
  }

  bool slips() const {
    const Motion motion = stick();
    return std::abs(motion.u - motion.y) > S_;
  }

  Motion motion() const { return slips() ? slip(solve_slip()) : stick(); }

  double Y() const { return std::abs(motion().y); }

 private:
  /// (27), (28) as complex equations: (D_1 + 1 + j D_2) y = F K*/K_FD + u, (D_3 + 1 + j D_4) u = y.
  Motion stick() const {
    const Complex damper(D3_ + 1, D4_);
    const Complex y = force_ * damper / (Complex(D1_ + 1, D2_) * damper - 1.0);
    return {y, y / damper};
  }

  /// The phase of r follows from (31) before its modulus is taken: the force is the one of zero phase.
  Motion slip(double R) const {
    const auto [c, s] = relative(R);
    const Complex y(c, s);
    const Complex drive = Complex(D1_, D2_) * y - Complex(cosine(R), -sine(R));
    const Complex turn = std::conj(drive) / std::abs(drive);
    return {y * turn, (y + R) * turn};
  }

  /// Left minus right side of (31), over the right.
  double residual(double R) const {
    const auto [c, s] = relative(R);
    const double first = D1_ * c - D2_ * s - cosine(R);
    const double second = D1_ * s + D2_ * c + sine(R);
    return (first * first + second * second) / (force_ * force_) - 1;
  }

  double solve_slip() const {
    std::uintmax_t iterations = 200;
    double high = 2 * S_;
    while (residual(high) < 0) high *= 2;
    const auto bracket =
        boost::math::tools::toms748_solve([this](double R) { return residual(R); }, S_, high,
                                          boost::math::tools::eps_tolerance<double>(52), iterations);
    return bracket.first;
  }

  double angle(double R) const { return std::acos(1 - 2 * S_ / R); }
  double cosine(double R) const {  // F_c
    return R * (angle(R) - 0.5 * std::sin(2 * angle(R))) / std::numbers::pi;
  }
  double sine(double R) const { return -4 * S_ * (1 - S_ / R) / std::numbers::pi; }  // F_s

  /// Y_c and Y_s of (32): the base's motion against the relative one.
  std::pair<double, double> relative(double R) const {
    const double square = D3_ * D3_ + D4_ * D4_;
    return {(sine(R) * D4_ - cosine(R) * D3_) / square - R, (cosine(R) * D4_ + sine(R) * D3_) / square};
  }

  double force_, D1_, D2_, D3_, D4_, S_;
};

}  // namespace arcslip::testing
