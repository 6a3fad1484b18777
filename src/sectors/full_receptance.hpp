#pragma once

// A finite-element sector seen at its contacts and outputs by sparse solves, which ask nothing of its
// damping: C(eta) = E^T Z^{-1} E and y_0(eta) = E^T Z^{-1} F of SectorSolver, one factorisation for each eta.

#include <mutex>
#include <unordered_map>

#include "arcslip/sectors/sector_modes.hpp"
#include "arcslip/sectors/sector_solver.hpp"
#include "arcslip/structure/contact_modes.hpp"

namespace arcslip {

/// May be called from several threads, which then wait for one another.
class FullReceptance {
 public:
  /// As of SectorSolver.
  FullReceptance(const FiniteSector& sector, const SectorWave& wave, const Loss& loss)
      : solver_(sector, wave.forward(), loss) {}

  /// The response of the m contacts under `force` times the load; not finite where Z is singular.
  ContactReceptance at(double eta, double force) const;

  /// The same with an output after the contacts; what a force on it does is nan.
  ContactReceptance with_output(Index output, double eta, double force) const;

  /// The same with the motion F^H d that the load does work on in its place.
  ContactReceptance with_driven_motion(double eta, double force) const;

  /// Of that response under `forces` on the contacts as well.
  CycleWork work(double eta, double force, const ContactVector& forces) const;

  int factorisations() const;  ///< since the start
  Index size() const { return solver_.reduction().size(); }

 private:
  SectorResponse response(double eta) const;

  mutable std::mutex mutex_;
  mutable SectorSolver solver_;
  mutable std::unordered_map<double, SectorResponse> known_;  // by eta: points are seen again when written
};

}  // namespace arcslip
