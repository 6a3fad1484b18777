#pragma once

// The ridges of peaks between two neighbouring samples: cubics where a peak goes on, lines where it does not.

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "arcslip/problems/ridges/envelope_curve.hpp"
#include "arcslip/problems/ridges/peak_sample.hpp"

namespace arcslip::problems {

/// A peak of a sample as a point of its ridge.
inline EnvelopeNode node_of(const PeakSample& sample, std::size_t peak) {
  return {sample.x, sample.peaks[peak].log_height, sample.peaks[peak].slope};
}

/// A peak's ridge as far as the tangent at one end tells.
inline EnvelopePiece line(const EnvelopeNode& node, double from, double to) {
  const auto at = [&](double x) {
    return EnvelopeNode{x, node.value + (x - node.x) * node.slope, node.slope};
  };
  return {at(from), at(to)};
}

/// What is known between two neighbouring samples.
struct PeakInterval {
  const PeakSample& from;                                  ///< that of lower x
  const PeakSample& to;                                    ///< that of higher x
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< of joined_peaks
  std::vector<EnvelopePiece> pieces;                       ///< cubics of the pairs, lines of the others
  double error = 0;                                        ///< of the pieces at its middle

  /// In x.
  double length() const { return to.x - from.x; }

  /// The highest of the pieces; -infinity without any.
  double height(double x) const {
    double highest = -std::numeric_limits<double>::infinity();
    for (const EnvelopePiece& piece : pieces) highest = std::max(highest, piece.at(x));
    return highest;
  }

  /// Errors of cubics go to zero at both ends as squares.
  double error_at(double x) const {
    const double t = (x - from.x) / length();
    return 16 * error * t * t * (1 - t) * (1 - t);
  }

  /// What a peak of `from` becomes in `to`; none where it dies.
  std::optional<std::size_t> partner_of_from(std::size_t peak) const {
    for (const auto& [i, k] : pairs) {
      if (i == peak) return k;
    }
    return std::nullopt;
  }

  /// What a peak of `to` was in `from`; none where it is born between.
  std::optional<std::size_t> partner_of_to(std::size_t peak) const {
    for (const auto& [i, k] : pairs) {
      if (k == peak) return i;
    }
    return std::nullopt;
  }

  /// Whether the highest peaks at both ends go on.
  bool is_clear() const { return partner_of_from(from.top) && partner_of_to(to.top); }

  /// The ridge of a peak of `from`, up to `to`.
  EnvelopePiece ahead(std::size_t peak) const {
    const auto partner = partner_of_from(peak);
    const EnvelopeNode node = node_of(from, peak);
    return partner ? EnvelopePiece{node, node_of(to, *partner)} : line(node, from.x, to.x);
  }

  /// The ridge of a peak of `to`, down to `from`.
  EnvelopePiece back(std::size_t peak) const {
    const auto partner = partner_of_to(peak);
    const EnvelopeNode node = node_of(to, peak);
    return partner ? EnvelopePiece{node_of(from, *partner), node} : line(node, from.x, to.x);
  }
};

}  // namespace arcslip::problems
