#pragma once

// Floquet multipliers: the eigenvalues of a product of matrices X_N ... X_1, each accurate to its own digits
// however far they lie apart. Bases that are carried through the product again and again, orthogonal anew
// after each factor, come to span its invariant subspaces, the largest eigenvalue's first; what does not part
// lies so near together that the product of its triangular factors is as good as its eigenvalues are [A.
// Bojanczyk, G. Golub, P. Van Dooren, Proc. SPIE 1770 (1992) 31].

#include <vector>

#include "arcslip/types.hpp"

namespace arcslip::continuation {

/// ln(mu) of the product of `factors`, the first of which comes to act first, each n x n; imaginary parts
/// from -pi to pi. In any order, conjugates side by side. -infinity for mu = 0. Empty where a factor is not
/// finite.
ComplexVector log_multipliers(const std::vector<Matrix>& factors);

/// The same without that of the directions that the factors carry into each other: v_(j+1) = X_j v_j but for
/// its length, one column more than there are factors, the last a multiple of the first.
ComplexVector log_multipliers_beside(const std::vector<Matrix>& factors, const Matrix& along);

/// The largest ones of a large, sparse orbit, up to `count` of them, but for that of its own velocity, and
/// without those that rounding hides beside these, by Arnoldi's method: `jacobian` is that of the collocation
/// equations of `intervals` of `degree` in the values of n unknowns at the nodes, one after the other, and
/// `along` the velocity at the ends of intervals, or none. Empty where they are not found.
ComplexVector largest_log_multipliers(const SparseMatrix& jacobian, Index n, Index intervals, Index degree,
                                      const Matrix& along, Index count);

/// ln(mu)/T, with ln(-mu) in place of ln(mu) of those below 0: what crosses the imaginary axis where |mu|
/// = 1.
ComplexVector exponents(const ComplexVector& logs, double duration);

/// Takes the multiplier that is nearest to e^`log` out of the list. Next to a second real one rounding may
/// have made a pair of the two: then the other one is by the product of both.
void remove_multiplier(ComplexVector& logs, Complex log);

/// prod (1 + mu), each factor over 1 + |mu|: 0 at period doublings.
double doubling_test(const ComplexVector& log_multipliers);

/// prod (1 - mu), each factor over 1 + |mu|; nan without any.
double fold_test(const ComplexVector& log_multipliers);

/// Where one multiplier is -1 or, of folds, 1: the same product without it, 0 where a second one comes to be
/// so. Of all multipliers the sum of the products without one; nan without any.
double second_doubling_test(const ComplexVector& log_multipliers);
double second_fold_test(const ComplexVector& log_multipliers);

}  // namespace arcslip::continuation
