#pragma once

// Where local peaks appear and vanish as the preload grows. Between two preloads at which that can happen, of
// which there is a complete list, their number is constant, and counted by the scan at one preload.

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "dense_ridges.hpp"

namespace dense {

/// The number of local peaks changes here.
struct Change {
  Real preload;
  Real eta;
  int by;
};

/// All zeros of f over the cells of `grid`, which are halved until f is nearly linear or far from zero.
class Zeros {
 public:
  Zeros(std::function<Real(Real)> f, const std::vector<Real>& grid) : f_(std::move(f)) {
    Real f_a = f_(grid.front());
    for (std::size_t i = 0; i + 1 < grid.size(); ++i) {
      const Real f_b = f_(grid[i + 1]);
      halve(grid[i], grid[i + 1], f_a, f_b, 0);
      f_a = f_b;
    }
  }

  const std::vector<Real>& found() const { return found_; }

 private:
  void halve(Real a, Real b, Real f_a, Real f_b, int depth) {
    const Real m = (a + b) / 2;
    const Real f_m = f_(m);
    const Real bend = std::abs(f_m - (f_a + f_b) / 2);
    const bool change = (f_a > 0) != (f_b > 0);
    const bool hidden = (f_m > 0) != (f_a > 0) && !change;
    if (!change && !hidden && std::min({std::abs(f_a), std::abs(f_m), std::abs(f_b)}) > 2 * bend) return;
    if (change && bend < 0.05L * std::abs(f_a - f_b)) {
      found_.push_back(bisected(a, b, f_a > 0));
    } else if (depth < 50) {
      halve(a, m, f_a, f_m, depth + 1);
      halve(m, b, f_m, f_b, depth + 1);
    }
  }

  Real bisected(Real a, Real b, bool positive) const {
    for (int i = 0; i < 70; ++i) {
      const Real m = (a + b) / 2;
      ((f_(m) > 0) == positive ? a : b) = m;
    }
    return (a + b) / 2;
  }

  std::function<Real(Real)> f_;
  std::vector<Real> found_;
};

class History {
 public:
  History(const Case& c, const Window& window, const Range& preloads)
      : response_(c), window_(window), preloads_(preloads), map_(c, window, preloads) {
    for (const RidgePoint& fold : map_.folds()) add(std::exp(fold.log_preload), fold.log_eta);
    look_at_switch();
    look_at_end(std::log(window.low));
    look_at_end(std::log(window.high));
    std::sort(candidates_.begin(), candidates_.end(),
              [](const Candidate& a, const Candidate& b) { return a.preload < b.preload; });
    count(c);
  }

  const RidgeMap& map() const { return map_; }
  const std::vector<Change>& changes() const { return changes_; }
  /// Preloads between any two at which something may happen, with their number of local peaks.
  const std::vector<std::pair<Real, int>>& counts() const { return counts_; }
  /// Changes that the scan does not confirm right beside them: the list is not complete.
  int misplaced() const { return misplaced_; }

 private:
  struct Candidate {
    Real preload;
    Real log_eta;
  };

  void add(Real preload, Real log_eta) {
    if (preload > preloads_.low && preload < preloads_.high) candidates_.push_back({preload, log_eta});
  }

  /// Along R = S: extrema of Y on either side, and of its preload.
  void look_at_switch() {
    const std::vector<Real> columns = columns_of(response_, window_);
    const auto zeros = [&](bool slip, Real Given::*what) {
      const Zeros found([&](Real x) { return response_.at_ratio(x, 0, slip).*what; }, columns);
      for (const Real x : found.found()) add(response_.at_ratio(x, 0, slip).preload, x);
    };
    zeros(true, &Given::log_Y_slope);
    zeros(false, &Given::log_Y_slope);
    zeros(false, &Given::log_ratio_slope);
  }

  /// Extrema of Y that pass an end of the window.
  void look_at_end(Real x) {
    add(response_.at_ratio(x, 0, true).preload, x);
    std::vector<Real> rows;  // ln t
    for (Real row = -45; row < 5; row += row < -5 ? 0.2L : 0.01L) rows.push_back(row);
    const auto at = [&](Real row) { return response_.at_ratio(x, std::exp(row), true); };
    const Zeros found([&](Real row) { return at(row).log_Y_slope; }, rows);
    for (const Real row : found.found()) add(at(row).preload, x);
  }

  void count(const Case& c) {
    const auto peaks = [&](Real preload) { return static_cast<int>(peaks_at(c, window_, preload).size()); };
    int last = -1;
    for (std::size_t i = 0; i <= candidates_.size(); ++i) {
      const Real low = i == 0 ? preloads_.low : candidates_[i - 1].preload;
      const Real high = i == candidates_.size() ? preloads_.high : candidates_[i].preload;
      if (!(high > low * (1 + 1e-15L))) continue;
      const Real preload = std::sqrt(low * high);
      const int now = peaks(preload);
      if (last >= 0 && now != last) {
        changes_.push_back({low, std::exp(candidates_[i - 1].log_eta), now - last});
        const Real near = std::min(1e-5L, (preload / low - 1) / 2);
        const Real before = std::min(1e-5L, (low / counts_.back().first - 1) / 2);
        if (peaks(low * (1 + near)) != now || peaks(low * (1 - before)) != last) ++misplaced_;
      }
      counts_.emplace_back(preload, now);
      last = now;
    }
  }

  Response response_;
  Window window_;
  Range preloads_;
  RidgeMap map_;
  std::vector<Candidate> candidates_;
  std::vector<std::pair<Real, int>> counts_;
  std::vector<Change> changes_;
  int misplaced_ = 0;
};

}  // namespace dense
