#include "sectors/krylov_space.hpp"

#include <algorithm>
#include <cmath>

#include "sectors/refined_solve.hpp"

namespace arcslip {
namespace {

// Of the largest w*^2: what solves in double, refined, tell well from the rounding of the matrices.
constexpr double resolved = 1e-12;

double square(double eta) {
  const double w = two_pi * eta;
  return w * w;
}

}  // namespace

KrylovSpace::KrylovSpace(const FiniteSector& sector, const SectorWave& wave, const ModesRequest& request)
    : extended_(sector, wave), reduction_(sector), shifted_(reduction_.stiffness()), factors_(shifted_) {
  reduction_.set_forward(wave.forward());
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
  shifted_ = reduction_.stiffness() - sigma_ * reduction_.mass();
  if (!factors_.factor(shifted_)) throw SectorError("the stiffness of the sector is singular at its shift");
}

/// Whether sigma = 0 serves, whose factors are then at hand.
bool KrylovSpace::is_static(const ModesRequest& request) {
  constexpr double far_below = 0.01;
  shifted_ = reduction_.stiffness();
  if (!factors_.factor(shifted_)) return false;
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

const ComplexMatrix& KrylovSpace::next() {
  constexpr double accuracy = 1e-12;  // of a correction, behind which the next one is negligible
  const ComplexMatrix forces = basis_.cols() == 0 ? block_ : ComplexMatrix(reduction_.mass() * block_);
  block_.resize(forces.rows(), 0);
  for (Index column = 0; column < forces.cols(); ++column) {
    append(refined_solve(extended_, factors_, 1, -sigma_, forces.col(column).cast<ExtendedSector::Number>(),
                         accuracy)
               .cast<Complex>());
  }
  return block_;
}

double KrylovSpace::norm(const ComplexVector& v) const {
  return std::sqrt(std::max(0.0, v.dot(reduction_.mass() * v).real()));
}

void KrylovSpace::append(ComplexVector v) {
  constexpr double lost = 1e-11;
  const double before = norm(v);
  if (!(before > 0)) return;
  for (int pass = 0; pass < 2; ++pass) v -= basis_ * (basis_.adjoint() * (reduction_.mass() * v));
  const double after = norm(v);
  if (!(after > lost * before)) return;
  v /= after;
  v -= basis_ * (basis_.adjoint() * (reduction_.mass() * v));
  v /= norm(v);
  for (ComplexMatrix* matrix : {&basis_, &block_}) {
    matrix->conservativeResize(Eigen::NoChange, matrix->cols() + 1);
    matrix->rightCols<1>() = v;
  }
}

}  // namespace arcslip
