#pragma once

// One sector of a rotor or of its ring as a finite-element program gives it, with what couples it to the
// next:
//
//   M d'' + C d' + K d = f,   d = (d_L, d_I, d_R),   d_R = d_L e^{-ja} under a travelling wave
//
// Of one that turns with the speed Omega K is K + Omega^2 K_2 and C is C + Omega G, see rotation.hpp.
//
// Dofs that are held are left out by whoever writes the matrices. Dofs count from 0 here and from 1 in
// errors. A structure without symmetry is the one sector of N = 1 and has no boundaries.

#include <stdexcept>
#include <vector>

#include "arcslip/types.hpp"

namespace arcslip {

/// A sector that is not consistent; what() is one line.
class SectorError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Matrices n x n; every dof is in one of `left`, `right`, `interior`.
struct FiniteSector {
  SparseMatrix mass;            ///< M
  SparseMatrix stiffness;       ///< K
  SparseMatrix damping;         ///< 0 x 0: none
  std::vector<Index> left;      ///< boundary to the sector before
  std::vector<Index> right;     ///< boundary to the next sector, paired with `left` in order
  std::vector<Index> interior;  ///< empty: all others
  std::vector<Index> contacts;  ///< not on the right, where they are those of the next sector
  /// Of each contact the dof whose motion is taken off that of its own, or `ground`; empty: all are against
  /// ground, or against the other structure.
  std::vector<Index> against = {};
  std::vector<Index> outputs;          ///< anywhere
  ComplexVector load;                  ///< n; amplitude of the force e^{j w t} on the sector of phase 0
  SparseMatrix gyroscopic = {};        ///< G, skew-symmetric; 0 x 0: none
  SparseMatrix stiffness_speed2 = {};  ///< K_2, symmetric; 0 x 0: none

  static constexpr Index ground = -1;  ///< of `against`: nothing that moves

  /// What the i-th contact is against.
  Index against_of(std::size_t i) const { return against.empty() ? ground : against[i]; }
  /// Whether it meets sectors beside it.
  bool has_boundaries() const { return !left.empty(); }
  /// Whether rotation changes it.
  bool feels_rotation() const { return gyroscopic.size() != 0 || stiffness_speed2.size() != 0; }
};

/// Largest |A_ij - A_ji| over the largest of |A_ij|, |A_ji| and sqrt|A_ii A_jj| that is taken for rounding.
inline constexpr double largest_asymmetry = 1e-8;

/// The same sector with its interior listed, its matrices compressed and M, K and K_2 symmetric and G skew to
/// the last digit, by the mean of A_ij and A_ji or -A_ji; C may have a gyroscopic part. Throws SectorError
/// naming the first inconsistency: sizes, dofs missing, listed twice or out of range, boundaries that do not
/// pair, numbers that are not finite, asymmetry, contacts that are the same or against their own dof, a dof
/// without an entry on the diagonal of mass and stiffness (on a boundary, one of the pair must have it).
FiniteSector checked(FiniteSector sector, double asymmetry = largest_asymmetry);

/// Where each dof of the sector goes under d_R = d_L e^{-ja}: the reduced dofs are `left`, then `interior`.
struct SectorMap {
  std::vector<int> reduced;    ///< reduced dof of each dof
  std::vector<char> is_right;  ///< whether it carries the factor e^{-ja}
  Index size = 0;              ///< of reduced dofs
};

/// For a sector that is checked.
SectorMap sector_map(const FiniteSector& sector);

}  // namespace arcslip
