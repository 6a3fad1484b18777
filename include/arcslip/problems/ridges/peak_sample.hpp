#pragma once

// The peaks of a response at one value of its second parameter b, and which of them go on at another one.

#include <optional>
#include <utility>
#include <vector>

#include "arcslip/problems/ridges/response_peaks.hpp"

namespace arcslip::problems {

/// The peaks of one response.
struct PeakSample {
  double x = 0;                     ///< ln b
  double value = 0;                 ///< b
  std::vector<ResponsePeak> peaks;  ///< in the order of the response, one at least
  std::size_t top = 0;              ///< the highest
  bool is_whole = true;             ///< whether these are all, or those alone that were followed

  /// The peak at `top`.
  const ResponsePeak& highest() const { return peaks[top]; }
};

/// Pairs (of a, of b) of peaks of two samples that are one ridge, in the order of the response, in which
/// ridges cannot change places.
std::vector<std::pair<std::size_t, std::size_t>> joined_peaks(const PeakSample& a, const PeakSample& b);

/// Whether the highest peak jumps between two samples: its height changes by far more than the slopes at both
/// make of their distance.
bool jumps(const PeakSample& from, const PeakSample& to);

/// The peaks at b, with x = ln b between two samples, that go on from one to the other, without tracing the
/// response; none where one that may be the highest between them does not, or is not found.
std::optional<PeakSample> followed_peaks(ResponsePeaks& responses, const PeakSample& below,
                                         const PeakSample& above, double x, double value);

}  // namespace arcslip::problems
