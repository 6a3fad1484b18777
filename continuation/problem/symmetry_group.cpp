#include "arcslip/continuation/problem/symmetry_group.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>

#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

constexpr double rounding_of_maps = 1e-9;  // of products of a few maps

/// An orthonormal basis of the range of a projection, by Gram and Schmidt, each column twice.
SparseMatrix range_of(const Matrix& projection) {
  constexpr double plainly = 1e-3;  // left of a column of unit length: is not one of the others
  const Index n = projection.rows();
  const auto rank = static_cast<Index>(std::llround(projection.trace()));
  Matrix basis(n, rank);
  Index found = 0;
  for (Index j = 0; j < n && found < rank; ++j) {
    Vector column = projection.col(j);
    if (!(column.norm() > plainly)) continue;
    column.normalize();
    for (int i = 0; i < 2; ++i)
      column -= basis.leftCols(found) * (basis.leftCols(found).transpose() * column);
    if (!(column.norm() > plainly)) continue;
    basis.col(found++) = column.normalized();
  }
  return basis.leftCols(found).sparseView(1, rounding_of_maps);
}

/// The logarithm of the size of a determinant.
double log_size(const Matrix& matrix) { return pivots_of(matrix).sizes.array().log().sum(); }

}  // namespace

SymmetryGroup::SymmetryGroup(std::vector<Symmetry> symmetries)
    : size_(symmetries.empty() ? 0 : symmetries.front().map.rows()) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<Vector> images{Vector::NullaryExpr(size_, [&](Index) { return normal(random); })};
  const Vector first = images.front();
  const auto number_of = [&](const Vector& image) {
    const auto same = std::find_if(images.begin(), images.end(), [&](const Vector& other) {
      return (other - image).norm() <= rounding_of_maps * image.norm();
    });
    return static_cast<std::size_t>(same - images.begin());
  };
  for (Symmetry& symmetry : symmetries) {
    Vector image = symmetry.map * first;
    if (number_of(image) < images.size()) continue;  // two names of one map
    images.push_back(std::move(image));
    symmetries_.push_back(std::move(symmetry));
  }
  product_.assign(images.size(), std::vector<std::size_t>(images.size()));
  for (std::size_t i = 0; i < images.size(); ++i) {
    for (std::size_t j = 0; j < images.size(); ++j) {
      product_[i][j] = i == 0 ? j : number_of(symmetries_[i - 1].map * images[j]);
      if (product_[i][j] == images.size())
        throw std::logic_error(
            fmt::format("the symmetries of a problem are no group: \"{}\" after \"{}\" is none of them",
                        symmetries_[i - 1].name, symmetries_[j - 1].name));
    }
  }
}

Subgroup SymmetryGroup::kept(const Vector& u, const Vector& scale, double tolerance) const {
  const std::vector<bool> has = kept_symmetries(symmetries_, u, scale, tolerance);
  Subgroup found{0};
  for (std::size_t i = 0; i < has.size(); ++i) {
    if (has[i]) found.push_back(i + 1);
  }
  return generated(std::move(found));
}

Subgroup SymmetryGroup::common(const Subgroup& a, const Subgroup& b) {
  Subgroup both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

SparseMatrix SymmetryGroup::map(std::size_t element) const {
  if (element > 0) return symmetries_[element - 1].map;
  SparseMatrix identity(size_, size_);
  identity.setIdentity();
  return identity;
}

SparseMatrix SymmetryGroup::projection(const Subgroup& of) const {
  SparseMatrix sum(size_, size_);
  for (const std::size_t element : of) sum += map(element);
  sum *= 1 / static_cast<double>(of.size());
  sum.prune(1, rounding_of_maps);
  return sum;
}

std::size_t SymmetryGroup::inverse(std::size_t element) const {
  const auto& row = product_[element];
  return static_cast<std::size_t>(std::find(row.begin(), row.end(), 0) - row.begin());
}

/// The least subgroup with these elements.
Subgroup SymmetryGroup::generated(Subgroup by) const {
  std::set<std::size_t> found(by.begin(), by.end());
  found.insert(0);
  for (std::vector<std::size_t> fresh(found.begin(), found.end()); !fresh.empty();) {
    const std::size_t one = fresh.back();
    fresh.pop_back();
    for (const std::size_t other : by) {
      if (found.insert(product_[one][other]).second) fresh.push_back(product_[one][other]);
    }
  }
  return {found.begin(), found.end()};
}

Subgroup SymmetryGroup::squares(const Subgroup& of) const {
  Subgroup all;
  for (const std::size_t element : of) all.push_back(product_[element][element]);
  return generated(std::move(all));
}

/// The subgroups of half as many elements: those on which a product of signs, one for each of some elements
/// that make up the rest of the group, is 1.
std::vector<Subgroup> SymmetryGroup::halves(const Subgroup& of) const {
  std::vector<std::optional<unsigned>> signs(order());
  Subgroup known = squares(of);
  for (const std::size_t element : known) signs[element] = 0;
  unsigned count = 0;
  for (const std::size_t element : of) {
    if (signs[element]) continue;
    for (const std::size_t one : Subgroup(known)) {
      const std::size_t other = product_[one][element];
      signs[other] = *signs[one] | (1U << count);
      known.push_back(other);
    }
    ++count;
  }
  std::vector<Subgroup> all;
  for (unsigned chosen = 1; chosen < (1U << count); ++chosen) {
    Subgroup& half = all.emplace_back();
    for (const std::size_t element : of) {
      if (std::popcount(*signs[element] & chosen) % 2 == 0) half.push_back(element);
    }
  }
  return all;
}

/// Elements that are their own inverses but do not commute with all others, one of each class of images.
std::vector<std::size_t> SymmetryGroup::mirrors(const Subgroup& of) const {
  std::vector<std::size_t> found;
  for (const std::size_t element : of) {
    if (element == 0 || product_[element][element] != 0) continue;
    std::size_t first = element;
    for (const std::size_t by : of) first = std::min(first, product_[product_[by][element]][inverse(by)]);
    const bool commutes = std::all_of(of.begin(), of.end(), [&](std::size_t other) {
      return product_[element][other] == product_[other][element];
    });
    if (!commutes && first == element) found.push_back(element);
  }
  return found;
}

/// A matrix that commutes with a subgroup, else any.
Matrix SymmetryGroup::commuting(const Subgroup& of) const {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const Matrix any = Matrix::NullaryExpr(size_, size_, [&](Index, Index) { return normal(random); });
  Matrix sum = Matrix::Zero(size_, size_);
  for (const std::size_t element : of) sum += map(element) * any * map(inverse(element));
  return sum;
}

std::vector<Breaking> SymmetryGroup::breakings(const Subgroup& of) const {
  constexpr double same = 1e-6;  // of logarithms of determinants: more than their rounding
  std::vector<Breaking> all;
  const Matrix fixed = projection(of);
  for (Subgroup& half : halves(of)) {
    SparseMatrix space = range_of(Matrix(projection(half)) - fixed);
    if (space.cols() > 0) all.push_back({{std::move(half)}, std::move(space)});
  }
  const std::vector<std::size_t> elements = mirrors(of);
  if (elements.empty()) return all;
  // What the products of signs above act on is not looked at again.
  const Matrix others = Matrix::Identity(size_, size_) - projection(squares(of));
  const Matrix any = commuting(of);
  std::vector<std::pair<std::size_t, double>> sizes;  // of the breakings by mirrors
  for (const std::size_t element : elements) {
    const Subgroup both{0, element};
    SparseMatrix space = range_of(projection(both) * others);
    if (space.cols() == 0) continue;
    const double size = log_size(space.transpose() * (any * space));
    // Mirrors under which the same null vectors have a line each break at the same points.
    const auto known = std::find_if(sizes.begin(), sizes.end(), [&](const auto& other) {
      return all[other.first].space.cols() == space.cols() &&
             std::abs(other.second - size) <= same * std::max(1.0, std::abs(size));
    });
    if (known != sizes.end()) {
      all[known->first].kept.push_back(both);
      continue;
    }
    sizes.emplace_back(all.size(), size);
    all.push_back({{both}, std::move(space)});
  }
  return all;
}

}  // namespace arcslip::continuation
