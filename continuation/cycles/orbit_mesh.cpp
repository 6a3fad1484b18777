#include "arcslip/continuation/cycles/orbit_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace arcslip::continuation {
namespace {

double power(double x, Index n) {
  double result = 1;
  for (; n > 0; --n) result *= x;
  return result;
}

}  // namespace

Vector ranges(const Eigen::Ref<const Matrix>& orbit, const Vector& scale) {
  constexpr double least = 1e-3;
  constexpr double at_rest = 1e-7;  // of the scale: of less a millionth is rounding
  const Vector range = (orbit.rowwise().maxCoeff() - orbit.rowwise().minCoeff()).cwiseQuotient(scale);
  const double largest = range.maxCoeff();
  return largest > 0 ? range.cwiseMax(std::max(least * largest, at_rest)).cwiseProduct(scale) : scale;
}

OrbitMesh::OrbitMesh(const CollocationRule& rule, Vector borders)
    : rule_(rule), borders_(std::move(borders)) {
  if (rule_.waves() == 0) equal_ = find(Vector::LinSpaced(2 * intervals() + 1, 0, 1));
}

double OrbitMesh::place(Index node) const {
  const Index j = std::min(node / rule_.degree(), intervals() - 1);
  return borders_(j) + length(j) * rule_.nodes()(node - j * rule_.degree());
}

Vector OrbitMesh::places() const {
  Vector s(nodes());
  for (Index node = 0; node < s.size(); ++node) s(node) = place(node);
  return s;
}

Index OrbitMesh::interval(double s) const {
  const auto* beyond = std::upper_bound(borders_.data(), borders_.data() + borders_.size(), s);
  return std::clamp<Index>(beyond - borders_.data() - 1, 0, intervals() - 1);
}

void OrbitMesh::at(const Matrix& values, double s, Vector& value, Vector* velocity) const {
  const Index j = interval(s);
  Vector weights;
  Vector slopes;
  rule_.at((s - borders_(j)) / length(j), weights, velocity == nullptr ? nullptr : &slopes);
  const auto within = values.middleCols(j * rule_.degree(), rule_.degree() + 1);
  value.noalias() = within * weights;
  if (velocity != nullptr) velocity->noalias() = within * (slopes / length(j));
}

Vector OrbitMesh::gauss_points() const {
  const Index m = rule_.degree();
  Vector s(m * intervals());
  for (Index j = 0; j < intervals(); ++j)
    s.segment(j * m, m) = borders_(j) + length(j) * rule_.points().array();
  return s;
}

OrbitPlaces OrbitMesh::find(const Vector& s) const {
  OrbitPlaces places{s, {}, Matrix(rule_.degree() + 1, s.size())};
  places.first.reserve(static_cast<std::size_t>(s.size()));
  Vector weights;
  for (Index k = 0; k < s.size(); ++k) {
    const Index j = interval(s(k));
    rule_.at((s(k) - borders_(j)) / length(j), weights);
    places.weights.col(k) = weights;
    places.first.push_back(j * rule_.degree());
  }
  return places;
}

Matrix OrbitMesh::at(const Eigen::Ref<const Matrix>& values, const OrbitPlaces& places) const {
  const Index n = values.rows();
  const Index stride = values.outerStride();
  Matrix result(n, places.weights.cols());
  with_degree(rule_.degree(), [&](auto degree) {
    for (Index k = 0; k < result.cols(); ++k) {
      const double* const weights = places.weights.col(k).data();
      const double* const nodes = values.col(places.first[static_cast<std::size_t>(k)]).data();
      double* const to = result.col(k).data();
      Index r = 0;
      for (; r + 1 < n; r += 2) {  // at once
        double first = 0;
        double second = 0;
        for (Index l = 0; l <= degree; ++l) {
          first += weights[l] * nodes[l * stride + r];
          second += weights[l] * nodes[l * stride + r + 1];
        }
        to[r] = first;
        to[r + 1] = second;
      }
      if (r == n) continue;
      double sum = 0;
      for (Index l = 0; l <= degree; ++l) sum += weights[l] * nodes[l * stride + r];
      to[r] = sum;
    }
  });
  return result;
}

Matrix OrbitMesh::carried(const Matrix& values, const OrbitMesh& to) const {
  Matrix result = at(values, find(to.places()));
  result.col(0) = values.col(0);
  result.rightCols(1) = values.rightCols(1);
  return result;
}

/// Of order m + 1 on each interval, in units of the scale: by how the m-th jumps at its ends, an orbit being
/// periodic or not: a jump across the ends counts as the one beside it does.
Vector OrbitMesh::highest_derivatives(const Eigen::Ref<const Matrix>& values, const Vector& scale) const {
  const Index m = rule_.degree();
  const Index count = intervals();
  Matrix of_degree(values.rows(), count);
  for (Index j = 0; j < count; ++j) {
    of_degree.col(j) = values.middleCols(j * m, m + 1).lazyProduct(rule_.highest()).cwiseQuotient(scale) /
                       power(length(j), m);
  }
  Vector at_borders(count + 1);
  for (Index j = 1; j < count; ++j) {
    at_borders(j) = (of_degree.col(j) - of_degree.col(j - 1)).lpNorm<Eigen::Infinity>() /
                    (0.5 * (length(j) + length(j - 1)));
  }
  at_borders(0) = at_borders(std::min<Index>(1, count - 1));
  at_borders(count) = at_borders(std::max<Index>(count - 1, 1));
  return at_borders.head(count).cwiseMax(at_borders.tail(count));
}

Vector OrbitMesh::errors(const Eigen::Ref<const Matrix>& values, const Vector& scale) const {
  if (const Index waves = rule_.waves(); waves > 0) {
    const Index last = std::min(std::max<Index>(1, waves - 1), std::max<Index>(3, waves / 6));
    const Matrix coefficients = rule_.coefficients(values).rightCols(2 * last);
    Vector sums = Vector::Zero(values.rows());
    for (Index h = 0; h < last; ++h) sums += coefficients.middleCols(2 * h, 2).rowwise().norm();
    return Vector::Constant(1, sums.cwiseQuotient(scale).maxCoeff());
  }
  const Index order = rule_.degree() + 1;
  Vector result = highest_derivatives(values, scale) * (rule_.product() / std::tgamma(order + 1));
  for (Index j = 0; j < intervals(); ++j) result(j) *= power(length(j), order);
  return result;
}

/// How densely intervals are to lie, constant between borders from 0 to 1.
struct OrbitMesh::Density {
  std::vector<double> borders;
  std::vector<double> values;

  double at(double s) const {
    const auto beyond = std::upper_bound(borders.begin() + 1, borders.end() - 1, s);
    return values[static_cast<std::size_t>(beyond - borders.begin()) - 1];
  }
  double mean() const {
    double sum = 0;
    for (std::size_t j = 0; j < values.size(); ++j) sum += values[j] * (borders[j + 1] - borders[j]);
    return sum;
  }
};

namespace {

/// What takes an orbit's places to those where it is the same but for signs or the order of unknowns.
struct PlaceSymmetry {
  double (*place)(double);
  Index intervals;  ///< their number in meshes that have it is a multiple of this one
};

constexpr std::array<PlaceSymmetry, 2> symmetries{{
    {[](double s) { return s < 0.5 ? s + 0.5 : s - 0.5; }, 2},
    {[](double s) { return 1 - s; }, 1},
}};

/// The larger density of those at a place and where a symmetry takes it to.
template <class Density>
Density joined(const Density& density, const PlaceSymmetry& symmetry) {
  Density both{density.borders, {}};
  std::vector<double>& borders = both.borders;
  for (const double border : density.borders) borders.push_back(symmetry.place(border));
  std::sort(borders.begin(), borders.end());
  borders.erase(std::unique(borders.begin(), borders.end()), borders.end());
  for (std::size_t j = 0; j + 1 < borders.size(); ++j) {
    const double s = 0.5 * (borders[j] + borders[j + 1]);
    both.values.push_back(std::max(density.at(s), density.at(symmetry.place(s))));
  }
  return both;
}

/// By how much the ways that an orbit goes in equal parts of its time, with values at their ends, differ from
/// those where a symmetry takes these to: 0 to 1.
double asymmetry(const Matrix& at, const Vector& scale, const PlaceSymmetry& symmetry) {
  const Index count = at.cols() - 1;
  const Matrix ways = scale.cwiseInverse().asDiagonal() * (at.rightCols(count) - at.leftCols(count));
  const Vector lengths = ways.colwise().norm();
  double difference = 0;
  for (Index k = 0; k < count; ++k) {
    const double middle = symmetry.place((static_cast<double>(k) + 0.5) / static_cast<double>(count));
    difference += std::abs(lengths(k) - lengths(static_cast<Index>(middle * static_cast<double>(count))));
  }
  return 0.5 * difference / lengths.sum();
}

}  // namespace

OrbitMesh::Density OrbitMesh::density(const Matrix& values, const Vector& scale) const {
  constexpr double least = 0.2;   // of the mean density: what is smooth now may not be at the next point
  constexpr double graded = 0.5;  // of the density next to it: no interval is much longer than its neighbour
  const Index count = this->intervals();
  Vector density = highest_derivatives(values, scale).array().pow(1.0 / (rule_.degree() + 1));
  for (Index j = 1; j < count; ++j) density(j) = std::max(density(j), graded * density(j - 1));
  for (Index j = count - 1; j-- > 0;) density(j) = std::max(density(j), graded * density(j + 1));
  const double mean = density.dot(borders_.tail(count) - borders_.head(count));
  density = density.cwiseMax(least * mean);
  return {{borders_.begin(), borders_.end()}, {density.begin(), density.end()}};
}

OrbitMesh OrbitMesh::equidistributed(const Matrix& values, const Vector& scale, Index resolution,
                                     MeshSymmetry symmetry) const {
  if (rule_.waves() > 0) return {CollocationRule::trigonometric(static_cast<int>(resolution)), 1};
  constexpr double nearly = 0.12;  // of an asymmetry between 0 and 1
  Density density = this->density(values, scale);
  if (!(density.mean() > 0)) return {rule_, resolution};
  const Matrix in_equal_parts = at(values, equal_);
  for (const PlaceSymmetry& other : symmetries) {
    if (symmetry == MeshSymmetry::none || resolution % other.intervals != 0) continue;
    if (asymmetry(in_equal_parts, scale, other) < nearly) density = joined(density, other);
  }
  const double each = density.mean() / static_cast<double>(resolution);
  Vector borders(resolution + 1);
  std::size_t j = 0;
  double before = 0;  // intervals up to the density's border j
  for (Index i = 0; i <= resolution; ++i) {
    const double wanted = each * static_cast<double>(i);
    const auto of_piece = [&] { return density.values[j] * (density.borders[j + 1] - density.borders[j]); };
    for (; j + 1 < density.values.size() && before + of_piece() < wanted; ++j) before += of_piece();
    borders(i) = density.borders[j] + (wanted - before) / density.values[j];
  }
  borders(0) = 0;
  borders(resolution) = 1;
  return {rule_, borders};
}

bool OrbitMesh::is_lopsided(const Matrix& values, const Vector& scale) const {
  if (rule_.waves() > 0) return false;
  constexpr double nearly = 0.1;   // less than what makes meshes symmetric
  constexpr double equal = 1e-12;  // of a period: rounding
  const auto has = [&](double s) {
    const auto beyond = std::lower_bound(borders_.begin(), borders_.end(), s - equal);
    return beyond != borders_.end() && *beyond < s + equal;
  };
  return std::any_of(symmetries.begin(), symmetries.end(), [&](const PlaceSymmetry& symmetry) {
    return intervals() % symmetry.intervals == 0 &&
           !std::all_of(borders_.begin(), borders_.end(), [&](double s) { return has(symmetry.place(s)); }) &&
           asymmetry(at(values, equal_), scale, symmetry) < nearly;
  });
}

}  // namespace arcslip::continuation
