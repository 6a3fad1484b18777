#pragma once

// Orbits u(s), 0 <= s <= 1, as polynomials of degree m on N intervals that meet at their ends, or as a
// trigonometric one on a single interval, and where intervals are to lie: so that an estimate of the error is
// the same on each [C. de Boor, Good approximation by splines with variable knots, Lecture Notes in
// Mathematics 363 (1974) 12; R. D. Russell, J. Christiansen, SIAM J. Numer. Anal. 15 (1978) 59].

#include <vector>

#include "arcslip/continuation/cycles/collocation_rule.hpp"

namespace arcslip::continuation {

/// Places along an orbit, each by the first node of its interval and, a column, the weights of this one's
/// nodes.
struct OrbitPlaces {
  Vector s;
  std::vector<Index> first;
  Matrix weights;
};

/// Whether intervals lie as half a period later, and as mirrored in the middle, where errors nearly do.
enum class MeshSymmetry { nearly, none };

/// Values at the nodes are n x `nodes()`, those of an interval side by side, its last being the first of the
/// next one.
class OrbitMesh {
 public:
  /// `borders` N + 1, ascending from 0 to 1.
  OrbitMesh(const CollocationRule& rule, Vector borders);

  /// All intervals of one length.
  OrbitMesh(const CollocationRule& rule, Index intervals)
      : OrbitMesh(rule, Vector::LinSpaced(intervals + 1, 0, 1)) {}

  const CollocationRule& rule() const { return rule_; }
  const Vector& borders() const { return borders_; }
  Index intervals() const { return borders_.size() - 1; }
  /// What an orbit is resolved by: N, or the degree H of a trigonometric polynomial.
  Index resolution() const { return rule_.waves() > 0 ? rule_.waves() : intervals(); }
  Index nodes() const { return intervals() * rule_.degree() + 1; }
  double length(Index interval) const { return borders_(interval + 1) - borders_(interval); }

  /// The place s of a node, of all, and the interval that holds a place.
  double place(Index node) const;
  Vector places() const;
  Index interval(double s) const;

  /// An orbit and its derivative by s at a place, n each; `velocity` may be null.
  void at(const Matrix& values, double s, Vector& value, Vector* velocity) const;

  /// The places s of the Gauss points of all intervals, m N.
  Vector gauss_points() const;
  OrbitPlaces find(const Vector& s) const;
  /// An orbit at places, n x their number.
  Matrix at(const Eigen::Ref<const Matrix>& values, const OrbitPlaces& places) const;

  /// The values at the nodes of another mesh.
  Matrix carried(const Matrix& values, const OrbitMesh& to) const;

  /// Estimated size of |u - exact| on each interval, of the largest entry in units of `scale` (n): of a
  /// trigonometric polynomial the sum of its last amplitudes, a sixth of all but at least three.
  Vector errors(const Eigen::Ref<const Matrix>& values, const Vector& scale) const;

  /// A mesh of its kind of this resolution, on the intervals of which this orbit's errors would be alike:
  /// those of an orbit that nearly has a symmetry have it.
  OrbitMesh equidistributed(const Matrix& values, const Vector& scale, Index resolution,
                            MeshSymmetry symmetry = MeshSymmetry::nearly) const;

  /// Whether it lacks a symmetry that this orbit nearly has. Branches that differ by it meet where meshes
  /// have it, and pass each other within the mesh's error elsewhere.
  bool is_lopsided(const Matrix& values, const Vector& scale) const;

 private:
  struct Density;
  Density density(const Matrix& values, const Vector& scale) const;
  Vector highest_derivatives(const Eigen::Ref<const Matrix>& values, const Vector& scale) const;

  CollocationRule rule_;
  Vector borders_;
  OrbitPlaces equal_;  // the ends of 2 N equal parts, of polynomials
};

/// How far each unknown goes along an orbit; of those that hardly move, in units of `scale`, a thousandth of
/// what the others do.
Vector ranges(const Eigen::Ref<const Matrix>& orbit, const Vector& scale);

}  // namespace arcslip::continuation
