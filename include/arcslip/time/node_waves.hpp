#pragma once

// Coordinates of a ring's elements by the waves round it: X = F S for each of them, with the N values of N
// waves at the nodes, F, orthonormal, and the few modes of each wave in S. So a displacement takes the
// modes to their waves and these to the nodes, in N + 2 D/N operations for each node in place of D.

#include <Eigen/SparseCore>
#include <vector>

#include "arcslip/time/ring.hpp"

namespace arcslip {

/// Such products.
class NodeWaves {
 public:
  /// Some rows of X.
  struct Rows {
    /// Those of one coordinate.
    struct Part {
      Index coordinate;           ///< which
      std::vector<Index> places;  ///< of these among all
      Matrix nodes;               ///< their rows of F
    };
    std::vector<Part> parts;
  };

  /// Of all rows.
  explicit NodeWaves(const Ring& ring);

  /// Some of them, in any order.
  Rows of(const std::vector<Index>& rows) const;

  /// x = X p in some rows, columns at a time.
  void displace(const Rows& rows, const Matrix& position, Matrix& x) const;

  /// X^T f of forces in some rows.
  void push(const Rows& rows, const Matrix& force, Matrix& pushed) const;

 private:
  using Shapes = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  Matrix waves_;                ///< F
  std::vector<Shapes> shapes_;  ///< S of each coordinate, N x D
  std::vector<Shapes> modes_;   ///< S^T
};

}  // namespace arcslip
