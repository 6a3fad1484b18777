#include "sectors/krylov_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arcslip {
namespace {

// Of the largest w*^2: what solves in double, refined, tell well from the rounding of the matrices.
constexpr double resolved = 1e-12;

constexpr ExtendedSector::Real tiny = std::numeric_limits<double>::min();

double square(double eta) {
  const double w = two_pi * eta;
  return w * w;
}

}  // namespace

KrylovSpace::KrylovSpace(const ExtendedSector& sector, const SectorReduction& reduction,
                         const ModesRequest& request)
    : extended_(sector), reduction_(reduction), shifted_(reduction.stiffness()), factors_(shifted_) {
  const Index contacts = extended_.contacts();
  block_ = ComplexMatrix::Zero(reduction_.size(), contacts + 1);
  for (Index i = 0; i < contacts; ++i) block_.col(i) = extended_.contact_force(i).cast<Complex>();
  block_.col(contacts) = reduction_.load();
  basis_.resize(reduction_.size(), 0);
  if (is_static(request)) return;
  constexpr double part = 0.1;
  const double largest = largest_square(reduction_);
  sigma_ = -square(part * request.eta_high);
  if (largest > 0) sigma_ = -std::clamp(-sigma_, resolved * largest, largest);
  if (!factor(sigma_)) throw SectorError("the stiffness matrix is not positive semidefinite under this wave");
}

/// K - sigma M, where that is positive definite.
bool KrylovSpace::factor(double sigma) {
  ++factorisations_;
  shifted_.coeffs() = reduction_.stiffness().coeffs() - sigma * reduction_.mass().coeffs();
  return factors_.factor(shifted_);
}

/// Whether sigma = 0 serves, whose factors are then at hand.
bool KrylovSpace::is_static(const ModesRequest& request) {
  constexpr double far_below = 0.01;
  if (!factor(0)) return false;
  ComplexVector any(reduction_.size());  // every motion has a part in it
  for (Index i = 0; i < any.size(); ++i) any(i) = std::polar(1.0, static_cast<double>(i * i));
  const ComplexVector force = reduction_.mass() * any;
  ComplexMatrix motion = force;
  factors_.solve(motion);
  // x^H f/x^H M x is Rayleigh's quotient of x, without the cancellation of K; the least w*^2 or a little
  // more.
  const double size = norm(motion);
  const double least = motion.col(0).dot(force).real() / (size * size);
  return least >= std::max(square(far_below * request.eta_low), resolved * largest_square(reduction_));
}

ComplexMatrix KrylovSpace::refined(const ComplexMatrix& forces) const {
  using NumberMatrix = ExtendedSector::NumberMatrix;
  constexpr int most = 10;
  constexpr ExtendedSector::Real accuracy = 1e-12;  // of the correction that is left out
  const NumberMatrix exact = forces.cast<ExtendedSector::Number>();
  NumberMatrix motion = NumberMatrix::Zero(forces.rows(), forces.cols());
  NumberMatrix residual = exact;
  ExtendedSector::Real before = 1;
  for (int i = 0; i < most; ++i) {
    ComplexMatrix step = residual.cast<Complex>();
    solve(step);
    motion += step.cast<ExtendedSector::Number>();
    const auto sizes = step.cast<ExtendedSector::Number>().colwise().norm().array();
    const ExtendedSector::Real change = (sizes / motion.colwise().norm().array().max(tiny)).maxCoeff();
    if (change * std::min(change / before, ExtendedSector::Real(1)) <= accuracy) break;
    before = change;
    for (Index k = 0; k < motion.cols(); ++k) {
      const ExtendedSector::NumberVector unfolded = extended_.unfold(motion.col(k));
      residual.col(k) = exact.col(k) - extended_.stiffness_times(unfolded);
      if (sigma_ != 0) residual.col(k) += ExtendedSector::Real(sigma_) * extended_.mass_times(unfolded);
    }
  }
  return motion.cast<Complex>();
}

const ComplexMatrix& KrylovSpace::next() {
  const ComplexMatrix vectors =
      refined(basis_.cols() == 0 ? block_ : ComplexMatrix(reduction_.mass() * block_));
  block_.resize(vectors.rows(), 0);
  for (Index column = 0; column < vectors.cols(); ++column) append(vectors.col(column));
  return block_;
}

double KrylovSpace::norm(const ComplexVector& v) const {
  const ComplexVector product = reduction_.mass() * v;
  return std::sqrt(std::max(0.0, v.dot(product).real()));
}

/// Without its part in the space.
ComplexVector KrylovSpace::outside(const ComplexVector& v) const {
  const ComplexVector product = reduction_.mass() * v;
  const ComplexVector shares = basis_.adjoint() * product;
  return v - basis_ * shares;
}

void KrylovSpace::append(ComplexVector v) {
  constexpr double lost = 1e-11;
  const double before = norm(v);
  if (!(before > 0)) return;
  for (int pass = 0; pass < 2; ++pass) v = outside(v);
  const double after = norm(v);
  if (!(after > lost * before)) return;
  v = outside(v / after);
  v /= norm(v);
  for (ComplexMatrix* matrix : {&basis_, &block_}) {
    matrix->conservativeResize(Eigen::NoChange, matrix->cols() + 1);
    matrix->rightCols<1>() = v;
  }
}

}  // namespace arcslip
