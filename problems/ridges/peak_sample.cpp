#include "arcslip/problems/ridges/peak_sample.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arcslip::problems {

std::vector<std::pair<std::size_t, std::size_t>> joined_peaks(const PeakSample& a, const PeakSample& b) {
  constexpr double alone = 0.1;  // of ln: as bad as two peaks that belong to no other
  const std::size_t n = a.peaks.size();
  const std::size_t m = b.peaks.size();
  // By how far the place moves, and the heights are from what the slopes say.
  const auto unlike = [&](std::size_t i, std::size_t k) {
    const ResponsePeak& p = a.peaks[i];
    const ResponsePeak& q = b.peaks[k];
    const double rise = 0.5 * (b.x - a.x) * (p.slope + q.slope);
    return std::abs(std::log(p.place / q.place)) + std::abs(q.log_height - p.log_height - rise);
  };
  // Least costs of the first i and k peaks.
  std::vector<double> cost((n + 1) * (m + 1));
  const auto at = [&](std::size_t i, std::size_t k) -> double& { return cost[i * (m + 1) + k]; };
  for (std::size_t i = 0; i <= n; ++i) {
    for (std::size_t k = 0; k <= m; ++k) {
      double least = i + k == 0 ? 0 : std::numeric_limits<double>::infinity();
      if (i > 0) least = std::min(least, at(i - 1, k) + alone);
      if (k > 0) least = std::min(least, at(i, k - 1) + alone);
      if (i > 0 && k > 0) least = std::min(least, at(i - 1, k - 1) + unlike(i - 1, k - 1));
      at(i, k) = least;
    }
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = n, k = m; i > 0 && k > 0;) {
    if (at(i, k) == at(i - 1, k) + alone) {
      --i;
    } else if (at(i, k) == at(i, k - 1) + alone) {
      --k;
    } else {
      pairs.emplace_back(--i, --k);
    }
  }
  std::reverse(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace arcslip::problems
