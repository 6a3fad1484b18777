#pragma once

// The highest of several peaks over the preload: which one it is from where to where, with the places located
// at which it changes, and where it is lowest.

#include <vector>

#include "arcslip/problems/ridges/peak_piece.hpp"

namespace arcslip::problems {

/// Of pieces that together cover the range.
class PeakEnvelope {
 public:
  /// From one preload to the next one piece is the highest.
  struct Span {
    double from;        ///< in P
    double to;          ///< in P
    std::size_t piece;  ///< its position
  };

  /// A place on the envelope. Between two neighbouring ones it is monotone in P.
  struct Knot {
    double preload;    ///< P
    double log_Y;      ///< of the highest peak
    std::size_t span;  ///< the position of the span that holds it
  };

  /// Keeps a reference. Throws std::runtime_error where no peak is known at some preload.
  PeakEnvelope(const std::vector<PeakPiece>& pieces, double from, double to);

  /// From end to end of the range, P rising.
  const std::vector<Span>& spans() const { return spans_; }

  /// Nodes of the pieces, ends of the spans and the extrema between them, P rising.
  const std::vector<Knot>& knots() const { return knots_; }

  /// The highest peak at a preload; where two meet, the one that is the highest below it.
  Peak at(double preload) const;

  /// Whether the piece is the highest at this preload.
  bool owns(std::size_t piece, double preload) const;

  /// Where ln Y rises above a level for the first time on the way from a knot, upwards or downwards in P; the
  /// range's end if it does not.
  double leaves(std::size_t knot, double log_level, bool upwards) const;

 private:
  std::size_t top(const std::vector<std::size_t>& alive, double preload) const;
  void resolve(const std::vector<std::size_t>& alive, double from, std::size_t first, double to,
               std::size_t last, int depth);
  void check_between(const std::vector<std::size_t>& alive, double from, double to, std::size_t owner,
                     int depth);
  void append(double from, double to, std::size_t piece);
  void place_knots();
  double extremum(const PeakPiece& piece, double from, double to) const;

  const std::vector<PeakPiece>& pieces_;
  std::vector<Span> spans_;
  std::vector<Knot> knots_;
};

}  // namespace arcslip::problems
