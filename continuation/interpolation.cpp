#include "arcslip/continuation/interpolation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arcslip/zero_between.hpp"

namespace arcslip::continuation {

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
  const BranchPoint& point = branch_.points[piece + 1];
  return point.arrival.size() > 0 ? point.arrival : point.tangent;
}

double InterpolatedBranch::length(std::size_t piece) const {
  return branch_.points[piece + 1].arclength - branch_.points[piece].arclength;
}

Vector InterpolatedBranch::third_derivative(std::size_t piece) const {
  const double h = length(piece);
  return (12 / (h * h * h)) * (position(piece) - position(piece + 1)) +
         (6 / (h * h)) * (leaving(piece) + arriving(piece));
}

/// Whether the curve goes on smoothly from a piece to the next one.
bool InterpolatedBranch::smooth_between(std::size_t piece) const {
  const BranchPoint& between = branch_.points[piece + 1];
  return between.arrival.size() == 0 && length(piece) > 0 && length(piece + 1) > 0;
}

/// The larger of its estimates from both neighbours, by entries; where there is none, what makes the error as
/// large as the cubic's own last term.
Vector InterpolatedBranch::fourth_derivative(std::size_t piece) const {
  const Vector third = third_derivative(piece);
  Vector fourth = Vector::Zero(third.size());
  bool known = false;
  const auto compare = [&](std::size_t other) {
    const double apart = 0.5 * (length(piece) + length(other));
    fourth = fourth.cwiseMax((third_derivative(other) - third).cwiseAbs() / apart);
    known = true;
  };
  if (piece > 0 && smooth_between(piece - 1)) compare(piece - 1);
  if (piece + 2 < branch_.points.size() && smooth_between(piece)) compare(piece + 1);
  return known ? fourth : Vector(third.cwiseAbs() / length(piece));
}

Sample InterpolatedBranch::sample(std::size_t piece, double x) const {
  const BranchPoint& from = branch_.points[piece];
  const double h = length(piece);
  const double y = 1 - x;
  const Vector z = position(piece) * (y * y * (1 + 2 * x)) + position(piece + 1) * (x * x * (1 + 2 * y)) +
                   h * (x * y * y * leaving(piece) - x * x * y * arriving(piece));
  Sample result{z.head(from.unknowns.size()), from.parameters, from.arclength + x * h, from.regime, {}};
  result.parameters(parameter_) = z(z.size() - 1);
  result.error = Vector::Zero(z.size());
  if (h > 0) result.error = fourth_derivative(piece) * (x * x * y * y * h * h * h * h / 24);
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
  const double h = length(piece);
  return sample(piece, h > 0 ? (arclength - branch_.points[piece].arclength) / h : 0);
}

std::vector<Sample> InterpolatedBranch::where(double value) const {
  std::vector<Sample> found;
  for (std::size_t piece = 0; piece + 1 < branch_.points.size(); ++piece) {
    if (!(length(piece) > 0)) continue;
    const Index last_entry = leaving(piece).size() - 1;
    const double from = branch_.points[piece].parameters(parameter_);
    const double to = branch_.points[piece + 1].parameters(parameter_);
    const double rate_from = length(piece) * leaving(piece)(last_entry);
    const double rate_to = length(piece) * arriving(piece)(last_entry);
    const auto away = [&](double x) {
      const double y = 1 - x;
      return (from - value) * y * y * (1 + 2 * x) + (to - value) * x * x * (1 + 2 * y) +
             x * y * (y * rate_from - x * rate_to);
    };
    const double first = from - value;
    const double last = to - value;
    if (first == 0) found.push_back(sample(piece, 0));
    if (last == 0 && piece + 2 == branch_.points.size()) found.push_back(sample(piece, 1));
    if (!(first * last < 0)) continue;  // folds are points of the branch: within a piece it does not turn
    found.push_back(sample(piece, zero_between(away, 0, 1, first, last)));
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
