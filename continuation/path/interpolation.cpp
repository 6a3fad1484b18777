#include "arcslip/continuation/path/interpolation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "arcslip/continuation/path/hermite.hpp"
#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {
namespace {

/// A point of the curve over s, the way along a line.
struct Knot {
  double s;
  Vector value;
  Vector slope;
  bool runs = true;  ///< whether the curve runs the same way
};

/// 1/size^2, such that the parameter counts as much as all unknowns.
Vector weights(const Vector& sizes) {
  const Index n = sizes.size() - 1;
  Vector all = (sizes.array() > 0).select(sizes.array().square().inverse(), 0.0);
  all.head(n) /= static_cast<double>(std::max<Index>(1, n));
  return all;
}

double weighted(const Vector& weight, const Vector& a, const Vector& b) {
  return (weight.array() * a.array() * b.array()).sum();
}

/// The lengths of the slopes d_0, d_1 of a cubic over [0, 1] with this chord for which its third derivative
/// is least.
std::array<double, 2> fitted(const Vector& weight, const Vector& chord, const Vector& d_0,
                             const Vector& d_1) {
  // Where the ends turn by less than about 0.03 any lengths will do, and rounding would decide.
  constexpr double straight = 1e-3;
  const auto product = [&](const Vector& a, const Vector& b) { return weighted(weight, a, b); };
  const double a = straight + product(d_0, d_0);
  const double b = product(d_0, d_1);
  const double c = straight + product(d_1, d_1);
  const double d = straight + 2 * product(d_0, chord);
  const double e = straight + 2 * product(d_1, chord);
  const double first = (d * c - e * b) / (a * c - b * b);
  const double second = (a * e - b * d) / (a * c - b * b);
  if (first < 0) return {0, std::max(0.0, e / c)};
  if (second < 0) return {std::max(0.0, d / a), 0};
  return {first, second};
}

}  // namespace

/// Between two points as a graph over a line: s = n . (z - z_0) from 0 to 1, in which its points have exact
/// slopes t/(n . t). Of several lines, of powers of s and of its root, those whose series falls off best.
class InterpolatedBranch::Piece {
 public:
  Piece(const InterpolatedBranch& branch, std::size_t piece);

  std::size_t number() const { return piece_; }
  double least() const { return least_; }

  /// A part `x` of the way.
  Vector at(double x) const;
  Vector error(double x) const;

 private:
  Vector axis(const Vector& d_0, const Vector& d_1) const;
  void try_line(Vector normal);
  void try_powers(std::optional<Hermite::Corner> corner, const std::vector<Knot>& knots);
  Knot knot(std::size_t point, bool arrives) const;
  bool fits(const Knot& knot) const;
  double along(double x) const;
  double size(const Vector& v) const { return std::sqrt(weighted(weight_, v, v)); }

  const InterpolatedBranch& branch_;
  std::size_t piece_;
  Vector begin_, chord_;
  Vector weight_;  ///< such that all entries count as what they change
  Vector normal_;  ///< of the line that is tried
  Hermite curve_;
  std::size_t used_ = 2;            ///< knots
  double least_ = HUGE_VAL;         ///< error in the middle
  double rate_0_ = 1, rate_1_ = 1;  ///< ds/dx at the ends
};

InterpolatedBranch::Piece::Piece(const InterpolatedBranch& branch, std::size_t piece)
    : branch_(branch),
      piece_(piece),
      begin_(branch.position(piece)),
      chord_(branch.position(piece + 1) - begin_) {
  constexpr double hardly = 1e-6;  // what changes less is rounding
  const double length = branch.distance(piece, piece + 1);
  const Vector d_0 = length * branch.leaving(piece);
  const Vector d_1 = length * branch.arriving(piece);
  const Index last = chord_.size() - 1;
  Vector sizes = chord_.cwiseAbs().cwiseMax(d_0.cwiseAbs()).cwiseMax(d_1.cwiseAbs());
  sizes.head(last) = sizes.head(last).cwiseMax(hardly * sizes.head(last).maxCoeff());
  sizes(last) = std::max(sizes(last), 1e-12 * std::abs(begin_(last)));
  weight_ = weights(sizes);
  try_line(axis(d_0, d_1));
  Vector level = weight_.cwiseProduct(chord_);
  level(last) = 0;
  try_line(level);
  try_line(Vector::Unit(last + 1, last));
}

/// That of the parabola which the piece is most like.
Vector InterpolatedBranch::Piece::axis(const Vector& d_0, const Vector& d_1) const {
  const auto product = [&](const Vector& a, const Vector& b) { return weighted(weight_, a, b); };
  const auto [a_0, a_1] = fitted(weight_, chord_, d_0, d_1);
  const double square = product(chord_, chord_);
  Vector across = a_1 * d_1 - a_0 * d_0;
  across -= product(across, chord_) / square * chord_;
  double tilt = 0;
  double sum = 1e-3 * product(across, across);
  for (const Vector& d : {Vector(a_0 * d_0), Vector(a_1 * d_1)}) {
    const double up = product(across, d);
    tilt += (1 - product(chord_, d) / square) * up;
    sum += up * up;
  }
  Vector normal = chord_ / square;
  if (sum > 0) normal += tilt / sum * across;
  return weight_.cwiseProduct(normal);
}

void InterpolatedBranch::Piece::try_line(Vector normal) {
  const double change = normal.dot(chord_);
  normal_ = normal / change;
  if (!normal_.allFinite()) return;
  std::vector<Knot> knots{knot(piece_, false), knot(piece_ + 1, true)};
  for (Knot& end : knots) {
    if (fits(end)) continue;
    if (std::isfinite(least_)) return;
    end.slope.setZero();
  }
  for (const auto& [point, arrives] : branch_.around(piece_)) {
    const Knot other = knot(point, arrives);
    if (fits(other) && (arrives ? other.s > 1 : other.s < 0)) knots.push_back(other);
  }
  const auto far = [](const Knot& at) { return std::abs(at.s - 0.5); };
  if (knots.size() == 4 && far(knots[3]) < far(knots[2])) std::swap(knots[2], knots[3]);
  try_powers(std::nullopt, knots);
  for (const int way : {-1, 1}) {
    const auto corner = branch_.corner(piece_, way);
    if (!corner) continue;
    const double s = knot(*corner, way > 0).s;
    const bool is_beyond =
        std::all_of(knots.begin(), knots.end(), [&](const Knot& at) { return way * (s - at.s) >= 0; });
    if (is_beyond) try_powers(Hermite::Corner{s, -1.0 * way}, knots);
  }
}

Knot InterpolatedBranch::Piece::knot(std::size_t point, bool arrives) const {
  const BranchPoint& at = branch_.branch_.points[point];
  const Vector value = branch_.position(point);
  const Vector& tangent = arrives ? at.arriving() : at.tangent;
  const double rate = normal_.dot(tangent);
  return {normal_.dot(value - begin_), value, tangent / rate, rate > 0};
}

/// Whether the curve runs along the line there.
bool InterpolatedBranch::Piece::fits(const Knot& knot) const {
  constexpr double steep = 30;
  return knot.slope.allFinite() && size(knot.slope) < steep * size(chord_) && knot.runs;
}

/// Takes this curve if it is the best so far: as many knots as the terms that they add fall off.
void InterpolatedBranch::Piece::try_powers(std::optional<Hermite::Corner> corner,
                                           const std::vector<Knot>& knots) {
  Hermite curve(corner);
  for (const Knot& knot : knots) curve.add(knot.s, knot.value, knot.slope);
  double last = size(curve.cubic()) / 16;
  double error = last;
  std::size_t used = 2;
  Vector term;
  for (std::size_t count = 3; count <= knots.size(); ++count) {
    curve.added(0.5, count, term);
    const double next = size(term);
    if (count > 3 && !(next < last)) break;
    error = next;
    last = next;
    used = count;
  }
  if (!(error < least_)) return;
  least_ = error;
  curve_ = std::move(curve);
  used_ = used;
  const double length = branch_.distance(piece_, piece_ + 1);
  rate_0_ = std::clamp(length * normal_.dot(branch_.leaving(piece_)), 0.0, 3.0);
  rate_1_ = std::clamp(length * normal_.dot(branch_.arriving(piece_)), 0.0, 3.0);
}

/// A part x of the arc in s, as a cubic that does not turn [Fritsch and Carlson 1980].
double InterpolatedBranch::Piece::along(double x) const {
  const double y = 1 - x;
  return x * x * (1 + 2 * y) + x * y * (y * rate_0_ - x * rate_1_);
}

Vector InterpolatedBranch::Piece::at(double x) const {
  Vector z = begin_;  // of a piece of no length
  if (std::isfinite(least_)) curve_.at(along(x), used_, z);
  return z;
}

Vector InterpolatedBranch::Piece::error(double x) const {
  if (!std::isfinite(least_)) return Vector::Zero(begin_.size());
  const double s = along(x);
  const double bulge = s * (1 - s);
  Vector last = bulge * bulge * curve_.cubic();
  if (used_ > 2) curve_.added(s, used_, last);
  return 1.5 * last.cwiseAbs();
}

InterpolatedBranch::~InterpolatedBranch() = default;

InterpolatedBranch::InterpolatedBranch(const Branch& branch, Index parameter, const Problem* problem)
    : branch_(branch), parameter_(parameter) {
  if (problem != nullptr) corrector_ = std::make_unique<Corrector>(*problem, parameter, CorrectorOptions{});
  if (branch.points.size() < 2)
    throw std::invalid_argument("InterpolatedBranch: a branch with two points at least is needed");
}

/// (u, p_a) of a point.
Vector InterpolatedBranch::position(std::size_t point) const {
  const BranchPoint& at = branch_.points[point];
  Vector z(at.unknowns.size() + 1);
  z << at.unknowns, at.parameters(parameter_);
  return z;
}

// Piece i lies between the points i and i + 1. Special points that fall together make pieces of no length.

const Vector& InterpolatedBranch::leaving(std::size_t piece) const { return branch_.points[piece].tangent; }

const Vector& InterpolatedBranch::arriving(std::size_t piece) const {
  return branch_.points[piece + 1].arriving();
}

double InterpolatedBranch::distance(std::size_t from, std::size_t to) const {
  return branch_.points[to].arclength - branch_.points[from].arclength;
}

bool InterpolatedBranch::is_corner(std::size_t point) const {
  return branch_.points[point].arrival.size() > 0;
}

/// The nearest points around a piece, one on each side, or two on one where there are none on the other, with
/// whether they are behind it. They are not so near to each other that differences would be lost in rounding;
/// none is beyond a corner, an end of the branch, or where unknowns mean something else.
std::vector<std::pair<std::size_t, bool>> InterpolatedBranch::around(std::size_t piece) const {
  constexpr double far_enough = 0.02;  // of the piece's length
  constexpr std::size_t wanted = 2;
  const double least = far_enough * distance(piece, piece + 1);
  std::array<std::size_t, 2> edges{piece, piece + 1};
  std::array<bool, 2> goes_on{true, true};
  std::vector<std::pair<std::size_t, bool>> found;
  const auto look = [&](std::size_t side) {
    const std::size_t last = side == 1 ? branch_.points.size() - 1 : 0;
    std::size_t point = edges[side];
    while (point != last && !is_corner(point)) {
      point = side == 1 ? point + 1 : point - 1;
      const BranchPoint& other = branch_.points[point];
      if (other.regime != branch_.points[piece].regime && other.type != PointType::regime_switch) break;
      if (std::abs(distance(edges[side], point)) < least) continue;
      edges[side] = point;
      found.emplace_back(point, side == 1);
      return;
    }
    goes_on[side] = false;
  };
  for (std::size_t side = 0; found.size() < wanted && (goes_on[0] || goes_on[1]); side = 1 - side) {
    if (goes_on[side]) look(side);
  }
  return found;
}

/// The corner before or behind a piece that is so near that the curve knows of it.
std::optional<std::size_t> InterpolatedBranch::corner(std::size_t piece, int way) const {
  constexpr double near = 4;  // times the piece's length
  const std::size_t edge = way > 0 ? piece + 1 : piece;
  const std::size_t last = way > 0 ? branch_.points.size() - 1 : 0;
  for (std::size_t point = edge;; point = way > 0 ? point + 1 : point - 1) {
    if (std::abs(distance(edge, point)) > near * distance(piece, piece + 1)) return std::nullopt;
    if (is_corner(point)) return point;
    if (point == last) return std::nullopt;
  }
}

Sample InterpolatedBranch::place(const Piece& curve, std::size_t piece, double x) const {
  const BranchPoint& from = branch_.points[piece];
  const Vector z = curve.at(x);
  const double s = from.arclength + x * distance(piece, piece + 1);
  Sample result{z.head(from.unknowns.size()), from.parameters, s, from.regime, {}};
  // Folds are points of the branch: between neighbours the parameter does not turn.
  const auto [low, high] =
      std::minmax(from.parameters(parameter_), branch_.points[piece + 1].parameters(parameter_));
  result.parameters(parameter_) = std::clamp(z(z.size() - 1), low, high);
  return result;
}

Sample InterpolatedBranch::place(std::size_t piece, double x) const { return place(curve(piece), piece, x); }

/// Samples of one piece mostly follow upon each other.
const InterpolatedBranch::Piece& InterpolatedBranch::curve(std::size_t piece) const {
  if (!last_ || last_->number() != piece) last_ = std::make_unique<Piece>(*this, piece);
  return *last_;
}

Sample InterpolatedBranch::between(std::size_t piece, double x) const {
  const Piece& curve = this->curve(piece);
  Sample result = place(curve, piece, x);
  result.error = curve.error(x);
  if (corrector_) solve(result, curve.at(x + 1e-4) - curve.at(x - 1e-4));
  return result;
}

double InterpolatedBranch::doubt(std::size_t piece) const { return curve(piece).least(); }

Sample InterpolatedBranch::at(double arclength) const {
  if (!(arclength >= begin() && arclength <= end())) {
    throw std::out_of_range(
        fmt::format("InterpolatedBranch: arclength {} is not between {} and {}", arclength, begin(), end()));
  }
  const auto beyond =
      std::upper_bound(branch_.points.begin() + 1, branch_.points.end() - 1, arclength,
                       [](double s, const BranchPoint& point) { return s < point.arclength; });
  const auto piece = static_cast<std::size_t>(beyond - branch_.points.begin()) - 1;
  const double h = distance(piece, piece + 1);
  return between(piece, h > 0 ? (arclength - branch_.points[piece].arclength) / h : 0);
}

std::vector<Sample> InterpolatedBranch::where(double value) const {
  std::vector<Sample> found;
  for (std::size_t piece = 0; piece + 1 < branch_.points.size(); ++piece) {
    if (!(distance(piece, piece + 1) > 0)) continue;
    const double first = branch_.points[piece].parameters(parameter_) - value;
    const double last = branch_.points[piece + 1].parameters(parameter_) - value;
    if (first == 0) found.push_back(between(piece, 0));
    if (last == 0 && piece + 2 == branch_.points.size()) found.push_back(between(piece, 1));
    if (!(first * last < 0)) continue;  // within a piece it does not turn
    const Piece& curve = this->curve(piece);
    const auto away = [&](double x) { return place(curve, piece, x).parameters(parameter_) - value; };
    const double x = zero_between(away, 0, 1, first, last);
    Sample& sample = found.emplace_back(place(curve, piece, x));
    sample.parameters(parameter_) = value;
    sample.error = curve.error(x);
    if (corrector_) solve(sample, Vector::Unit(sample.error.size(), sample.error.size() - 1));
  }
  return found;
}

std::vector<Sample> InterpolatedBranch::resample(std::size_t count) const {
  if (count < 2) throw std::invalid_argument("InterpolatedBranch: at least two samples are needed");
  std::vector<Sample> samples;
  samples.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i) / static_cast<double>(count - 1);
    samples.push_back(at(std::min(begin() + x * (end() - begin()), end())));
  }
  return samples;
}

}  // namespace arcslip::continuation
