#include "arcslip/sectors/sector_reduction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "sectors/cholesky.hpp"

namespace arcslip {
namespace {

/// Every entry that one of the matrices has, reduced.
ComplexSparseMatrix common_pattern(const FiniteSector& sector, const SectorMap& map) {
  std::vector<Eigen::Triplet<Complex>> entries;
  for (const SparseMatrix* matrix :
       {&sector.mass, &sector.stiffness, &sector.damping, &sector.gyroscopic, &sector.stiffness_speed2}) {
    for (Index j = 0; j < matrix->outerSize(); ++j) {
      for (SparseMatrix::InnerIterator entry(*matrix, j); entry; ++entry) {
        entries.emplace_back(map.reduced[static_cast<std::size_t>(entry.row())],
                             map.reduced[static_cast<std::size_t>(j)], 0.0);
      }
    }
  }
  ComplexSparseMatrix pattern(map.size, map.size);
  pattern.setFromTriplets(entries.begin(), entries.end());
  return pattern;
}

/// A row at which the mass, or so much less of its diagonal, is not positive definite.
template <class Scalar>
std::optional<Index> indefinite_row(Eigen::SparseMatrix<Scalar> mass) {
  constexpr double margin = 1e-12;
  for (Index j = 0; j < mass.cols(); ++j) {
    for (typename Eigen::SparseMatrix<Scalar>::InnerIterator entry(mass, j); entry; ++entry)
      if (entry.row() == j) entry.valueRef() *= 1 - margin;
  }
  Cholesky<Scalar> factors(mass);
  if (factors.factor(mass)) return std::nullopt;
  return factors.indefinite_at();
}

}  // namespace

SectorReduction::SectorReduction(const FiniteSector& sector)
    : map_(sector_map(sector)), sector_load_(sector.load), load_(map_.size) {
  const ComplexSparseMatrix pattern = common_pattern(sector, map_);
  mass_ = part(sector.mass, pattern);
  stiffness_ = part(sector.stiffness, pattern);
  if (sector.damping.size() != 0) damping_ = part(sector.damping, pattern);
  if (sector.gyroscopic.size() != 0) gyroscopic_ = part(sector.gyroscopic, pattern);
  if (sector.stiffness_speed2.size() != 0) stiffness_speed2_ = part(sector.stiffness_speed2, pattern);
  set_forward(1);
}

SectorReduction::Part SectorReduction::part(const SparseMatrix& matrix,
                                            const ComplexSparseMatrix& pattern) const {
  Part part;
  part.reduced = pattern;
  part.within.resize(static_cast<std::size_t>(pattern.nonZeros()));
  for (Index j = 0; j < matrix.outerSize(); ++j) {
    const auto column = static_cast<std::size_t>(j);
    const int* rows = pattern.innerIndexPtr();
    const int* begin = rows + pattern.outerIndexPtr()[map_.reduced[column]];
    const int* end = rows + pattern.outerIndexPtr()[map_.reduced[column] + 1];
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      const auto row = static_cast<std::size_t>(entry.row());
      const auto place = std::lower_bound(begin, end, map_.reduced[row]) - rows;
      if (map_.is_right[row] == map_.is_right[column]) {
        part.within[static_cast<std::size_t>(place)] += entry.value();
      } else {
        part.couplings.push_back({static_cast<int>(place), map_.is_right[column] != 0, entry.value()});
      }
    }
  }
  return part;
}

void SectorReduction::reduce(Part& part) const {
  Complex* values = part.reduced.valuePtr();
  std::copy(part.within.begin(), part.within.end(), values);
  const Complex backward = std::conj(forward_);
  for (const Coupling& c : part.couplings) values[c.entry] += c.value * (c.ahead ? forward_ : backward);
}

void SectorReduction::set_forward(Complex forward) {
  forward_ = forward;
  reduce(mass_);
  reduce(stiffness_);
  reduce(damping_);
  reduce(gyroscopic_);
  reduce(stiffness_speed2_);
  load_.setZero();
  for (Index dof = 0; dof < sector_load_.size(); ++dof) {
    load_(reduced_dof(dof)) += std::conj(factor(dof)) * sector_load_(dof);
  }
}

double largest_square(const SectorReduction& reduction) {
  const auto stiffness = reduction.stiffness().diagonal().real().array();
  return (stiffness / reduction.mass().diagonal().real().array()).maxCoeff();
}

void check_mass(const FiniteSector& sector, const SectorReduction& reduction) {
  // What is positive for all motions is so for those of a wave; real numbers cost a quarter.
  if (!indefinite_row(sector.mass)) return;
  const auto row = indefinite_row(reduction.mass());
  if (!row) return;
  const auto boundary = std::ssize(sector.left);
  const Index dof = *row < boundary ? sector.left[static_cast<std::size_t>(*row)]
                                    : sector.interior[static_cast<std::size_t>(*row - boundary)];
  throw SectorError(fmt::format("the mass matrix is not positive definite, as seen at dof {}", dof + 1));
}

}  // namespace arcslip
