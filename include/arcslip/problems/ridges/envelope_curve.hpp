#pragma once

// The height of the highest peak as a function of the preload, quick to evaluate: ln Y_max over x = ln P from
// the points of a preload study. Between two neighbouring points of a peak it is the cubic with their values
// and slopes, which are exact; corners and exchanges of peaks are points, so that every piece is smooth.

#include <cstddef>
#include <vector>

#include "arcslip/problems/ridges/preload_study.hpp"

namespace arcslip::problems {

/// ln Y_max at x = ln P, with d ln Y_max/d ln P on the side of the piece that it belongs to.
struct EnvelopeNode {
  double x;      ///< ln P
  double value;  ///< ln Y_max
  double slope;  ///< by x
};

/// Both ends of a cubic.
struct EnvelopePiece {
  EnvelopeNode from;  ///< that of lower x
  EnvelopeNode to;    ///< that of higher x

  /// Its value at x between its ends.
  double at(double x) const;
};

/// Immutable; may be shared by threads.
class EnvelopeCurve {
 public:
  /// Of pieces that overlap the higher one counts. Throws std::runtime_error where they leave a gap.
  explicit EnvelopeCurve(std::vector<EnvelopePiece> pieces);

  /// The highest peaks of a study that is whole. Throws std::runtime_error for others.
  explicit EnvelopeCurve(const PreloadStudy& study);

  /// The highest of all peaks of branches, which may leave gaps where one begins between two preloads: there
  /// a line leads from the highest one to the next, of which all that it rises or falls by is its error.
  static EnvelopeCurve over_gaps(const std::vector<PeakBranch>& branches);

  double from() const { return spans_.front().from; }  ///< in x
  double to() const { return spans_.back().to; }       ///< the same

  /// ln Y_max at x, which must lie within from() .. to() but for rounding: O(log of the number of pieces).
  double at(double x) const;

  /// The same at rising x, each from where the last one was: for passes over many values.
  class Walk {
   public:
    /// Refers to the curve.
    explicit Walk(const EnvelopeCurve& curve) : curve_(curve) {}

    /// ln Y_max at x, which must not be below the last one.
    double at(double x);

   private:
    const EnvelopeCurve& curve_;
    std::size_t span_ = 0;
  };

  /// Ends of the pieces, rising.
  std::vector<double> places() const;

  /// Estimate of the largest error in ln Y_max: how well the cubic between a point's neighbours meets the
  /// point, brought down to the distance of the points. Known only of curves made from a study.
  double error() const;

  /// Preloads at which further points would bring the error down to a tolerance.
  std::vector<double> places_wanted(double tolerance) const;

 private:
  EnvelopeCurve() = default;

  struct Span {
    double from;
    double to;
    std::size_t piece;
  };

  void add(const PeakBranch& branch);
  void add_stretch(const PeakBranch& points);
  void resolve();

  std::vector<EnvelopePiece> pieces_;
  std::vector<double> errors_;  ///< of the pieces; nan where a peak has but two points
  std::vector<Span> spans_;     ///< rising, without gaps or overlaps
};

/// The envelope over a range, from a study and, where its points are too far apart for the tolerance, from
/// further ones with more points. Throws std::runtime_error where a study fails.
EnvelopeCurve study_envelope(const SystemParameters& system, const PreloadRange& range, double tolerance,
                             const continuation::TraceOptions& options = {});

}  // namespace arcslip::problems
