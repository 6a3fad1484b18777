#pragma once

// Functions on an interval of length 1 that are held by their values at m + 1 nodes, the ends among them, and
// asked for at m points: what collocation at these is made of. Polynomials of degree m, asked for at the
// points of Gauss or of Radau [C. de Boor, B. Swartz, SIAM J. Numer. Anal. 10 (1973) 582; E. Hairer,
// G. Wanner, Solving ODEs II (1996) IV.5]; or, where they come back at the end of the interval but for what
// grows linearly, trigonometric ones of degree H, m = 2 H + 1, at their own nodes, which lie at equal
// distances.

#include <type_traits>

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

  /// That of trigonometric polynomials of degree H >= 1.
  static CollocationRule trigonometric(int waves);

  int degree() const { return degree_; }                      ///< m
  int waves() const { return waves_; }                        ///< H; 0 of polynomials
  const Vector& nodes() const { return nodes_; }              ///< m + 1, from 0 to 1: those of Lobatto
  const Vector& points() const { return points_; }            ///< m, from 0 to 1
  const Vector& weights() const { return weights_; }          ///< m, their sum is 1
  const Matrix& values() const { return values_; }            ///< m x (m + 1): at the points from the nodes
  const Matrix& derivatives() const { return derivatives_; }  ///< m x (m + 1): the same of the derivative
  const Matrix& looks() const {
    return looks_;
  }  ///< 17 or 4 m + 1 x (m + 1): at equal distances, with both ends
  const Vector& highest() const { return highest_; }  ///< m + 1: of the m-th derivative; of polynomials
  double product() const { return product_; }         ///< largest |prod (s - node)| on the interval

  /// Weights of the values at the nodes, m + 1, in the value at s and, if wanted, in the derivative there.
  void at(double s, Vector& value, Vector* derivative = nullptr) const;

  /// Of trigonometric polynomials by their values, n x (m + 1), beside what grows linearly: the mean, then
  /// the coefficients of cos(2 pi s), sin(2 pi s), cos(4 pi s), ..., n x m.
  Matrix coefficients(const Matrix& values) const;

 private:
  CollocationRule() = default;
  void fill();

  int degree_ = 0;
  int waves_ = 0;
  Vector nodes_;
  Vector barycentric_;
  Vector points_;
  Vector weights_;
  Matrix values_;
  Matrix derivatives_;
  Matrix looks_;
  Vector highest_;
  double product_ = 0;
  Matrix modes_;  // m x m: coefficients by the values at nodes
};

/// What loops over a degree, given that: the usual one as a constant, with which it takes much less time.
template <class Function>
void with_degree(Index degree, const Function& function) {
  using Usual = std::integral_constant<Index, 4>;
  degree == Usual() ? function(Usual()) : function(degree);
}

}  // namespace arcslip::continuation
