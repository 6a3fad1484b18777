#pragma once

// A sector that turns, in the coordinates of its modes at rest, which rotation couples, over (2 pi)^2:
//
//   Z(eta, Omega) = diag(d_k) + Omega^2 K_2 + j eta Omega G,   d_k as in ModalModel, Omega in revolutions

#include "sectors/full_receptance.hpp"

namespace arcslip {

/// d_k of the modes as the matrices have them: with what stiffness their rounding gives to free motions.
ComplexVector modal_denominators(const SectorModes& modes, const Loss& loss, double eta);

/// Its response in these coordinates, of so many contacts, at a speed in revolutions. Throws
/// std::domain_error where Z is singular.
SectorMotions modal_motions(const SectorModes& modes, Index contacts, const Loss& loss, double eta,
                            double speed);

/// Solved for in these coordinates, exactly, with damping of any kind that the modes at rest diagonalise.
class ModalSolves final : public SectorSolves {
 public:
  /// `modes` of `contacts` contacts, found with rotations; so many responses are kept.
  ModalSolves(std::shared_ptr<const SectorModes> modes, Index contacts, const Loss& loss,
              std::size_t kept = 10000);

  int factorisations() const override { return modes_->factorisations; }

 private:
  SectorResponse solved(double eta, double speed) const override;
  Index contacts() const override { return contacts_; }
  Index outputs() const override { return modes_->shapes.rows() - contacts_; }

  std::shared_ptr<const SectorModes> modes_;
  Index contacts_;
  Loss loss_;
};

/// The undamped modes of such a sector as its contacts see them: at a speed of
///   A z = eta B z,   A = diag(K', 1),   B = [-H 1; 1 0],   z = (v, eta v),   H = j Omega G,
/// K' = K + Omega^2 K_2, and with an engine order m, Omega = eta/m, of K v = eta^2 (1 - K_2/m^2 - j G/m) v.
/// Throws SectorError where K' is not positive definite.
TurningModes turning_modes(const SectorModes& modes, Index contacts, const Rotation& rotation);

/// The same, found at the first call for each rotation and kept. May be called from several threads.
class KnownTurning {
 public:
  KnownTurning(std::shared_ptr<const SectorModes> modes, Index contacts)
      : modes_(std::move(modes)), contacts_(contacts) {}

  /// Under the load itself.
  std::shared_ptr<const TurningModes> at(const Rotation& rotation) const;

 private:
  std::shared_ptr<const SectorModes> modes_;
  Index contacts_;
  mutable std::mutex mutex_;
  mutable std::map<std::pair<double, double>, std::shared_ptr<const TurningModes>> known_;
};

}  // namespace arcslip
