#pragma once

// The response of dense_response.hpp scanned so densely that nothing can hide: every R = S, every extremum of
// Y. The scan halves its cells until a cubic explains each of them.

#include <algorithm>
#include <cmath>
#include <vector>

#include "dense_response.hpp"

namespace dense {

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
