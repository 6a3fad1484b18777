#pragma once

// A problem's symmetries as a group: which subgroups solutions have, and in which ways branches lose them.
//
// Where u has the symmetries of a subgroup H, dF/du commutes with them. Its null vectors at a point where a
// branch loses some are a space that H maps to itself: generically one whose parts H cannot map to themselves
// any more. Of dimension 1 such a space is turned over by half of H: the determinant changes its sign, and
// what leaves has the other half. Of more dimensions, as of polygons, the determinant touches zero and keeps
// its sign. But a subgroup that fixes a line of it has a fixed space in which dF/du has one null vector, and
// a branch leaves there [equivariant branching lemma: Vanderbauwhede 1982, Cicogna 1981]. Subgroups of two
// elements, mirrors, are looked at: what leaves may have more.

#include <vector>

#include "arcslip/continuation/problem/symmetry.hpp"

namespace arcslip::continuation {

/// Some elements of a group that are one themselves, by their numbers, rising; 0 is the identity.
using Subgroup = std::vector<std::size_t>;

/// A way in which branches lose symmetries.
struct Breaking {
  /// Subgroups that fix a line each of the null space: one of each class whose members are images of each
  /// other.
  std::vector<Subgroup> kept;
  /// n x r, orthonormal: dF/du maps its range to itself, and is singular there, with one null vector.
  SparseMatrix space;
};

/// The identity has the number 0, the symmetries follow from 1 on.
class SymmetryGroup {
 public:
  /// Throws std::logic_error where a product of two symmetries is none of them.
  explicit SymmetryGroup(std::vector<Symmetry> symmetries);

  std::size_t order() const { return product_.size(); }  ///< how many elements
  const std::vector<Symmetry>& symmetries() const { return symmetries_; }

  /// Those that u has, to `tolerance` of each unknown's scale (n).
  Subgroup kept(const Vector& u, const Vector& scale, double tolerance) const;

  /// Those that both have.
  static Subgroup common(const Subgroup& a, const Subgroup& b);

  /// The mean over a subgroup, n x n: onto what all of it leaves as it is.
  SparseMatrix projection(const Subgroup& of) const;

  /// In which ways branches that have a subgroup's symmetries may lose some: half of them, one way for each
  /// half; and mirrors that do not commute with others.
  std::vector<Breaking> breakings(const Subgroup& of) const;

 private:
  SparseMatrix map(std::size_t element) const;
  Subgroup generated(Subgroup by) const;
  Subgroup squares(const Subgroup& of) const;
  std::vector<Subgroup> halves(const Subgroup& of) const;
  std::vector<std::size_t> mirrors(const Subgroup& of) const;
  std::size_t inverse(std::size_t element) const;
  Matrix commuting(const Subgroup& of) const;

  std::vector<Symmetry> symmetries_;
  Index size_;
  std::vector<std::vector<std::size_t>> product_;  // [i][j] of S_i S_j
};

}  // namespace arcslip::continuation
