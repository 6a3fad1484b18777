#include "arcslip/continuation/path/interpolation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {

/// On [0, 1], by its values z_0, z_1 and its slopes there, d_0 = a_0 t_0 and d_1 = a_1 t_1.
struct InterpolatedBranch::Cubic {
  Vector z_0, z_1, d_0, d_1;

  Vector at(double x) const {
    const double y = 1 - x;
    return y * y * (1 + 2 * x) * z_0 + x * x * (1 + 2 * y) * z_1 + x * y * (y * d_0 - x * d_1);
  }
  Vector slope(double x) const {
    const double y = 1 - x;
    return 6 * x * y * (z_1 - z_0) + y * (y - 2 * x) * d_0 + x * (x - 2 * y) * d_1;
  }
  Vector third_derivative() const { return 12 * (z_0 - z_1) + 6 * (d_0 + d_1); }

  /// How far it goes, by entries, of which those that hardly change are rounding.
  Vector sizes() const {
    constexpr double hardly = 1e-6;
    Vector all = (z_1 - z_0).cwiseAbs().cwiseMax(d_0.cwiseAbs()).cwiseMax(d_1.cwiseAbs());
    auto unknowns = all.head(all.size() - 1);
    unknowns = unknowns.cwiseMax(hardly * unknowns.maxCoeff());
    all(all.size() - 1) = std::max(all(all.size() - 1), rounding());
    return all;
  }
  double rounding() const { return 1e-12 * std::abs(z_0(z_0.size() - 1)); }  // of the parameter
  void fit();
  void keep_way();
};

namespace {

/// 1/size^2, such that the parameter counts as much as all unknowns.
Vector weights(const Vector& sizes) {
  const Index n = sizes.size() - 1;
  Vector all = (sizes.array() > 0).select(sizes.array().square().inverse(), 0.0);
  all.head(n) /= static_cast<double>(std::max<Index>(1, n));
  return all;
}

}  // namespace

/// Scales the slopes such that the third derivative is least.
void InterpolatedBranch::Cubic::fit() {
  // Where the ends turn by less than about 0.03 any lengths will do, and rounding would decide.
  constexpr double straight = 1e-3;
  const Vector weight = weights(sizes());
  const auto product = [&](const Vector& a, const Vector& b) {
    return (weight.array() * a.array() * b.array()).sum();
  };
  const Vector twice = 2 * (z_1 - z_0);
  const double a = straight + product(d_0, d_0);
  const double b = product(d_0, d_1);
  const double c = straight + product(d_1, d_1);
  const double d = straight + product(d_0, twice);
  const double e = straight + product(d_1, twice);
  double first = (d * c - e * b) / (a * c - b * b);
  double second = (a * e - b * d) / (a * c - b * b);
  if (first < 0) {
    first = 0;
    second = e / c;
  } else if (second < 0) {
    second = 0;
    first = d / a;
  }
  d_0 *= std::max(first, 0.0);
  d_1 *= std::max(second, 0.0);
}

/// Folds are points of the branch: between neighbours the parameter does not turn, nor does that of a cubic
/// with slopes of at most three times its change [Fritsch and Carlson 1980].
void InterpolatedBranch::Cubic::keep_way() {
  const Index n = z_0.size() - 1;
  const double most = 3 * std::max(std::abs(z_1(n) - z_0(n)), rounding());
  for (Vector* slope : {&d_0, &d_1})
    if (std::abs((*slope)(n)) > most) *slope *= most / std::abs((*slope)(n));
}

InterpolatedBranch::InterpolatedBranch(const Branch& branch, Index parameter)
    : branch_(branch), parameter_(parameter) {
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

/// From one point to a later one.
InterpolatedBranch::Cubic InterpolatedBranch::cubic(std::size_t from, std::size_t to) const {
  const double h = distance(from, to);
  Cubic cubic{position(from), position(to), h * leaving(from), h * arriving(to - 1)};
  const bool neighbours = to == from + 1;
  if (neighbours) cubic.keep_way();
  cubic.fit();
  if (neighbours) cubic.keep_way();
  return cubic;
}

bool InterpolatedBranch::is_corner(std::size_t point) const {
  return branch_.points[point].arrival.size() > 0;
}

/// The nearest point before (`way` -1) or behind a piece (1) that is not so near to it that differences to it
/// would be lost in rounding; none beyond a corner or an end of the branch.
std::optional<std::size_t> InterpolatedBranch::neighbour(std::size_t piece, int way) const {
  constexpr double far_enough = 0.2;  // of the piece's length
  const std::size_t edge = way > 0 ? piece + 1 : piece;
  const std::size_t last = way > 0 ? branch_.points.size() - 1 : 0;
  for (std::size_t point = edge; point != last && !is_corner(point);) {
    point = way > 0 ? point + 1 : point - 1;
    if (std::abs(distance(edge, point)) >= far_enough * distance(piece, piece + 1)) return point;
  }
  return std::nullopt;
}

/// By how much the cubic from one point to another misses a point in between, across itself; over (x y)^2 at
/// that point, with which the error goes.
Vector InterpolatedBranch::missed(std::size_t from, std::size_t point, std::size_t to) const {
  const Cubic whole = cubic(from, to);
  const Vector weight = weights(whole.sizes());
  const double place = distance(from, point) / distance(from, to);
  double x = place;
  double shift = 0;
  Vector away, slope;
  for (int i = 0; i < 3; ++i) {
    x = std::clamp(x + shift, 0.0, 1.0);
    away = position(point) - whole.at(x);
    slope = whole.slope(x);
    shift = weight.cwiseProduct(away).dot(slope) / weight.cwiseProduct(slope).dot(slope);
  }
  const double bulge = place * (1 - place);
  return (away - shift * slope).cwiseAbs() / (bulge * bulge);
}

/// The error of a piece over (x y)^2: half as much again as the larger of what the cubics over the piece and
/// a neighbour miss of the point between, over the fourth power of their lengths, or as twice the cubic's own
/// last term, since both sides may miss what lies in between.
Vector InterpolatedBranch::error(std::size_t piece, const Cubic& cubic) const {
  Vector most = cubic.third_derivative().cwiseAbs() / 12;
  for (const int way : {-1, 1}) {
    const auto other = neighbour(piece, way);
    if (!other) continue;
    const std::size_t from = way > 0 ? piece : *other;
    const std::size_t to = way > 0 ? *other : piece + 1;
    const double shorter = distance(piece, piece + 1) / distance(from, to);
    const Vector estimate = std::pow(shorter, 4) * missed(from, way > 0 ? piece + 1 : piece, to);
    if (estimate.allFinite()) most = most.cwiseMax(estimate);
  }
  return 1.5 * most;
}

Sample InterpolatedBranch::place(const Cubic& cubic, std::size_t piece, double x) const {
  const BranchPoint& from = branch_.points[piece];
  const Vector z = cubic.at(x);
  const double s = from.arclength + x * distance(piece, piece + 1);
  Sample result{z.head(from.unknowns.size()), from.parameters, s, from.regime, {}};
  result.parameters(parameter_) = z(z.size() - 1);
  return result;
}

Sample InterpolatedBranch::place(std::size_t piece, double x) const {
  return place(cubic(piece, piece + 1), piece, x);
}

Sample InterpolatedBranch::between(std::size_t piece, double x) const {
  const Cubic cubic = this->cubic(piece, piece + 1);
  Sample result = place(cubic, piece, x);
  result.error = Vector::Zero(cubic.z_0.size());
  const double h = distance(piece, piece + 1);
  if (!(h > 0)) return result;
  const double bulge = x * (1 - x);
  const Vector most = h * leaving(piece).cwiseAbs().cwiseMax(arriving(piece).cwiseAbs());
  result.error = (bulge * bulge * error(piece, cubic)).cwiseMin(most);
  return result;
}

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
    const Cubic curve = cubic(piece, piece + 1);
    const auto away = [&](double x) { return curve.at(x)(curve.z_0.size() - 1) - value; };
    found.push_back(between(piece, zero_between(away, 0, 1, first, last)));
    found.back().parameters(parameter_) = value;
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
