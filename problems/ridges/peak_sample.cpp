#include "arcslip/problems/ridges/peak_sample.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arcslip/problems/ridges/envelope_curve.hpp"

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

namespace {

/// Whether a peak of a sample that goes no further than somewhere within a distance may be the highest there.
bool may_be_highest(const PeakSample& sample, std::size_t peak, double distance) {
  const double relative = std::abs(sample.peaks[peak].slope - sample.highest().slope);
  constexpr double other = 0.5;  // of slopes: by which they may change on the way
  const double gap = sample.highest().log_height - sample.peaks[peak].log_height;
  return gap < distance * (relative + other);
}

continuation::Guess guess_between(const ResponsePeak& a, const ResponsePeak& b, double part) {
  return {(1 - part) * a.at.unknowns + part * b.at.unknowns,
          (1 - part) * a.at.parameters + part * b.at.parameters,
          part < 0.5 ? a.at.regime : b.at.regime,
          {}};
}

/// The peak at a value of `across` that is this part of the way from a to b.
std::optional<ResponsePeak> followed(ResponsePeaks& responses, const ResponsePeak& a, const ResponsePeak& b,
                                     double part, double value) {
  const auto find = [&](continuation::Guess guess, double across) {
    guess.parameters(responses.across()) = across;
    return responses.next_to(guess, a.site);
  };
  if (const auto found = find(guess_between(a, b, part), value)) return found;
  // In shorter steps from the nearer end, each to where the two before it lead.
  constexpr int steps = 4;
  const bool from_a = part < 0.5;
  const double start = (from_a ? a : b).at.parameters(responses.across());
  ResponsePeak before = from_a ? a : b;
  const double first = (from_a ? part : 1 - part) / steps;
  std::optional<ResponsePeak> last =
      find(guess_between(before, from_a ? b : a, first), start * std::pow(value / start, 1.0 / steps));
  for (int i = 2; last && i <= steps; ++i) {
    const continuation::Guess next = guess_between(before, *last, 2);
    before = *last;
    last = find(next, i == steps ? value : start * std::pow(value / start, static_cast<double>(i) / steps));
  }
  return last;
}

/// Whether a peak is what its ridge is this part of the way from a to b. Where these are two ridges what is
/// found is one of them, beside the line between both.
bool is_between(const ResponsePeak& found, const ResponsePeak& a, const ResponsePeak& b, double distance,
                double part) {
  constexpr double bent = 0.25;        // of the way in place
  constexpr double beside = 2e-5;      // of places, where a peak hardly moves
  constexpr double like_cubic = 0.04;  // of ln height over ln b: where slip begins cubics are that wrong
  const double way = std::log(b.place / a.place);
  const double off = std::log(found.place / a.place) - part * way;
  const EnvelopePiece expected{{0, a.log_height, a.slope}, {distance, b.log_height, b.slope}};
  return std::abs(off) <= bent * std::abs(way) + beside &&
         std::abs(found.log_height - expected.at(part * distance)) <= like_cubic * distance;
}

}  // namespace

bool jumps(const PeakSample& from, const PeakSample& to) {
  constexpr double least = 1e-4;
  constexpr double far_more = 100;
  const double change = std::abs(to.highest().log_height - from.highest().log_height);
  const double slopes = std::abs(from.highest().slope) + std::abs(to.highest().slope);
  return change > std::max(least, far_more * slopes * std::abs(to.x - from.x));
}

std::optional<PeakSample> followed_peaks(ResponsePeaks& responses, const PeakSample& below,
                                         const PeakSample& above, double x, double value) {
  const double distance = above.x - below.x;
  const double part = (x - below.x) / distance;
  const auto pairs = joined_peaks(below, above);
  std::vector<bool> goes_on(below.peaks.size(), false);
  std::vector<bool> comes_from(above.peaks.size(), false);
  PeakSample sample{x, value, {}, 0, false};
  for (const auto& [i, k] : pairs) {
    goes_on[i] = comes_from[k] = true;
    const ResponsePeak& a = below.peaks[i];
    const ResponsePeak& b = above.peaks[k];
    if (a.site != b.site) return std::nullopt;
    const std::optional<ResponsePeak> found = followed(responses, a, b, part, value);
    if (!found) return std::nullopt;
    const bool is_next = sample.peaks.empty() || found->place > sample.peaks.back().place;
    if (!is_next || !is_between(*found, a, b, distance, part)) return std::nullopt;
    sample.peaks.push_back(*found);
  }
  for (std::size_t i = 0; i < goes_on.size(); ++i) {
    if (!goes_on[i] && may_be_highest(below, i, distance)) return std::nullopt;
  }
  for (std::size_t k = 0; k < comes_from.size(); ++k) {
    if (!comes_from[k] && may_be_highest(above, k, distance)) return std::nullopt;
  }
  if (sample.peaks.empty()) return std::nullopt;
  sample.top = highest_of(sample.peaks);
  return sample;
}

}  // namespace arcslip::problems
