#pragma once

// All peaks of Y over a window of eta, at one preload, from the dense scan; the highest of them as a function
// of the preload, with its exchanges, its minimum and the range around it.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "dense_scan.hpp"

namespace dense {

enum class Site { slip, stick, corner, edge };

inline std::string name(Site site) {
  constexpr std::array names{"slip", "stick", "corner", "edge"};
  return names.at(static_cast<std::size_t>(site));
}

struct LocalPeak {
  Real eta;
  Real log_Y;
  Real log_ratio;  ///< ln(R/S)
  Site site;
};

struct Window {
  Real low;
  Real high;
};

/// All local peaks at one preload, by eta.
inline std::vector<LocalPeak> peaks_at(const Case& c, const Window& window, Real preload) {
  Scan scan(c, false, preload, window.low, window.high);
  std::vector<LocalPeak> peaks;
  const auto edge = [&](Real eta, Real direction) {
    const Sample s = scan.at(std::log(eta));
    if (s.log_Y_slope * direction > 0) peaks.push_back({eta, s.log_Y, s.log_ratio, Site::edge});
  };
  edge(window.low, -1);
  Real corner = 0;
  for (const Event& event : scan.events()) {
    if (event.kind == Event::Kind::crossing) corner = event.at;
    if (event.kind != Event::Kind::peak) continue;
    if (event.at == corner) {
      peaks.push_back({event.at, event.log_Y, 0, Site::corner});
    } else {
      const Real log_ratio = scan.at(std::log(event.at)).log_ratio;
      peaks.push_back({event.at, event.log_Y, log_ratio, log_ratio > 0 ? Site::slip : Site::stick});
    }
  }
  edge(window.high, 1);
  return peaks;
}

inline LocalPeak highest(const std::vector<LocalPeak>& peaks) {
  return *std::max_element(peaks.begin(), peaks.end(),
                           [](const LocalPeak& a, const LocalPeak& b) { return a.log_Y < b.log_Y; });
}

/// The highest amplitude of the base without damper in the window.
inline LocalPeak free_peak(const Case& c, const Window& window) {
  const Response response(c);
  std::vector<Real> grid{std::log(window.low), std::log(window.high)};
  for (int i = 1; i < 1000; ++i) grid.push_back(grid[0] + (grid[1] - grid[0]) * i / 1000);
  for (const Real eta : response.landmarks()) {
    grid.push_back(std::log(eta));
    for (Real distance = 0.3L; distance > 1e-11L; distance /= 1.5L) {
      grid.push_back(std::log(eta) - distance);
      grid.push_back(std::log(eta) + distance);
    }
  }
  std::erase_if(grid, [&](Real x) { return x < std::log(window.low) || x > std::log(window.high); });
  std::sort(grid.begin(), grid.end());
  std::vector<Real> candidates{grid.front(), grid.back()};
  for (std::size_t i = 0; i + 1 < grid.size(); ++i) {
    Real a = grid[i];
    Real b = grid[i + 1];
    if (response.free(a).second <= 0 || response.free(b).second >= 0) continue;
    for (int k = 0; k < 100; ++k) {
      const Real middle = (a + b) / 2;
      (response.free(middle).second > 0 ? a : b) = middle;
    }
    candidates.push_back(a);
  }
  LocalPeak best{};
  best.log_Y = -1e30L;
  for (const Real x : candidates) {
    const Real log_Y = response.free(x).first;
    if (log_Y > best.log_Y) best = {std::exp(x), log_Y, 0, Site::stick};
  }
  return best;
}

}  // namespace dense
