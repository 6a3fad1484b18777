#pragma once

// Rods with one friction contact solved a second time, sharing no code with the library: closed forms in
// extended precision. What the response equation, with cubic springs or negative damping, leaves at a given
// eta is one equation G(ln R) = 0, with any number of roots:
//
//   G = ln R + ln|q (1 + kappa c_B) + k phi c_B| - ln|y_0|,   q = 1 + k phi c_D,   kappa = 3/4 k_3 (R |q|)^2.

#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "arcslip/assembly/system.hpp"
#include "arcslip/continuation/path/branch.hpp"

namespace arcslip::testing {

class RodResponse {
 public:
  using Real = long double;
  using Number = std::complex<Real>;

  explicit RodResponse(const SystemParameters& s) : s_(s) {
    const auto N = static_cast<Real>(s.elements);
    const auto n = static_cast<Real>(s.wave_number);
    const Real square = std::pow(std::sin(pi * n / N), 2);  // sin^2(a/2)
    stiffness_ = 4 * N * square;
    mass_ = (6 - 4 * square) / (6 * N);
    load_ = s.force * s.stiffness_ratio() * N * square / (pi * pi * n * n);
    k_ = s.interface_stiffness / N;
    cubic_ = 0.75L * s.cubic_stiffness * s.stiffness_ratio() / N;  // kappa/Y^2
  }

  Real base_stiffness() const { return stiffness_ * s_.stiffness_ratio(); }
  Real base_mass() const { return mass_ * s_.mass_ratio; }
  Real load() const { return load_; }
  Real contact_stiffness() const { return k_; }
  Real cubic() const { return cubic_; }

  Real base_loss(Real eta) const {
    const bool structural = s_.base_damping_kind == DampingKind::structural;
    return 2 * s_.base_damping * (structural ? 1 : eta / s_.frequency_ratio);
  }
  Real damper_loss(Real eta) const { return 2 * s_.damper_damping * eta; }

  Number c_base(Real eta) const {
    return 1.0L / (base_stiffness() * Number(1, base_loss(eta)) - square(2 * pi * eta) * base_mass());
  }
  Number c_damper(Real eta) const {
    if (s_.fixed_damper) return 0;
    return 1.0L / (stiffness_ * Number(1, damper_loss(eta)) - square(2 * pi * eta) * mass_);
  }

  Real slip_threshold(Real eta) const {
    return (s_.preload + s_.preload_growth * eta * eta) * s_.stiffness_ratio() / s_.interface_stiffness;
  }

  /// k phi at R: the textbook's formula.
  Number friction(Real R, Real S) const {
    if (R <= S) return k_;
    const Real x = S / R;
    const Real theta = std::acos(1 - 2 * x);
    return k_ * Number((theta - std::sin(2 * theta) / 2) / pi, 4 / pi * x * (1 - x));
  }

  Real G(Real eta, Real log_R) const {
    const Real R = std::exp(log_R);
    const Number force = friction(R, slip_threshold(eta));
    const Number c = c_base(eta);
    const Number q = 1.0L + force * c_damper(eta);
    const Real kappa = cubic_ * R * R * std::norm(q);
    return log_R + std::log(std::abs(q * (1.0L + kappa * c) + force * c)) - std::log(std::abs(load_ * c));
  }

  /// The roots of G between two values of ln R, by scanning: two closer than the step may be missed.
  std::vector<Real> roots(Real eta, Real from, Real to, Real step) const {
    std::vector<Real> found;
    Real before = G(eta, from);
    for (Real x = from + step; x < to; x += step) {
      const Real value = G(eta, x);
      if ((before < 0) != (value < 0)) found.push_back(x - step / 2);
      before = value;
    }
    return found;
  }

  /// Whether two roots of G next to ln R meet and vanish as eta passes a value, within a relative distance of
  /// it: the extremum of G changes its sign.
  bool folds_at(Real eta, Real log_R, Real distance) const {
    constexpr Real reach = 1e-3L;
    const Real sign = G(eta, log_R + reach) > 0 ? 1 : -1;
    if (sign * G(eta, log_R - reach) <= 0) return false;
    const auto extremum = [&](Real at) {
      return boost::math::tools::brent_find_minima([&](Real x) { return sign * G(at, x); }, log_R - reach,
                                                   log_R + reach, 40)
          .second;
    };
    return extremum(eta * (1 - distance)) * extremum(eta * (1 + distance)) < 0;
  }

 private:
  static constexpr Real pi = std::numbers::pi_v<Real>;
  static Real square(Real x) { return x * x; }

  SystemParameters s_;
  Real stiffness_;  // of the damper; the base's is K* times it
  Real mass_;
  Real load_;
  Real k_;
  Real cubic_;
};

/// The solutions that a branch in eta has at one value: where it passes, linearly interpolated.
inline std::vector<double> passages(const continuation::Branch& branch, double eta) {
  std::vector<double> found;
  for (std::size_t i = 1; i < branch.points.size(); ++i) {
    const continuation::BranchPoint& a = branch.points[i - 1];
    const continuation::BranchPoint& b = branch.points[i];
    const double from = a.parameters(0) - eta;
    const double to = b.parameters(0) - eta;
    if ((from < 0) == (to < 0)) continue;
    found.push_back(a.unknowns(0) + (b.unknowns(0) - a.unknowns(0)) * from / (from - to));
  }
  return found;
}

}  // namespace arcslip::testing
