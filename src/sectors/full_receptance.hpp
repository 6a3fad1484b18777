#pragma once

// A finite-element sector seen at its contacts and outputs by solves, which ask nothing of its damping and
// let it turn: C(eta) = E^T Z^{-1} E and y_0(eta) = E^T Z^{-1} F of SectorSolver, sparse and one
// factorisation for each eta, or of what stands for it.

#include <map>
#include <mutex>

#include "arcslip/sectors/sector_modes.hpp"
#include "arcslip/sectors/sector_solver.hpp"
#include "arcslip/structure/contact_modes.hpp"

namespace arcslip {

/// Solved for in whatever way. May be called from several threads. With a rotation that follows eta
/// derivatives by eta are along it; the rates are by the speed.
class SectorSolves {
 public:
  /// Keeps so many responses.
  explicit SectorSolves(std::size_t kept = 10000) : kept_(kept) {}
  virtual ~SectorSolves() = default;

  /// The response of the m contacts under `force` times the load; not finite where Z is singular.
  VariedReceptance at(double eta, double force, const Rotation& rotation = {}) const;

  /// The same with an output after the contacts; what a force on it does is nan.
  VariedReceptance with_output(Index output, double eta, double force, const Rotation& rotation = {}) const;

  /// The same with the motion F^H d that the load does work on in its place.
  VariedReceptance with_driven_motion(double eta, double force, const Rotation& rotation = {}) const;

  /// Of that response under `forces` on the contacts as well.
  CycleWork work(double eta, double force, const ContactVector& forces, const Rotation& rotation = {}) const;

  virtual int factorisations() const = 0;  ///< since the start

 protected:
  mutable std::mutex mutex_;  ///< held as it is solved for

 private:
  SectorResponse response(double eta, const Rotation& rotation) const;

  /// At a speed, in revolutions, alone in this object. Throws std::domain_error where Z is singular.
  virtual SectorResponse solved(double eta, double speed) const = 0;
  virtual Index contacts() const = 0;
  virtual Index outputs() const = 0;

  std::size_t kept_;
  mutable std::map<std::pair<double, double>, SectorResponse>
      known_;  // by eta and speed: points are seen again when written
};

/// By sparse solves; threads wait for one another.
class FullReceptance final : public SectorSolves {
 public:
  /// As of SectorSolver.
  FullReceptance(const FiniteSector& sector, const SectorWave& wave, const Loss& loss)
      : solver_(sector, wave.forward(), loss) {}

  int factorisations() const override;
  Index size() const { return solver_.reduction().size(); }

 private:
  SectorResponse solved(double eta, double speed) const override { return solver_.at(eta, speed); }
  Index contacts() const override { return solver_.contacts(); }
  Index outputs() const override { return solver_.outputs(); }

  mutable SectorSolver solver_;
};

}  // namespace arcslip
