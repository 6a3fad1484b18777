#include "arcslip/problems/envelope_curve.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace arcslip::problems {
namespace {

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

/// What the cubics on both sides of b are wrong by, if that from a to c shows their fourth derivative.
double error_beside(const Peak& a, const Peak& b, const Peak& c) {
  const EnvelopeNode middle = node_of(b);
  const EnvelopePiece wide{node_of(a), node_of(c)};
  const double below = middle.x - wide.from.x;
  const double above = wide.to.x - middle.x;
  const double longer = std::max(below, above);
  const double larger = longer * longer / (4 * below * above);  // h^4/384 over (below above)^2/24, its root
  return std::abs(wide.at(middle.x) - middle.value) * larger * larger;
}

}  // namespace

double EnvelopePiece::at(double x) const {
  const double h = to.x - from.x;
  const double t = (x - from.x) / h;
  const double s = 1 - t;
  return from.value * s * s * (1 + 2 * t) + to.value * t * t * (1 + 2 * s) +
         h * s * t * (s * from.slope - t * to.slope);
}

EnvelopeCurve::EnvelopeCurve(std::vector<EnvelopePiece> pieces) : pieces_(std::move(pieces)) { resolve(); }

EnvelopeCurve::EnvelopeCurve(const PreloadStudy& study) {
  if (!study.failure.empty()) throw std::invalid_argument("EnvelopeCurve: " + study.failure);
  for (const PeakBranch& branch : study.branches) {
    for (std::size_t i = 0; i + 1 < branch.size(); ++i) {
      if (!branch[i].is_global || !branch[i + 1].is_global) continue;
      pieces_.push_back(piece_between(branch[i], branch[i + 1]));
      if (i + 2 < branch.size() && branch[i + 2].is_global && branch[i].site == branch[i + 2].site &&
          branch[i].site == branch[i + 1].site)
        error_ = std::max(error_, error_beside(branch[i], branch[i + 1], branch[i + 2]));
    }
  }
  resolve();
}

/// A peak that is the highest at two neighbouring points need not be so between them, where another one takes
/// over and gives back: both then have a piece there, and neither crosses the other but at its ends.
void EnvelopeCurve::resolve() {
  std::vector<double> ends;
  for (const EnvelopePiece& piece : pieces_) {
    if (!(piece.to.x > piece.from.x)) throw std::invalid_argument("EnvelopeCurve: a piece without length");
    ends.push_back(piece.from.x);
    ends.push_back(piece.to.x);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  if (ends.empty()) throw std::invalid_argument("EnvelopeCurve: no pieces");
  std::vector<std::size_t> best(ends.size() - 1, pieces_.size());
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const auto first = std::lower_bound(ends.begin(), ends.end(), pieces_[p].from.x) - ends.begin();
    for (auto i = static_cast<std::size_t>(first); ends[i] < pieces_[p].to.x; ++i) {
      const double middle = 0.5 * (ends[i] + ends[i + 1]);
      if (best[i] == pieces_.size() || pieces_[p].at(middle) > pieces_[best[i]].at(middle)) best[i] = p;
    }
  }
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    if (best[i] == pieces_.size()) throw std::invalid_argument("EnvelopeCurve: a gap between pieces");
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

std::vector<double> EnvelopeCurve::places() const {
  std::vector<double> ends = {from()};
  for (const Span& span : spans_) ends.push_back(span.to);
  return ends;
}

}  // namespace arcslip::problems
