#include "arcslip/sectors/finite_sector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

namespace arcslip {
namespace {

template <class... Arguments>
[[noreturn]] void fail(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  throw SectorError(fmt::format(text, std::forward<Arguments>(arguments)...));
}

void check_sizes(const FiniteSector& sector) {
  const Index n = sector.mass.rows();
  const auto check = [&](const SparseMatrix& matrix, const char* name) {
    if (matrix.rows() == n && matrix.cols() == n) return;
    fail("the {} matrix has {} rows and {} columns, expected {} of each as the mass matrix has rows", name,
         matrix.rows(), matrix.cols(), n);
  };
  if (n == 0) fail("the mass matrix is empty, expected at least one dof");
  check(sector.mass, "mass");
  check(sector.stiffness, "stiffness");
  if (sector.damping.size() != 0) check(sector.damping, "damping");
  if (sector.gyroscopic.size() != 0) check(sector.gyroscopic, "gyroscopic");
  if (sector.stiffness_speed2.size() != 0) check(sector.stiffness_speed2, "stiffness_speed2");
  if (sector.load.size() != n) {
    fail("the load has {} entries, expected {}, one for each dof", sector.load.size(), n);
  }
  for (Index i = 0; i < n; ++i) {
    if (!std::isfinite(sector.load(i).real()) || !std::isfinite(sector.load(i).imag())) {
      fail("the load of dof {} is not finite", i + 1);
    }
  }
}

/// Which list each dof is in; null where in none.
class Places {
 public:
  explicit Places(Index size) : name_(static_cast<std::size_t>(size), nullptr) {}

  void add(const std::vector<Index>& dofs, const char* name) {
    for (const Index dof : dofs) {
      check_range(dof, name);
      const char*& place = name_[static_cast<std::size_t>(dof)];
      if (place == name) fail("dof {} is listed twice in {}", dof + 1, name);
      if (place != nullptr) fail("dof {} is in {} and in {}", dof + 1, place, name);
      place = name;
    }
  }

  void check_range(Index dof, const char* name) const {
    const Index size = std::ssize(name_);
    if (dof < 0 || dof >= size) fail("expected dofs from 1 to {} in {}, got {}", size, name, dof + 1);
  }

  const char* of(Index dof) const { return name_[static_cast<std::size_t>(dof)]; }

 private:
  std::vector<const char*> name_;
};

constexpr const char* right_name = "the right boundary";

void check_contacts(const FiniteSector& sector, const Places& places) {
  constexpr const char* name = "the contact dofs";
  std::set<std::pair<Index, Index>> met;
  const auto check = [&](Index dof) {
    places.check_range(dof, name);
    if (places.of(dof) == right_name)
      fail("contact dof {} is on the right boundary, expected its pair on the left one", dof + 1);
  };
  for (std::size_t i = 0; i < sector.contacts.size(); ++i) {
    const Index dof = sector.contacts[i];
    const Index other = sector.against_of(i);
    check(dof);
    if (other != FiniteSector::ground) check(other);
    if (dof == other) fail("the contact of dof {} is against this dof itself, expected another one", dof + 1);
    if (met.insert(std::minmax(dof, other)).second) continue;
    if (other == FiniteSector::ground) fail("dof {} is listed twice in {}", dof + 1, name);
    fail("dofs {} and {} are listed twice in {}", dof + 1, other + 1, name);
  }
  for (const Index dof : sector.outputs) places.check_range(dof, "the output dofs");
}

/// Lists the interior.
void check_dofs(FiniteSector& sector) {
  const Index n = sector.mass.rows();
  if (sector.left.size() != sector.right.size()) {
    fail("the left boundary has {} dofs and the right one {}, expected pairs", sector.left.size(),
         sector.right.size());
  }
  Places places(n);
  places.add(sector.left, "the left boundary");
  places.add(sector.right, right_name);
  places.add(sector.interior, "the interior");
  const bool listed = !sector.interior.empty();
  for (Index dof = 0; dof < n; ++dof) {
    if (places.of(dof) != nullptr) continue;
    if (listed) fail("dof {} is neither on a boundary nor in the interior", dof + 1);
    sector.interior.push_back(dof);
  }
  check_contacts(sector, places);
}

/// Largest entry of each column, of matrices whose diagonal is no measure of them.
Vector column_sizes(const SparseMatrix& matrix) {
  Vector sizes = Vector::Zero(matrix.cols());
  for (Index j = 0; j < matrix.cols(); ++j) {
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry)
      sizes(j) = std::max(sizes(j), std::abs(entry.value()));
  }
  return sizes;
}

/// Refuses what is not symmetric, A_ji = A_ij, or with `sign` -1 not skew, A_ji = -A_ij, beside the `sizes`
/// of the dofs, and puts the mean in its place.
void symmetrise(SparseMatrix& matrix, const char* name, double tolerance, const Vector& sizes,
                double sign = 1) {
  matrix.makeCompressed();
  const SparseMatrix transposed = sign * SparseMatrix(matrix.transpose());
  const SparseMatrix difference = matrix - transposed;
  double worst = 0;
  Index row = 0;
  Index column = 0;
  for (Index j = 0; j < matrix.cols(); ++j) {
    for (SparseMatrix::InnerIterator entry(difference, j); entry; ++entry) {
      const Index i = entry.row();
      if (!std::isfinite(entry.value()))
        fail("the {} matrix is not finite at row {}, column {}", name, i + 1, j + 1);
      if (entry.value() == 0) continue;
      const double size = std::max({std::abs(matrix.coeff(i, j)), std::abs(matrix.coeff(j, i)),
                                    std::sqrt(std::abs(sizes(i)) * std::abs(sizes(j)))});
      if (!(std::abs(entry.value()) > worst * size)) continue;
      worst = std::abs(entry.value()) / size;
      row = i;
      column = j;
    }
  }
  if (worst > tolerance) {
    fail("the {} matrix is not {}symmetric: {:.17g} at row {}, column {}, but {:.17g} at row {}, column {}",
         name, sign < 0 ? "skew-" : "", matrix.coeff(row, column), row + 1, column + 1,
         matrix.coeff(column, row), column + 1, row + 1);
  }
  if (worst > 0) matrix = SparseMatrix(0.5 * (matrix + transposed));
}

void check_finite(SparseMatrix& matrix, const char* name) {
  matrix.makeCompressed();
  for (Index j = 0; j < matrix.cols(); ++j) {
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      if (!std::isfinite(entry.value()))
        fail("the {} matrix is not finite at row {}, column {}", name, entry.row() + 1, j + 1);
    }
  }
}

void check_diagonal(const SparseMatrix& matrix, const char* name, const FiniteSector& sector) {
  const auto has = [&](Index dof) {
    const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[dof];
    const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[dof + 1];
    return std::binary_search(begin, end, static_cast<int>(dof));
  };
  for (std::size_t k = 0; k < sector.left.size(); ++k) {
    if (has(sector.left[k]) || has(sector.right[k])) continue;
    fail("the {} matrix has no entry on the diagonal of dof {} nor of its pair {}", name, sector.left[k] + 1,
         sector.right[k] + 1);
  }
  for (const Index dof : sector.interior) {
    if (!has(dof)) fail("the {} matrix has no entry on the diagonal of dof {}", name, dof + 1);
  }
}

}  // namespace

FiniteSector checked(FiniteSector sector, double asymmetry) {
  check_sizes(sector);
  check_dofs(sector);
  symmetrise(sector.mass, "mass", asymmetry, sector.mass.diagonal());
  symmetrise(sector.stiffness, "stiffness", asymmetry, sector.stiffness.diagonal());
  if (sector.damping.size() != 0) check_finite(sector.damping, "damping");
  SparseMatrix& gyroscopic = sector.gyroscopic;
  SparseMatrix& by_speed = sector.stiffness_speed2;
  if (gyroscopic.size() != 0) symmetrise(gyroscopic, "gyroscopic", asymmetry, column_sizes(gyroscopic), -1);
  if (by_speed.size() != 0) symmetrise(by_speed, "stiffness_speed2", asymmetry, column_sizes(by_speed));
  check_diagonal(sector.mass, "mass", sector);
  check_diagonal(sector.stiffness, "stiffness", sector);
  return sector;
}

SectorMap sector_map(const FiniteSector& sector) {
  SectorMap map;
  const auto n = static_cast<std::size_t>(sector.mass.rows());
  map.reduced.resize(n);
  map.is_right.resize(n);
  for (std::size_t k = 0; k < sector.left.size(); ++k) {
    const auto right = static_cast<std::size_t>(sector.right[k]);
    map.reduced[static_cast<std::size_t>(sector.left[k])] = static_cast<int>(k);
    map.reduced[right] = static_cast<int>(k);
    map.is_right[right] = 1;
  }
  int next = static_cast<int>(sector.left.size());
  for (const Index dof : sector.interior) map.reduced[static_cast<std::size_t>(dof)] = next++;
  map.size = next;
  return map;
}

}  // namespace arcslip
