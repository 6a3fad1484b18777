#pragma once

// Reduction of a ring of N equal sectors under a travelling wave, d_i = d_1 e^{-ja(i-1)}, to the dofs of one
// sector [paper (2)-(6)]:
//
//   A(a) = T^H A T,   T : (d_L, d_I) -> (d_L, d_I, d_L e^{-ja}),   A = M, C, K
//
// which for an element without interior dofs is A11 + A22 + A12 e^{-ja} + A21 e^{ja}. The cost does not
// depend on N. The functions are templates, for double precision and for the fifty digits of precise.hpp.

#include <Eigen/Core>
#include <stdexcept>
#include <vector>

#include "arcslip/structure/chain_elements.hpp"

namespace arcslip {

/// Reduces the sector matrix (boundary L, interior I, boundary R; `boundary` dofs each in L and R) to
/// (boundary + interior)^2. `forward` is e^{-ja}, the factor from one sector to the next.
/// Throws std::invalid_argument where the sizes do not fit.
template <class Scalar, class Derived>
Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> reduce_sector(const Eigen::MatrixBase<Derived>& sector,
                                                                    Index boundary, const Scalar& forward) {
  using Reduced = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  const Index kept = sector.rows() - boundary;
  if (boundary < 1 || sector.rows() != sector.cols() || kept < boundary) {
    throw std::invalid_argument("reduce_sector: a square matrix of at least 2 x boundary dofs is needed");
  }
  const Reduced full = sector.template cast<Scalar>();
  const Scalar backward = Scalar(1) / forward;  // |forward| = 1: its conjugate
  Reduced reduced = full.topLeftCorner(kept, kept);
  reduced.leftCols(boundary) += full.topRightCorner(kept, boundary) * forward;
  reduced.topRows(boundary) += full.bottomLeftCorner(boundary, kept) * backward;
  reduced.topLeftCorner(boundary, boundary) += full.bottomRightCorner(boundary, boundary);
  return reduced;
}

/// Reduces a sector load (L, I, R) in the same way: T^H f.
template <class Scalar, class Derived>
Eigen::Matrix<Scalar, Eigen::Dynamic, 1> reduce_load(const Eigen::MatrixBase<Derived>& load, Index boundary,
                                                     const Scalar& forward) {
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> reduced = load.head(load.size() - boundary);
  reduced.head(boundary) += load.tail(boundary) * (Scalar(1) / forward);
  return reduced;
}

/// A structure as one travelling wave sees it. Both matrices are Hermitian, J x J; `load` has J entries.
struct ReducedStructure {
  /// M, K and F under the wave.
  PreciseComplexMatrix mass;
  PreciseComplexMatrix stiffness;
  PreciseComplexVector load;
};

/// A mode v_k of such a structure as sums of its dofs see it.
struct SeenMode {
  double frequency;     ///< eta_k
  ComplexVector shape;  ///< rows v_k/(2 pi)
  Complex load;         ///< v_k^H F/(2 pi)
};

/// All of them in ascending order, seen through `rows`, sums x J. Throws std::invalid_argument where the mass
/// is not positive definite.
std::vector<SeenMode> seen_modes(const ReducedStructure& structure, const PreciseComplexMatrix& rows);

/// Ring of equal elements: the reduction of `element` with its propagation constant.
ReducedStructure reduce(const ChainElement& element, Index wave_number, Index elements);

}  // namespace arcslip
