#pragma once

// Polynomials of degree m on an interval of length 1, held by their values at m + 1 nodes, the ends among
// them, and asked for at the m points of Gauss or of Radau: what collocation at these is made of [C. de Boor,
// B. Swartz, SIAM J. Numer. Anal. 10 (1973) 582; E. Hairer, G. Wanner, Solving ODEs II (1996) IV.5].

#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// Gauss's are the most exact, by one order at the ends of intervals, but let what decays within an interval
/// pass to its end, with a factor that tends to 1 or -1 as the rate grows. Radau's, of which the end is one,
/// let it vanish: so multipliers of stiff fields are those of their flow.
enum class CollocationPoints { gauss, radau };

class CollocationRule {
 public:
  static constexpr int least = 2;
  static constexpr int most = 7;

  /// Of degree m. Throws std::invalid_argument unless least <= m <= most.
  explicit CollocationRule(int degree, CollocationPoints points = CollocationPoints::gauss);

  int degree() const { return degree_; }
  const Vector& nodes() const { return nodes_; }              ///< m + 1, from 0 to 1: those of Lobatto
  const Vector& points() const { return points_; }            ///< m, from 0 to 1
  const Vector& weights() const { return weights_; }          ///< m, their sum is 1
  const Matrix& values() const { return values_; }            ///< m x (m + 1): at the points from the nodes
  const Matrix& derivatives() const { return derivatives_; }  ///< m x (m + 1): the same of the derivative
  const Matrix& looks() const { return looks_; }      ///< 17 x (m + 1): at equal distances, ends included
  const Vector& highest() const { return highest_; }  ///< m + 1: of the m-th derivative
  double product() const { return product_; }         ///< largest |prod (s - node)| on the interval

  /// Weights of the values at the nodes, m + 1, in the value at s and in the derivative there.
  void at(double s, Vector& value, Vector& derivative) const;

 private:
  int degree_;
  Vector nodes_;
  Vector barycentric_;
  Vector points_;
  Vector weights_;
  Matrix values_;
  Matrix derivatives_;
  Matrix looks_;
  Vector highest_;
  double product_ = 0;
};

}  // namespace arcslip::continuation
