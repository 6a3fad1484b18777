#include "arcslip/continuation/linear/nearest_eigenvalues.hpp"

#include <Spectra/GenEigsRealShiftSolver.h>

#include <algorithm>
#include <vector>

#include "arcslip/continuation/linear/bordered_solver.hpp"
#include "arcslip/dense.hpp"

namespace arcslip::continuation {
namespace {

/// x -> (A - shift)^{-1} x
class ShiftedInverse {
 public:
  using Scalar = double;

  explicit ShiftedInverse(const SparseMatrix& matrix)
      : matrix_(matrix), solver_(make_bordered_solver(matrix.rows(), 0, true)), right_(matrix.rows()) {}

  Index rows() const { return matrix_.rows(); }
  Index cols() const { return matrix_.cols(); }

  void set_shift(double /*shift*/) {}  // it is set by `factor`

  /// The least shift, from 0 on, with which the matrix is not singular; false if there is none.
  bool factor(double& shift) {
    const Vector ones = Vector::Ones(rows());
    SparseMatrix identity(rows(), rows());
    identity.setIdentity();
    const double size = matrix_.nonZeros() > 0 ? matrix_.coeffs().abs().maxCoeff() : 1;
    for (const double part : {0.0, 1e-12, 1e-9, 1e-6}) {
      shift = part * size;
      SparseMatrix shifted = matrix_ - shift * identity;
      shifted.makeCompressed();
      solver_->set_jacobian(shifted, ones);
      if (solver_->factor() != 0) return true;
    }
    return false;
  }

  void perform_op(const double* x, double* y) const {
    right_ = Eigen::Map<const Vector>(x, rows());
    solver_->solve(right_);
    Eigen::Map<Vector>(y, rows()) = right_;
  }

 private:
  const SparseMatrix& matrix_;
  std::unique_ptr<BorderedSolver> solver_;
  mutable Vector right_;
};

/// Those that are real or come with their conjugates.
std::vector<Index> complete(const ComplexVector& values) {
  std::vector<Index> result;
  for (Index i = 0; i < values.size(); ++i) {
    const double near = 1e-8 * std::abs(values(i));
    const auto is_there = (values.array() - std::conj(values(i))).abs() <= near;
    if (is_there.any()) result.push_back(i);
  }
  return result;
}

}  // namespace

ComplexVector nearest_eigenvalues(const SparseMatrix& matrix, Index count, ComplexMatrix* vectors) {
  constexpr Index few = 200;
  constexpr Index most_restarts = 300;
  constexpr double tolerance = 1e-12;
  const Index n = matrix.rows();
  if (n <= few) return eigenvalues(Matrix(matrix), vectors);
  ShiftedInverse inverse(matrix);
  double shift = 0;
  if (!inverse.factor(shift)) return {};
  const Index basis = std::min(n, 2 * count + 20);
  Spectra::GenEigsRealShiftSolver<ShiftedInverse> solver(inverse, count, basis, shift);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, most_restarts, tolerance);
  if (solver.info() != Spectra::CompInfo::Successful) return {};
  const ComplexVector found = solver.eigenvalues();
  const std::vector<Index> kept = complete(found);
  if (vectors != nullptr) *vectors = solver.eigenvectors()(Eigen::all, kept);
  return found(kept);
}

}  // namespace arcslip::continuation
