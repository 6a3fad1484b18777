#include "arcslip/problems/ridges/envelope_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

namespace arcslip::problems {
namespace {

constexpr double no_estimate = std::numeric_limits<double>::quiet_NaN();

EnvelopeNode node_of(const Peak& peak) {
  return {std::log(peak.preload), std::log(peak.Y), peak.sensitivity.preload};
}

/// Where a peak changes its site, the point belongs to the piece below it: the slope above is then that of
/// the parabola through both values with the other end's slope.
EnvelopePiece piece_between(const Peak& a, const Peak& b) {
  EnvelopePiece piece{node_of(a), node_of(b)};
  if (a.site != b.site)
    piece.from.slope = 2 * (piece.to.value - piece.from.value) / (piece.to.x - piece.from.x) - piece.to.slope;
  return piece;
}

/// In x: as far apart heights differ by less than they are known to.
constexpr double together = 1e-9;

/// What the pieces on both sides of b are wrong by, if that from a to c shows their next derivative: of a
/// cubic the error is f""(x - a)^2(c - x)^2/24, of a parabola f"'(x - a)(c - x)^2/6. Unknown where one of the
/// two is so short that the cubic misses b by rounding alone.
double error_beside(const Peak& a, const Peak& b, const Peak& c) {
  constexpr double lopsided = 1e-2;
  const EnvelopePiece wide = piece_between(a, c);
  const double x = std::log(b.preload);
  const double below = x - wide.from.x;
  const double above = wide.to.x - x;
  const double longer = std::max(below, above);
  if (std::min(below, above) < std::max(together, lopsided * longer)) return no_estimate;
  const double share = a.site == b.site ? std::pow(longer * longer / (4 * below * above), 2)
                                        : 4 * std::pow(longer, 3) / (27 * below * above * above);
  return share * std::abs(wide.at(x) - std::log(b.Y));
}

/// The points of a stretch of a branch, but of those that lie together one: an end of the stretch or the last
/// point of a site, if there is one, as these bound pieces.
PeakBranch apart(PeakBranch::const_iterator first, PeakBranch::const_iterator last) {
  PeakBranch kept;
  bool kept_bounds = false;  // the one kept last
  for (auto point = first; point != last; ++point) {
    const bool bounds = point == first || point + 1 == last || point->site != (point + 1)->site;
    const bool is_apart = kept.empty() || std::log(point->preload) - std::log(kept.back().preload) > together;
    if (!is_apart && !bounds) continue;
    if (!is_apart && !kept_bounds) kept.pop_back();
    kept.push_back(*point);
    kept_bounds = bounds;
  }
  return kept;
}

}  // namespace

double EnvelopePiece::at(double x) const {
  const double h = to.x - from.x;
  const double t = (x - from.x) / h;
  const double s = 1 - t;
  return from.value * s * s * (1 + 2 * t) + to.value * t * t * (1 + 2 * s) +
         h * s * t * (s * from.slope - t * to.slope);
}

EnvelopeCurve::EnvelopeCurve(std::vector<EnvelopePiece> pieces)
    : pieces_(std::move(pieces)), errors_(pieces_.size(), 0) {
  resolve();
}

EnvelopeCurve::EnvelopeCurve(const PreloadStudy& study) {
  if (!study.failure.empty()) throw std::runtime_error(study.failure);
  for (const PeakBranch& branch : study.branches) add(branch);
  resolve();
}

EnvelopeCurve EnvelopeCurve::over_gaps(const std::vector<PeakBranch>& branches) {
  EnvelopeCurve curve;
  std::map<double, const Peak*> highest;  // by preload
  for (const PeakBranch& branch : branches) {
    curve.add_stretch(apart(branch.begin(), branch.end()));
    for (const Peak& peak : branch) {
      if (peak.is_global) highest.emplace(peak.preload, &peak);
    }
  }
  const std::vector<EnvelopePiece> known = curve.pieces_;
  for (auto to = highest.begin(); to != highest.end() && ++to != highest.end();) {
    const Peak& a = *std::prev(to)->second;
    const Peak& b = *to->second;
    const double middle = 0.5 * (std::log(a.preload) + std::log(b.preload));
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const EnvelopePiece& piece) {
      return piece.from.x < middle && middle < piece.to.x;
    });
    if (is_known) continue;
    EnvelopePiece line{node_of(a), node_of(b)};
    line.from.slope = line.to.slope = (line.to.value - line.from.value) / (line.to.x - line.from.x);
    curve.pieces_.push_back(line);
    curve.errors_.push_back(std::abs(line.to.value - line.from.value));
  }
  curve.resolve();
  return curve;
}

void EnvelopeCurve::add(const PeakBranch& branch) {
  const auto is_global = [](const Peak& peak) { return peak.is_global; };
  auto last = branch.begin();
  for (;;) {
    const auto first = std::find_if(last, branch.end(), is_global);
    if (first == branch.end()) return;
    last = std::find_if_not(first, branch.end(), is_global);
    add_stretch(apart(first, last));
  }
}

void EnvelopeCurve::add_stretch(const PeakBranch& points) {
  double below = no_estimate;  // by the point below and its neighbours
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const bool goes_on = i + 2 < points.size() && points[i + 1].site == points[i + 2].site;
    const double above = goes_on ? error_beside(points[i], points[i + 1], points[i + 2]) : no_estimate;
    const EnvelopePiece piece = piece_between(points[i], points[i + 1]);
    const double length = piece.to.x - piece.from.x;
    if (length > 0) {  // of the logarithms
      pieces_.push_back(piece);
      errors_.push_back(length > together ? std::fmax(below, above) : 0);  // the one that is known
    }
    below = above;
  }
}

double EnvelopeCurve::error() const {
  double worst = 0;
  for (const double error : errors_) worst = std::fmax(worst, error);
  return worst;
}

std::vector<double> EnvelopeCurve::places_wanted(double tolerance) const {
  std::vector<double> preloads;
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const auto& [from, to] = pieces_[p];
    if (errors_[p] <= tolerance) continue;
    // Without an estimate one point more gives one; else as many as errors that fall with the cube ask for.
    const double parts = std::isnan(errors_[p]) ? 2 : std::ceil(std::cbrt(errors_[p] / tolerance) + 1);
    if (std::isnan(errors_[p]) && std::abs(to.value - from.value) <= tolerance) continue;
    for (int i = 1; i < parts; ++i) preloads.push_back(std::exp(from.x + (to.x - from.x) * i / parts));
  }
  return preloads;
}

/// A peak that is the highest at two neighbouring points need not be so between them, where another one takes
/// over and gives back: both then have a piece there, and neither crosses the other but at its ends.
void EnvelopeCurve::resolve() {
  std::vector<double> ends;
  for (const EnvelopePiece& piece : pieces_) {
    if (!(piece.to.x > piece.from.x)) throw std::runtime_error("EnvelopeCurve: a piece without length");
    ends.push_back(piece.from.x);
    ends.push_back(piece.to.x);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  if (ends.empty()) throw std::runtime_error("EnvelopeCurve: no pieces");
  std::vector<std::size_t> best(ends.size() - 1, pieces_.size());
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const auto first = std::lower_bound(ends.begin(), ends.end(), pieces_[p].from.x) - ends.begin();
    for (auto i = static_cast<std::size_t>(first); ends[i] < pieces_[p].to.x; ++i) {
      const double middle = 0.5 * (ends[i] + ends[i + 1]);
      if (best[i] == pieces_.size() || pieces_[p].at(middle) > pieces_[best[i]].at(middle)) best[i] = p;
    }
  }
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    if (best[i] == pieces_.size()) throw std::runtime_error("EnvelopeCurve: a gap between pieces");
    spans_.push_back({ends[i], ends[i + 1], best[i]});
  }
}

double EnvelopeCurve::at(double x) const {
  const auto span = std::upper_bound(spans_.begin(), spans_.end() - 1, x,
                                     [](double value, const Span& one) { return value < one.to; });
  return pieces_[span->piece].at(x);
}

double EnvelopeCurve::Walk::at(double x) {
  while (span_ + 1 < curve_.spans_.size() && x >= curve_.spans_[span_].to) ++span_;
  return curve_.pieces_[curve_.spans_[span_].piece].at(x);
}

EnvelopeCurve study_envelope(const SystemParameters& system, const PreloadRange& range, double tolerance,
                             const continuation::TraceOptions& options) {
  constexpr int most_studies = 5;
  PreloadRange with_points = range;
  for (int i = 1;; ++i) {
    EnvelopeCurve envelope(study_preload(system, with_points, options));
    const std::vector<double> more = envelope.places_wanted(tolerance);
    if (more.empty() || i == most_studies) return envelope;
    with_points.stop_at.insert(with_points.stop_at.end(), more.begin(), more.end());
  }
}

std::vector<double> EnvelopeCurve::places() const {
  std::vector<double> ends = {from()};
  for (const Span& span : spans_) ends.push_back(span.to);
  return ends;
}

}  // namespace arcslip::problems
