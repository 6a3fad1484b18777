#include "sectors/full_response.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "arcslip/dense.hpp"
#include "sectors/turning_modes.hpp"

namespace arcslip {

/// Z = k K + m M + Omega^2 K_2 + j w* Omega G at one place, of the matrices and of the modes.
class FullResponse::Stiffness {
 public:
  Stiffness(const FullResponse& full, double eta, double speed)
      : sector_(full.space_.sector()), loss_(full.loss_), factors_(eta, loss_) {
    const SectorModes& modes = full.modes_;
    const Real turn = 2 * std::numbers::pi_v<Real>;
    gyroscopic_ = modes.gyroscopic.size() == 0 ? 0 : turn * turn * static_cast<Real>(eta) * speed;
    by_speed2_ = modes.stiffness_speed2.size() == 0 ? 0 : turn * turn * static_cast<Real>(speed) * speed;
    const Vector diagonal =
        full.reduction_.stiffness().diagonal().cwiseAbs() * static_cast<double>(std::abs(factors_.k)) +
        full.reduction_.mass().diagonal().cwiseAbs() * static_cast<double>(std::abs(factors_.m));
    if (!diagonal.allFinite())
      throw SectorError(fmt::format(
          "the sector has no response at eta = {:g}, where w*^2 M is beyond the range of a double", eta));
    weights_ = diagonal.unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 1; });
    const ComplexVector denominators = modal_denominators(modes, loss_, eta);
    inverses_ = denominators.unaryExpr([](const Complex& d) { return 1.0 / d; });
    if (gyroscopic_ == 0 && by_speed2_ == 0) return;
    ComplexMatrix z = denominators.asDiagonal();
    if (gyroscopic_ != 0) z += Complex(0, eta * speed) * modes.gyroscopic;
    if (by_speed2_ != 0) z += speed * speed * modes.stiffness_speed2;
    coupled_ = solver_of(z);
  }

  NumberMatrix times(const NumberMatrix& motion) const {
    NumberMatrix force(motion.rows(), motion.cols());
    for (Index i = 0; i < motion.cols(); ++i) {
      const ExtendedSector::NumberVector unfolded = sector_.unfold(motion.col(i));
      force.col(i) = factors_.k * sector_.stiffness_times(unfolded);
      if (factors_.m != Real(0)) force.col(i) += factors_.m * sector_.mass_times(unfolded);
      if (gyroscopic_ != 0)
        force.col(i) += ExtendedSector::Number(0, gyroscopic_) * sector_.gyroscopic_times(unfolded);
      if (by_speed2_ != 0) force.col(i) += by_speed2_ * sector_.stiffness_speed2_times(unfolded);
    }
    return force;
  }

  /// Of the modes, over (2 pi)^2.
  ComplexMatrix solved_by_modes(const ComplexMatrix& of_modes) const {
    if (coupled_) return coupled_(of_modes);
    return inverses_.asDiagonal() * of_modes;
  }

  /// Of forces, each dof's in the unit of its own stiffness.
  Vector sizes(const NumberMatrix& forces) const {
    return (weights_.cast<Real>().asDiagonal() * forces.cwiseAbs())
        .colwise()
        .norm()
        .transpose()
        .cast<double>();
  }

  /// v^H w in these units.
  ExtendedSector::Number product(const ExtendedSector::NumberVector& v,
                                 const ExtendedSector::NumberVector& w) const {
    return (weights_.cast<Real>().asDiagonal() * v).dot(weights_.cast<Real>().asDiagonal() * w);
  }

  /// Of what adds up to Z x, at most.
  Vector terms(const NumberMatrix& motion) const {
    NumberMatrix sums(motion.rows(), motion.cols());
    for (Index i = 0; i < motion.cols(); ++i) {
      const ExtendedSector::NumberVector unfolded = sector_.unfold(motion.col(i));
      sums.col(i) = std::abs(factors_.k) * sector_.stiffness_sums(unfolded) +
                    std::abs(factors_.m) * sector_.mass_sums(unfolded);
    }
    return sizes(sums);
  }

 private:
  const ExtendedSector& sector_;
  const Loss& loss_;
  MatrixFactors<Real> factors_;
  Real gyroscopic_ = 0;
  Real by_speed2_ = 0;
  Vector weights_;
  ComplexVector inverses_;
  std::function<ComplexMatrix(const ComplexMatrix&)> coupled_;
};

FullResponse::FullResponse(const RitzSpace& space, const KrylovSpace* krylov,
                           const SectorReduction& reduction, const SectorModes& modes, const Loss& loss)
    : space_(space), krylov_(krylov), reduction_(reduction), modes_(modes), loss_(loss) {}

FullResponse::NumberMatrix FullResponse::forces() const {
  const ExtendedSector& sector = space_.sector();
  NumberMatrix all(sector.size(), sector.contacts() + 1);
  for (Index i = 0; i < sector.contacts(); ++i) all.col(i) = sector.contact_force(i);
  all.rightCols<1>() = sector.load();
  return all;
}

namespace {

/// What one more direction of motion, each column its own, takes off residuals: with those before it the
/// least. Generalised conjugate residuals [Eisenstat, Elman & Schultz, SIAM J. Numer. Anal. 20 (1983) 345].
template <class Stiffness, class NumberMatrix>
class Descent {
 public:
  explicit Descent(const Stiffness& z) : z_(z) {}

  /// Along `direction`, whose forces are `image`.
  void along(NumberMatrix direction, NumberMatrix image, NumberMatrix& motion, NumberMatrix& residual) {
    constexpr double lost = 1e-8;  // of a direction: what is left of one that is among the others already
    for (Index k = 0; k < motion.cols(); ++k) {
      const auto before = z_.product(image.col(k), image.col(k)).real();
      for (const auto& [known, known_image] : known_) {
        const auto share = z_.product(known_image.col(k), image.col(k));
        image.col(k) -= share * known_image.col(k);
        direction.col(k) -= share * known.col(k);
      }
      const auto after = z_.product(image.col(k), image.col(k)).real();
      const auto factor = after > lost * lost * before ? 1 / std::sqrt(after) : 0;
      image.col(k) *= factor;
      direction.col(k) *= factor;
      const auto part = z_.product(image.col(k), residual.col(k));
      motion.col(k) += part * direction.col(k);
      residual.col(k) -= part * image.col(k);
    }
    known_.emplace_back(std::move(direction), std::move(image));
  }

 private:
  const Stiffness& z_;
  std::vector<std::pair<NumberMatrix, NumberMatrix>> known_;
};

}  // namespace

ComplexMatrix FullResponse::at(double eta, double speed) const {
  constexpr int most = 100;
  constexpr double enough = 0.01;
  constexpr double rounding = 16 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  const Stiffness z(*this, eta, speed);
  const NumberMatrix force = forces();
  NumberMatrix motion = NumberMatrix::Zero(force.rows(), force.cols());
  NumberMatrix residual = force;
  Vector small;
  Descent<Stiffness, NumberMatrix> descent(z);
  for (int i = 0; i < most; ++i) {
    if (i > 0) residual = force - z.times(motion);
    const NumberMatrix low = space_.lifted(z.solved_by_modes(space_.projected(residual)));
    const NumberMatrix image = z.times(low);
    const NumberMatrix left = residual - image;
    const Vector sizes = z.sizes(left);
    if (i == 0) small = (enough * sizes).cwiseMax(rounding * z.terms(low));
    if ((sizes.array() <= small.array()).all()) return seen(motion + low);
    descent.along(low, image, motion, residual);
    if (krylov_ == nullptr) continue;
    ComplexMatrix high = residual.cast<Complex>();
    krylov_->solve(high);
    const NumberMatrix direction = high.cast<ExtendedSector::Number>();
    descent.along(direction, z.times(direction), motion, residual);
  }
  throw SectorError(fmt::format("the modes fail to give the response of the matrices at eta = {:g}", eta));
}

/// Of contacts and outputs.
ComplexMatrix FullResponse::seen(const NumberMatrix& motion) const {
  ComplexMatrix all(modes_.shapes.rows(), motion.cols());
  for (Index k = 0; k < motion.cols(); ++k)
    all.col(k) = space_.sector().observed(motion.col(k)).cast<Complex>();
  return all;
}

}  // namespace arcslip
