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
  Real depth;  ///< least difference of ln Y to the trough or end next to it
};

struct Window {
  Real low;
  Real high;
};

/// All local peaks at one preload, by eta.
inline std::vector<LocalPeak> peaks_at(const Case& c, const Window& window, Real preload) {
  Scan scan(c, false, preload, window.low, window.high);
  std::vector<LocalPeak> peaks;
  const Sample first = scan.at(std::log(window.low));
  const Sample last = scan.at(std::log(window.high));
  std::vector<Real> heights{first.log_Y};
  for (const Event& event : scan.events()) {
    if (event.kind != Event::Kind::crossing) heights.push_back(event.log_Y);
  }
  heights.push_back(last.log_Y);
  const auto edge = [&](Real eta, const Sample& s, Real next) {
    peaks.push_back({eta, s.log_Y, s.log_ratio, Site::edge, std::abs(s.log_Y - next)});
  };
  if (first.log_Y_slope < 0) edge(window.low, first, heights[1]);
  Real corner = 0;
  for (const Event& event : scan.events()) {
    if (event.kind == Event::Kind::crossing) corner = event.at;
    if (event.kind != Event::Kind::peak) continue;
    if (event.at == corner) {
      peaks.push_back({event.at, event.log_Y, 0, Site::corner, event.depth});
    } else {
      const Real log_ratio = scan.at(std::log(event.at)).log_ratio;
      peaks.push_back(
          {event.at, event.log_Y, log_ratio, log_ratio > 0 ? Site::slip : Site::stick, event.depth});
    }
  }
  if (last.log_Y_slope > 0) edge(window.high, last, heights[heights.size() - 2]);
  if (peaks.empty() && scan.events().empty()) {  // a peak on an end of the window, but for rounding
    const bool at_first = first.log_Y > last.log_Y;
    const Sample& end = at_first ? first : last;
    peaks.push_back({at_first ? window.low : window.high, end.log_Y, end.log_ratio, Site::edge, 0});
  }
  if (peaks.empty()) {  // where R touches S on the peak, rounding decides on which side it is
    const Event top = *std::max_element(scan.events().begin(), scan.events().end(),
                                        [](const Event& a, const Event& b) { return a.log_Y < b.log_Y; });
    peaks.push_back({top.at, top.log_Y, 0, Site::corner, 0});
  }
  return peaks;
}

inline LocalPeak highest(const std::vector<LocalPeak>& peaks) {
  return *std::max_element(peaks.begin(), peaks.end(),
                           [](const LocalPeak& a, const LocalPeak& b) { return a.log_Y < b.log_Y; });
}

/// ln eta over the window, closer and closer towards each landmark.
inline std::vector<Real> columns_of(const Response& response, const Window& window) {
  const Real from = std::log(window.low);
  const Real to = std::log(window.high);
  std::vector<Real> columns{from, to};
  for (int i = 1; i < 150; ++i) columns.push_back(from + (to - from) * i / 150);
  for (const Real eta : response.landmarks()) {
    columns.push_back(std::log(eta));
    for (Real distance = 0.3L; distance > 1e-8L; distance /= 2.5L) {
      columns.push_back(std::log(eta) - distance);
      columns.push_back(std::log(eta) + distance);
    }
  }
  std::erase_if(columns, [&](Real x) { return !(x >= from && x <= to); });
  std::sort(columns.begin(), columns.end());
  const auto close = [](Real a, Real b) { return b - a < 1e-10L; };
  columns.erase(std::unique(columns.begin(), columns.end(), close), columns.end());
  return columns;
}

/// The highest amplitude of the base without damper in the window.
inline LocalPeak free_peak(const Case& c, const Window& window) {
  const Response response(c);
  const std::vector<Real> grid = columns_of(response, window);
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
    if (log_Y > best.log_Y) best = {std::exp(x), log_Y, 0, Site::stick, 0};
  }
  return best;
}

/// d ln Y/d ln x of a local peak in the window, where `change(case, ln P, h)` multiplies x by e^h: central
/// differences of fourth order, of a scan of its surroundings.
template <class Change>
Real sensitivity(const Case& c, const Window& window, Real preload, const LocalPeak& peak, Change change,
                 Real step = 1e-3L) {
  const auto log_Y = [&](Real h) {
    Case changed = c;
    Real log_preload = std::log(preload);
    change(changed, log_preload, h);
    const Window around{std::max(peak.eta * 0.9L, window.low), std::min(peak.eta * 1.1L, window.high)};
    const std::vector<LocalPeak> peaks = peaks_at(changed, around, std::exp(log_preload));
    return std::min_element(peaks.begin(), peaks.end(),
                            [&](const LocalPeak& a, const LocalPeak& b) {
                              return std::abs(a.eta - peak.eta) < std::abs(b.eta - peak.eta);
                            })
        ->log_Y;
  };
  return (8 * (log_Y(step) - log_Y(-step)) - (log_Y(2 * step) - log_Y(-2 * step))) / (12 * step);
}

}  // namespace dense
