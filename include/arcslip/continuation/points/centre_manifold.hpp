#pragma once

// The motion on the centre manifold of an equilibrium of u' = F(u, p): with critical eigenvalues lambda_i of
// A = dF/du, right and left eigenvectors A q_i = lambda_i q_i, p_i^H A = lambda_i p_i^H, p_i^H q_j =
// delta_ij,
//
//   u = u* + sum_a h_a w^a,   w_i' = lambda_i w_i + sum_a g_ia w^a,
//
// over monomials w^a. Those of each order solve [J. Murdock, Normal Forms and Unfoldings, Springer 2003; Yu.
// A. Kuznetsov, SIAM J. Numer. Anal. 36 (1999) 1104]
//
//   (a . lambda - A) h_a + sum_i q_i g_ia = r_a,   p_i^H h_a = 0,
//
// i over the variables with lambda_i = a . lambda, r_a what F and the products of lower orders make of it.
// r_a is read from series of F along curves u(h) of w = h v, so that no multilinear form is ever taken apart.

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "arcslip/continuation/problem/expansion.hpp"
#include "arcslip/continuation/problem/guess.hpp"

namespace arcslip::continuation {

/// A critical eigenvalue, j times `multiples` of two rates of turning: which of the a . lambda are equal is
/// not left to rounding.
struct CriticalMode {
  std::array<int, 2> multiples{};
  ComplexVector right;  ///< q, n, |q| = 1
  ComplexVector left;   ///< p, n
};

using Exponents = std::array<int, 4>;  ///< a, of w_1, w_2, ... 0 beyond the last variable

/// One variable for each mode; a real mode stands alone, one of a pair is followed by its conjugate.
class CentreManifold {
 public:
  /// Of a zero eigenvalue, if `has_zero`, then of pairs near +-j omega each. None where there are no such
  /// eigenvalues, or F cannot be evaluated.
  static std::optional<CentreManifold> at(const Problem& problem, const Guess& point, bool has_zero,
                                          const std::vector<double>& omegas);

  /// Finds g up to this order, at most 5. False where a combination of these rates meets an eigenvalue that
  /// is no multiple of these, or F cannot be evaluated.
  [[nodiscard]] bool reduce(Expansion& expansion, int order);

  /// g_ia, once it is found.
  Complex coefficient(std::size_t variable, const Exponents& a) const;

  const std::vector<CriticalMode>& modes() const { return modes_; }

 private:
  using Terms = std::map<Exponents, ComplexVector>;

  CentreManifold(const Problem& problem, const Guess& point);
  [[nodiscard]] bool add_mode(Complex value, std::array<int, 2> multiples);
  [[nodiscard]] bool read(Expansion& expansion, int order, const std::vector<Exponents>& all, Terms& terms);
  void subtract_lower(int order, Terms& terms) const;
  [[nodiscard]] bool solve(const Exponents& a, const ComplexVector& right, bool is_last);
  std::array<int, 2> multiples_of(const Exponents& a) const;
  Exponents conjugate(const Exponents& a) const;

  Guess point_;
  Linearization at_;
  std::array<double, 2> rates_{};
  std::vector<CriticalMode> modes_;
  std::vector<std::size_t> conjugates_;  // which variable is that of each
  Terms h_;
  Terms g_;  // by variables
};

}  // namespace arcslip::continuation
