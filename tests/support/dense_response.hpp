#pragma once

// The response equation R |1 + k phi(R/S) c| = |y_0| solved a second time, sharing no code with the library.
//
// Elements, reduction and compliances are closed forms worked out by hand, in extended precision; R comes
// from bracketing, since the left side rises with R.

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace dense {

using Real = long double;
static_assert(std::numeric_limits<Real>::digits >= 64,
              "the scan needs more digits than the tracer that it checks");
using Complex = std::complex<Real>;
using Polynomial = std::vector<Real>;  // ascending powers

inline constexpr Real pi = std::numbers::pi_v<Real>;

struct Case {
  bool beams;
  int n;  ///< wave number
  int N;  ///< elements
  Real mass_ratio;
  Real frequency_ratio;
  Real interface_stiffness;
  Real base_damping;
  Real damper_damping;
  Real force;
  bool structural_base = false;  ///< K_B (1 + 2 j zeta_B) in place of viscous damping
  bool fixed_damper = false;
  Real preload_growth = 0;  ///< P_2 of P + P_2 eta^2

  Real stiffness_ratio() const { return frequency_ratio * frequency_ratio * mass_ratio; }
};

/// A value and its derivative.
struct Jet {
  Complex value;
  Complex slope;
};

inline Jet operator+(const Jet& a, const Jet& b) { return {a.value + b.value, a.slope + b.slope}; }
inline Jet operator-(const Jet& a, const Jet& b) { return {a.value - b.value, a.slope - b.slope}; }
inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.value * b.slope + a.slope * b.value};
}
inline Jet operator*(Real a, const Jet& b) { return {a * b.value, a * b.slope}; }
inline Jet operator/(const Jet& a, const Jet& b) {
  const Complex ratio = a.value / b.value;
  return {ratio, (a.slope - ratio * b.slope) / b.value};
}

inline Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial c(a.size() + b.size() - 1, 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
  }
  return c;
}

inline Polynomial sum(Polynomial a, const Polynomial& b) {
  a.resize(std::max(a.size(), b.size()), 0);
  for (std::size_t i = 0; i < b.size(); ++i) a[i] += b[i];
  return a;
}

inline Polynomial scaled(Real factor, Polynomial a) {
  for (Real& x : a) x *= factor;
  return a;
}

inline Real value_of(const Polynomial& p, Real x) {
  Real value = 0;
  for (std::size_t i = p.size(); i-- > 0;) value = value * x + p[i];
  return value;
}

/// Positive roots, each between two roots of the derivative.
inline std::vector<Real> positive_roots(const Polynomial& p) {
  if (p.size() < 2 || p.back() == 0) return {};
  Polynomial derivative;
  for (std::size_t i = 1; i < p.size(); ++i) derivative.push_back(static_cast<Real>(i) * p[i]);
  Real bound = 0;
  for (const Real x : p) bound = std::max(bound, std::abs(x / p.back()));
  std::vector<Real> borders = positive_roots(derivative);
  borders.insert(borders.begin(), 0);
  borders.push_back(1 + bound);
  std::vector<Real> roots;
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
    Real low = borders[i];
    Real high = borders[i + 1];
    const bool rises = value_of(p, low) < 0;
    if (rises == (value_of(p, high) < 0)) continue;
    for (int k = 0; k < 400 && high - low > 1e-18L * high; ++k) {
      // geometrically where the bracket spans decades
      const Real middle = high > 4 * low && low > 0 ? std::sqrt(low * high) : (low + high) / 2;
      ((value_of(p, middle) < 0) == rises ? low : high) = middle;
    }
    roots.push_back(high);
  }
  return roots;
}

/// One ring under the travelling wave. With d = 1 + j beta eta, or 1 + j loss, and lambda = w*^2/d, the
/// dynamic stiffness is d (K - lambda M), of which Cramer's rule leaves ratios of real polynomials in lambda.
/// All their coefficients are free of cancellation, for the longest waves too.
struct Ring {
  Polynomial determinant;  ///< of K - lambda M
  Polynomial by_contact;   ///< c = by_contact/determinant/d
  Polynomial by_load;      ///< y_0 likewise
  Real beta;               ///< C = beta K/(2 pi)
  Real loss = 0;           ///< structural
};

inline Ring rod_ring(const Case& c, Real mass, Real stiffness, Real beta) {
  const Real half = std::sin(pi * c.n / c.N);  // sin(a/2)
  const Real k = 4 * stiffness * c.N * half * half;
  const Real m = mass / (6 * c.N) * (6 - 4 * half * half);
  const Real load = c.force * stiffness * c.N * half * half / (pi * pi * c.n * c.n);
  return {{k, -m}, {1}, {load}, beta};
}

/// sum_m of (-1)^m a^(2m+odd)/(2m+odd)! int_0^1 s^(2m+odd) shape(s) ds: the integral of cos(as) or sin(as)
/// times a shape function given by its coefficients.
inline Real wave_integral(Real a, int odd, const std::array<int, 4>& shape) {
  Real sum = 0;
  Real power = odd != 0 ? a : 1;
  for (int m = odd; m < 60; m += 2) {
    for (int i = 0; i < 4; ++i)
      sum += power * shape[static_cast<std::size_t>(i)] / static_cast<Real>(m + i + 1);
    power *= -a * a / static_cast<Real>((m + 1) * (m + 2));
  }
  return sum;
}

/// Contact dof w, second dof w' times the element's length. The off-diagonal entries of the reduced matrices
/// are j k12 and j m12, and the loads f1 and -j f2, with all of them real.
inline Ring beam_ring(const Case& c, Real mass, Real stiffness, Real beta) {
  const Real a = 2 * pi * c.n / c.N;
  const Real half = std::sin(a / 2) * std::sin(a / 2);
  const Real k = stiffness * c.N * c.N * c.N;
  const Real m = pi * pi * mass / (105 * static_cast<Real>(c.N));
  const Real k11 = 48 * half * k;
  const Real k12 = -12 * std::sin(a) * k;
  const Real k22 = (12 - 8 * half) * k;
  const Real m11 = (420 - 216 * half) * m;
  const Real m12 = 26 * std::sin(a) * m;
  const Real m22 = (2 + 12 * half) * m;
  const Real f1 = 2 * c.force * stiffness / c.N * wave_integral(a, 0, {1, 0, -3, 2});
  const Real f2 = 2 * c.force * stiffness / c.N * wave_integral(a, 1, {0, 1, -2, 1});
  const Real det_k = 192 * half * half * k * k;
  return {{det_k, -(k11 * m22 + k22 * m11 - 2 * k12 * m12), m11 * m22 - m12 * m12},
          {k22, -m22},
          {k22 * f1 - k12 * f2, -(m22 * f1 - m12 * f2)},
          beta};
}

inline Jet value_of(const Polynomial& p, const Jet& x) {
  Jet value{0, 0};
  for (std::size_t i = p.size(); i-- > 0;) {
    value = value * x;
    value.value += p[i];
  }
  return value;
}

/// (4/pi) x (1 - x), and (8/pi) times the integral of sqrt(t (1 - t)) from 0 to x, which is the textbook's
/// (theta - sin(2 theta)/2)/pi. With the slope in t = ln(R/S), x = e^-t.
inline Jet jenkins(Real t) {
  const Real x = std::exp(-t);
  const Real rest = -std::expm1(-t);
  Real real = 0;
  if (x < 0.1L) {
    Real binomial = 1;  // of sqrt(1 - t), times x^m
    for (int m = 0; m < 30; ++m) {
      real += binomial / (m + 1.5L);
      binomial *= x * (m - 0.5L) / (m + 1);
    }
    real *= 8 / pi * x * std::sqrt(x);
  } else {
    const Real theta = 2 * std::atan2(std::sqrt(x), std::sqrt(rest));
    real = (theta - 2 * std::sqrt(x * rest) * (rest - x)) / pi;  // sin(2 theta) of half angles
  }
  return {{real, 4 / pi * x * rest}, {-8 / pi * x * std::sqrt(x * rest), -4 / pi * x * (rest - x)}};
}

/// What the scan sees at one value of the parameter; slopes are in its logarithm.
struct Sample {
  Real at;  ///< ln of the parameter
  bool slip;
  Real log_ratio;  ///< ln(R/S)
  Real log_ratio_slope;
  Real log_R;
  Real log_Y;
  Real log_Y_slope;
  Real gain;  ///< d ln(R |1 + k phi c|)/d ln R
};

/// What follows without solving where eta and R/S are given.
struct Given {
  Real preload;  ///< P, which may be negative if it grows with eta^2
  Real log_Y;
  Real log_Y_slope;  ///< in ln eta, at fixed P
  Real log_ratio_slope;
};

class Response {
 public:
  explicit Response(const Case& c)
      : k_(c.interface_stiffness / c.N),
        slip_per_preload_(c.stiffness_ratio() / c.interface_stiffness),
        growth_(c.preload_growth),
        fixed_damper_(c.fixed_damper) {
    const auto ring = c.beams ? beam_ring : rod_ring;
    base_ = ring(c, c.mass_ratio, c.stiffness_ratio(),
                 c.structural_base ? 0 : 2 * c.base_damping / c.frequency_ratio);
    if (c.structural_base) base_.loss = 2 * c.base_damping;
    damper_ = ring(c, 1, 1, 2 * c.damper_damping);
  }

  /// At a given R/S >= 1, as seen from slip or, at R = S, from stick.
  Given at_ratio(Real log_eta, Real log_ratio, bool slip) const {
    const Real eta = std::exp(log_eta);
    Local local = locate(log_eta, 0, false);
    const Complex closed = 1.0L + jenkins(log_ratio).value * local.c.value;
    const Real threshold = std::exp(local.log_free - log_ratio) / std::abs(closed);
    const Real preload = threshold / slip_per_preload_ - growth_ * eta * eta;
    local.log_threshold = std::log(threshold);
    local.log_threshold_slope = 2 * growth_ * eta * eta * slip_per_preload_ / threshold;
    const Sample s = sample(local, slip, log_ratio);
    return {preload, s.log_Y, s.log_Y_slope, s.log_ratio_slope};
  }

  /// ln|y_0| of the base alone and its slope in ln eta.
  std::pair<Real, Real> free(Real log_eta) const {
    const Local local = locate(log_eta, 0, false);
    return {local.log_free, local.log_free_slope};
  }

  /// Solves at (eta, P); slopes in ln eta or, if `along_preload`, in ln P.
  Sample solve(Real log_eta, Real log_preload, bool along_preload) const {
    const Local local = locate(log_eta, log_preload, along_preload);
    const Real stuck = local.log_free - local.log_threshold - std::log(std::abs(1.0L + local.c.value));
    if (stuck <= 0) return sample(local, false, stuck);
    return sample(local, true, slipping(local));
  }

  /// The same at a point known to lie on R = S, as seen from one side of it.
  Sample at_switch(Real log_eta, Real log_preload, bool along_preload, bool slip) const {
    return sample(locate(log_eta, log_preload, along_preload), slip, 0);
  }

  /// Values of eta near which the response may change fast: resonances and antiresonances without damping, of
  /// base and damper alone and stuck to each other or to something rigid.
  std::vector<Real> landmarks() const {
    const Polynomial base = sum(base_.determinant, scaled(k_, base_.by_contact));
    const Polynomial damper = sum(damper_.determinant, scaled(k_, damper_.by_contact));
    const Polynomial pair =
        sum(product(base, damper_.determinant), scaled(k_, product(base_.determinant, damper_.by_contact)));
    const Polynomial both =
        sum(product(base_.by_contact, damper_.determinant), product(base_.determinant, damper_.by_contact));
    std::vector<Real> found;
    for (const Polynomial& p : {base_.determinant, damper_.determinant, base, damper, pair, both,
                                base_.by_load, base_.by_contact, damper_.by_contact}) {
      for (const Real lambda : positive_roots(p)) found.push_back(std::sqrt(lambda) / (2 * pi));
    }
    return found;
  }

 private:
  /// The equation at one point: ln R + ln|1 + phi c| = log_free, with k within c and c_D.
  struct Local {
    Real at;
    Real log_threshold;  ///< ln S
    Real log_threshold_slope;
    Real log_free;  ///< ln|y_0|
    Real log_free_slope;
    Jet c;
    Jet c_damper;
  };

  static Jet ratio(const Ring& ring, const Polynomial& numerator, Real eta) {
    const Jet factor{{1, ring.beta * eta + ring.loss}, {0, ring.beta * eta}};
    const Real square = 4 * pi * pi * eta * eta;
    const Jet lambda = Jet{square, 2 * square} / factor;
    return value_of(numerator, lambda) / (factor * value_of(ring.determinant, lambda));
  }

  Local locate(Real log_eta, Real log_preload, bool along_preload) const {
    const Real eta = std::exp(log_eta);
    const Jet free = ratio(base_, base_.by_load, eta);
    Jet c_damper = k_ * ratio(damper_, damper_.by_contact, eta);
    if (fixed_damper_) c_damper = {0, 0};
    const Real preload = std::exp(log_preload);
    const Real grown = growth_ * eta * eta;
    Local local{along_preload ? log_preload : log_eta,
                std::log((preload + grown) * slip_per_preload_),
                (along_preload ? preload : 2 * grown) / (preload + grown),
                std::log(std::abs(free.value)),
                std::real(free.slope / free.value),
                k_ * ratio(base_, base_.by_contact, eta) + c_damper,
                c_damper};
    if (along_preload) local.log_free_slope = 0;
    if (along_preload) local.c.slope = local.c_damper.slope = 0;
    return local;
  }

  /// ln(R/S) > 0: Newton's method, halving its bracket where that does not do better.
  static Real slipping(const Local& local) {
    const Real load = local.log_free - local.log_threshold;
    const auto excess = [&](Real t, Real& slope) {
      const Jet phi = jenkins(t);
      const Complex closed = 1.0L + phi.value * local.c.value;
      slope = 1 + std::real(phi.slope * local.c.value / closed);
      return t + std::log(std::abs(closed)) - load;
    };
    Real slope = 0;
    Real low = 0;
    Real high = 1;
    while (excess(high, slope) < 0) high *= 2;
    Real t = high / 2;
    for (int i = 0; i < 300; ++i) {
      const Real value = excess(t, slope);
      if (value == 0) break;
      (value < 0 ? low : high) = t;
      const Real before = t;
      t -= value / slope;
      if (!(t > low && t < high)) t = (low + high) / 2;
      if (std::abs(t - before) <= 1e-18L * t || !(t > low && t < high)) break;
    }
    return t;
  }

  static Sample sample(const Local& local, bool slip, Real t) {
    const Jet phi = slip ? jenkins(t) : Jet{1, 0};
    const Complex closed = 1.0L + phi.value * local.c.value;
    const Complex closed_damper = 1.0L + phi.value * local.c_damper.value;
    const Real threshold_slope = local.log_threshold_slope;
    const Real gain = 1 + std::real(phi.slope * local.c.value / closed);
    const Real t_slope =
        (local.log_free_slope - threshold_slope - std::real(phi.value * local.c.slope / closed)) / gain;
    const Complex damper_slope =
        phi.value * local.c_damper.slope + t_slope * phi.slope * local.c_damper.value;
    Sample result{};
    result.at = local.at;
    result.slip = slip;
    result.gain = gain;
    result.log_ratio = t;
    result.log_ratio_slope = t_slope;
    result.log_R = t + local.log_threshold;
    result.log_Y = result.log_R + std::log(std::abs(closed_damper));
    result.log_Y_slope = t_slope + threshold_slope + std::real(damper_slope / closed_damper);
    return result;
  }

  Real k_;
  Real slip_per_preload_;
  Real growth_;
  bool fixed_damper_;
  Ring base_;
  Ring damper_;
};

}  // namespace dense
