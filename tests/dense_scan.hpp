#pragma once

// The response equation R |1 + k phi(R/S) c| = |y_0| solved a second time, sharing no code with the library,
// and scanned so densely that nothing can hide: every R = S, every extremum of Y.
//
// Elements, reduction and compliances are closed forms worked out by hand, in extended precision; R comes
// from bracketing, since the left side rises with R. The scan halves its cells until a cubic explains each of
// them.

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
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

/// One ring under the travelling wave. With lambda = w*^2/(1 + j beta eta), the dynamic stiffness is
/// (1 + j beta eta) (K - lambda M), of which Cramer's rule leaves ratios of real polynomials in lambda. All
/// their coefficients are free of cancellation, for the longest waves too.
struct Ring {
  Polynomial determinant;  ///< of K - lambda M
  Polynomial by_contact;   ///< c = by_contact/determinant/(1 + j beta eta)
  Polynomial by_load;      ///< y_0 likewise
  Real beta;               ///< C = beta K/(2 pi)
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
    real = (theta - std::sin(2 * theta) / 2) / pi;
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

class Response {
 public:
  explicit Response(const Case& c)
      : k_(c.interface_stiffness / c.N), slip_per_preload_(c.stiffness_ratio() / c.interface_stiffness) {
    const auto ring = c.beams ? beam_ring : rod_ring;
    base_ = ring(c, c.mass_ratio, c.stiffness_ratio(), 2 * c.base_damping / c.frequency_ratio);
    damper_ = ring(c, 1, 1, 2 * c.damper_damping);
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
    bool along_preload;
    Real log_threshold;  ///< ln S
    Real log_free;       ///< ln|y_0|
    Real log_free_slope;
    Jet c;
    Jet c_damper;
  };

  static Jet ratio(const Ring& ring, const Polynomial& numerator, Real eta) {
    const Jet factor{{1, ring.beta * eta}, {0, ring.beta * eta}};
    const Real square = 4 * pi * pi * eta * eta;
    const Jet lambda = Jet{square, 2 * square} / factor;
    return value_of(numerator, lambda) / (factor * value_of(ring.determinant, lambda));
  }

  Local locate(Real log_eta, Real log_preload, bool along_preload) const {
    const Real eta = std::exp(log_eta);
    const Jet free = ratio(base_, base_.by_load, eta);
    const Jet c_damper = k_ * ratio(damper_, damper_.by_contact, eta);
    Local local{along_preload ? log_preload : log_eta,
                along_preload,
                log_preload + std::log(slip_per_preload_),
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
    const Real threshold_slope = local.along_preload ? 1 : 0;
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
  Ring base_;
  Ring damper_;
};

/// A special point of the scan.
struct Event {
  enum class Kind { peak, trough, crossing };
  Kind kind;
  Real at;  ///< the parameter itself
  Real log_Y;
  Real log_R;
  Real depth;  ///< of an extremum: least difference of ln Y to the extremum or end next to it
};

/// All special points in a range of eta, at fixed P, or of P, at fixed eta.
class Scan {
 public:
  Scan(const Case& c, bool along_preload, Real fixed, Real from, Real to)
      : response_(c), along_preload_(along_preload), log_fixed_(std::log(fixed)) {
    const std::vector<Real> grid = make_grid(std::log(from), std::log(to));
    Sample last = at(grid.front());
    first_log_Y_ = last.log_Y;
    for (std::size_t i = 1; i < grid.size(); ++i) {
      const Sample next = at(grid[i]);
      connect(last, next);
      last = next;
    }
    last_log_Y_ = last.log_Y;
    measure_depths();
  }

  const std::vector<Event>& events() const { return events_; }
  long samples() const { return samples_; }

  Sample at(Real log_value) {
    ++samples_;
    return along_preload_ ? response_.solve(log_fixed_, log_value, true)
                          : response_.solve(log_value, log_fixed_, false);
  }

 private:
  /// Evenly spaced in the logarithm, and towards each landmark in halves down to 1e-9.
  std::vector<Real> make_grid(Real from, Real to) const {
    std::vector<Real> grid;
    constexpr int count = 400;
    grid.reserve(2000);
    for (int i = 0; i < count; ++i) grid.push_back(from + (to - from) * i / count);
    grid.push_back(to);
    if (!along_preload_) {
      for (const Real eta : response_.landmarks()) {
        const Real center = std::log(eta);
        grid.push_back(center);
        for (Real distance = 0.3L; distance > 1e-9L; distance /= 2) {
          grid.push_back(center - distance);
          grid.push_back(center + distance);
        }
      }
    }
    std::erase_if(grid, [&](Real x) { return !(x >= from && x <= to); });
    std::sort(grid.begin(), grid.end());
    grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
    return grid;
  }

  /// Zero between a and b of a function that has signs f_a and -f_a there: regula falsi, which halves the
  /// weight of an end that stays (Illinois), and bisection in turns.
  template <class Function>
  static Real zero(Real a, Real b, Real f_a, Real f_b, Function f) {
    const bool rises = f_a < 0;
    for (int i = 0; i < 200 && b - a > 1e-19L * std::max(std::abs(a), 1e-3L); ++i) {
      Real x = i % 3 == 2 ? (a + b) / 2 : (a * f_b - b * f_a) / (f_b - f_a);
      if (!(x > a && x < b)) x = (a + b) / 2;
      if (!(x > a && x < b)) break;
      const Real value = f(x);
      if (value == 0) return x;
      const bool left = (value < 0) == rises;
      (left ? f_b : f_a) /= 2;
      (left ? a : b) = x;
      (left ? f_a : f_b) = value;
    }
    return (a + b) / 2;
  }

  void connect(const Sample& a, const Sample& b) {
    if (a.slip == b.slip) return halve(a, b);
    const Real x = zero(a.at, b.at, a.log_ratio, b.log_ratio, [&](Real at_x) { return at(at_x).log_ratio; });
    const Sample before = at_switch(x, a.slip);
    const Sample after = at_switch(x, b.slip);
    halve(a, before);
    events_.push_back({Event::Kind::crossing, std::exp(x), before.log_Y, before.log_R, 0});
    if (before.log_Y_slope * after.log_Y_slope < 0) add_extremum(before, before.log_Y_slope > 0);
    halve(after, b);
  }

  Sample at_switch(Real x, bool slip) const {
    return along_preload_ ? response_.at_switch(log_fixed_, x, true, slip)
                          : response_.at_switch(x, log_fixed_, false, slip);
  }

  void add_extremum(const Sample& s, bool peak) {
    events_.push_back({peak ? Event::Kind::peak : Event::Kind::trough, std::exp(s.at), s.log_Y, s.log_R, 0});
  }

  /// A cell within one regime.
  void halve(const Sample& a, const Sample& b) {
    const Real middle = (a.at + b.at) / 2;
    if (!(b.at - a.at > 1e-16L * std::max(std::abs(middle), 1e-3L))) return;
    const Sample m = at(middle);
    if (m.slip != a.slip && std::abs(m.log_ratio) > 1e-17L) {
      connect(a, m);
      connect(m, b);
    } else if (explained(a, m, b)) {
      finish(a, m);
      finish(m, b);
    } else {
      halve(a, m);
      halve(m, b);
    }
  }

  /// How far the middle of a cell is from the cubic through its ends.
  static Real error(Real h, Real f_a, Real f_m, Real f_b, Real d_a, Real d_m, Real d_b) {
    const Real value = (f_a + f_b) / 2 + h / 8 * (d_a - d_b);
    const Real slope = 1.5L * (f_b - f_a) / h - (d_a + d_b) / 4;
    return std::max(std::abs(f_m - value), h / 4 * std::abs(d_m - slope));
  }

  static bool explained(const Sample& a, const Sample& m, const Sample& b) {
    const Real h = b.at - a.at;
    const Real ratio_error = error(h, a.log_ratio, m.log_ratio, b.log_ratio, a.log_ratio_slope,
                                   m.log_ratio_slope, b.log_ratio_slope);
    // Within a regime R/S may come back to 1 unseen only if its curve is far from the cubic.
    const Real nearest = std::max({std::abs(a.log_ratio), std::abs(m.log_ratio), std::abs(b.log_ratio)});
    if (ratio_error > 1e-4L || ratio_error > 0.02L * nearest) return false;

    const Real y_error = error(h, a.log_Y, m.log_Y, b.log_Y, a.log_Y_slope, m.log_Y_slope, b.log_Y_slope);
    if (y_error > 1e-5L) return false;
    if (y_error < 1e-15L) return true;
    if (a.log_Y_slope * m.log_Y_slope < 0 || m.log_Y_slope * b.log_Y_slope < 0) {
      return y_error < 0.01L * std::max(std::abs(m.log_Y - a.log_Y), std::abs(m.log_Y - b.log_Y));
    }
    return least_slope(a.log_Y_slope, m.log_Y_slope, b.log_Y_slope) > 16 * y_error / h;
  }

  /// How close a parabola through three values of one sign comes to zero: negative if it gets beyond.
  static Real least_slope(Real a, Real m, Real b) {
    const Real bend = 2 * (a - 2 * m + b);
    const Real tilt = b - a;
    const Real ends = std::min({std::abs(a), std::abs(m), std::abs(b)});
    if (std::abs(tilt) >= std::abs(bend)) return ends;
    const Real vertex = m - tilt * tilt / (4 * bend);
    return std::min(ends, m > 0 ? vertex : -vertex);
  }

  /// A cell that holds at most one extremum of R/S and of Y.
  void finish(const Sample& a, const Sample& b) {
    const Real inward = a.slip ? -1 : 1;  // times ln(R/S): negative, and zero at the switch
    if (inward * a.log_ratio_slope > 0 && inward * b.log_ratio_slope < 0) {
      const Sample nearest = at(zero(a.at, b.at, a.log_ratio_slope, b.log_ratio_slope,
                                     [&](Real x) { return at(x).log_ratio_slope; }));
      if (nearest.slip != a.slip) {
        connect(a, nearest);
        connect(nearest, b);
        return;
      }
    }
    if (a.log_Y_slope * b.log_Y_slope >= 0) return;
    const Real x =
        zero(a.at, b.at, a.log_Y_slope, b.log_Y_slope, [&](Real at_x) { return at(at_x).log_Y_slope; });
    add_extremum(at(x), a.log_Y_slope > 0);
  }

  void measure_depths() {
    Event* last = nullptr;
    Real last_log_Y = first_log_Y_;
    for (Event& event : events_) {
      if (event.kind == Event::Kind::crossing) continue;
      event.depth = std::abs(event.log_Y - last_log_Y);
      if (last != nullptr) last->depth = std::min(last->depth, event.depth);
      last = &event;
      last_log_Y = event.log_Y;
    }
    if (last != nullptr) last->depth = std::min(last->depth, std::abs(last->log_Y - last_log_Y_));
  }

  Response response_;
  bool along_preload_;
  Real log_fixed_;
  Real first_log_Y_ = 0;
  Real last_log_Y_ = 0;
  long samples_ = 0;
  std::vector<Event> events_;
};

}  // namespace dense
