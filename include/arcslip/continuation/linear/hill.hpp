#pragma once

// Stability of periodic solutions by Hill's method: the Floquet exponents of
//
//   x' = A(t) x,   A(t) = sum_k A_k e^{jkwt},   A_{-k} = conj A_k,   x = e^{lambda t} sum_i p_i e^{jiwt}
//
//   sum_k A_{i-k} p_k - j i w p_i = lambda p_i,   |i| <= h
//
// Each multiplier mu = e^{lambda T}, T = 2 pi/w, has the copies lambda + j w/2 Z: those by whole w with whole
// i, the others with i = +-1/2, +-3/2, ... Of all copies that is taken whose eigenvector is most centred,
// |sum i |p_i|^2| least: truncation changes it least [A. Lazarus, O. Thomas, C. R. Mecanique 338 (2010) 510].
// In real form (cosines and sines) both truncated problems have exactly real eigenvalues for real mu,
// positive with whole i and negative with the others, so that mu = +-1 is a simple zero.

#include <vector>

#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// Of n multipliers mu, in one order; conjugates stand together.
struct FloquetExponents {
  ComplexVector exponents;  ///< ln(mu)/T, |Im| <= w/2
  ComplexVector rates;      ///< these, or ln(-mu)/T: real wherever mu is real, zero at mu = 1 and at mu = -1
};

/// `coefficients` A_0, A_1, ..., n x n, those that are left out being zero; `twice_h` = 2 h >= 1 makes i
/// whole if even; the other i go one half further. A solution by the same terms has a fold, or mu = -1,
/// exactly where a rate vanishes. Costs two eigenvalue problems of about (2 h + 1) n.
FloquetExponents floquet_exponents(const std::vector<ComplexMatrix>& coefficients, double w, Index twice_h);

/// prod (1 + mu) but for a positive factor: Hill's determinant of i = +-1/2, +-3/2, ..., which has a simple
/// zero where a rate of the same `twice_h` passes mu = -1.
double doubling_determinant(const std::vector<ComplexMatrix>& coefficients, double w, Index twice_h);

/// prod (1 - mu) but for a positive factor: that of whole i, with a simple zero where a rate of the same
/// `twice_h` passes mu = 1.
double returning_determinant(const std::vector<ComplexMatrix>& coefficients, double w, Index twice_h);

/// How many of the coefficients c_0, c_1, ... of a smooth periodic solution its exponents depend on: those
/// above 1e-12 of the largest and two more, since what is left out counts by its square.
Index significant(const ComplexVector& coefficients);

}  // namespace arcslip::continuation
