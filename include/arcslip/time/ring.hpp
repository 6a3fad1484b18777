#pragma once

// The complete ring of N nodes, base and damper, with all elements that act on them. Nothing is taken from
// the travelling wave but the load. With q the displacements of all nodes, x = X q the coordinates in which
// elements act and f their forces against these,
//
//   M q'' + C q' + K q + X^T f = Re(sum_h F_h e^{jhw*t}),   w* = 2 pi eta
//
// where node i carries the load of node 1 times e^{-jha(i-1)}. It is held in the undamped modes of the two
// uncoupled structures, which are waves round the ring: those of l and N - l lengths are the two real
// coordinates a and b of a motion Re(v e^{-2 pi j l (i-1)/N} (a + jb)). They leave every matrix but that of
// the elements diagonal,
//
//   p'' + D p' + W p + X^T f = Re(sum_h L_h e^{jhw*t}),   x = X p
//
// but for a flow's, under which a and b push each other, and those of rotation, D + Omega G and
// W + Omega^2 K_2, by which the modes at rest of a whole ring are coupled, and
// make of the motion in which each node does what the next one did a turn of a and b by 2 pi l/N.
// Of modes of one frequency and damping, as rigid motions of base and damper, elements feel sum v v^H alone:
// what moves no element is left out, and told apart where the load moves it.

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "arcslip/assembly/coordinates.hpp"
#include "arcslip/assembly/system.hpp"

namespace arcslip {

/// Elements of one kind, one at each node.
struct RingElements {
  std::shared_ptr<const Element> element;  ///< one of them
  Index sliding;                           ///< the first of the N rows of its first coordinate
  Index across;                            ///< of the second one along which it slides, or -1
  Index closing;                           ///< of the one along which it closes, or -1
  double factor;                           ///< on its force
};

/// One harmonic of the load.
struct RingLoad {
  int order;                ///< h
  ComplexVector amplitude;  ///< D: L of Re(L e^{jhw*t})
};

/// What a harmonic of the load moves of the base's contact dof without any element's knowing.
struct UnseenMotion {
  int order;          ///< h
  Complex residue;    ///< of y_h = residue/(stiffness - (h w*)^2 + jh w* damping), at node 1
  Complex stiffness;  ///< square of the circular frequency, less what a flow does
  double damping;     ///< as in D
};

/// Modal form of the ring; D coordinates, N nodes. Time is nondimensional: one period is p/eta.
struct Ring {
  Vector stiffness;           ///< D: diagonal of W, squares of the circular frequencies 2 pi eta_k
  Vector damping;             ///< D: diagonal of D
  Vector coupling;            ///< D: by what the coordinate beside pushes; empty where no flow does
  std::vector<Index> wave;    ///< D: l <= N/2
  std::vector<Index> beside;  ///< D: the coordinate b that stands to an a or a to a b; itself where N | 2 l

  Matrix motion;  ///< X: N rows for each coordinate of the elements, contacts first, by D
  Matrix base;    ///< N x D: the first contact dof of the base, y = base p

  Index node_count;                         ///< N
  Index wave_number;                        ///< n
  double preload_growth;                    ///< P_2
  int periods = 1;                          ///< p, of those in which harmonics are told
  std::vector<RingElements> elements = {};  ///< that act
  std::vector<RingLoad> loads = {};         ///< that act
  std::vector<UnseenMotion> unseen = {};    ///< of the load's harmonics

  Matrix gyroscopic = {};        ///< D x D: of what turns G, which couples all coordinates; empty where none
  Matrix stiffness_speed2 = {};  ///< D x D: K_2, the same
  Rotation rotation = {};        ///< with which it turns

  /// Whether rotation couples the coordinates.
  bool turns() const { return gyroscopic.size() > 0; }

  /// N and D.
  Index nodes() const { return node_count; }
  Index coordinates() const { return stiffness.size(); }

  /// N x D: relative motions u - y of the first contact.
  auto relative() const { return motion.topRows(node_count); }

  /// |n| periods over N, in which each node comes to do what the one before it did, of n < 0 the one behind
  /// it; of n = 0 a period.
  double periods_of_turn() const {
    return wave_number == 0 ? 1
                            : std::abs(static_cast<double>(wave_number)) / static_cast<double>(node_count);
  }

  /// What the coordinates beside push with, columns of D rows; of a ring with `coupling`.
  Matrix coupled(const Matrix& columns) const { return coupling.asDiagonal() * columns(beside, Eigen::all); }

  /// Columns of D rows, turned so that each node does what the next one did, of n < 0 the one before.
  Matrix turned(const Matrix& columns) const;

  /// Rows of N nodes for each of several quantities, moved likewise.
  Matrix moved_back(const Matrix& rows) const;
};

/// Assembles the ring. Throws std::invalid_argument, with the reason, for structures without modes or with
/// damping that is not viscous or modal, for contacts that do not act back on the base and for elements that
/// have no motion in time; SectorError.
Ring build_ring(const SystemParameters& parameters);

}  // namespace arcslip
