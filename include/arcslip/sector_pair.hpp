#pragma once

// Base and damper as finite-element sectors, with their modes for each travelling wave that is asked for.
//
// A contact of a sector has the stiffness k and slips where the force k R reaches L P: S = L P/k.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "arcslip/sector_modes.hpp"
#include "arcslip/system.hpp"

namespace arcslip {

/// One of the two with its damping: zeta times that of a kind, and what is there besides.
struct SectorPart {
  FiniteSector sector;  ///< checked, with a contact, damping 0 x 0
  DampingKind damping_kind = DampingKind::structural;
  double reference_frequency = 1;  ///< eta at which viscous damping has the loss 2 zeta
  Loss fixed;
  std::uint64_t fingerprint = 0;  ///< of the files it was read from

  /// Whether it is damped where zeta is 0.
  bool is_damped() const { return fixed.viscous != 0 || fixed.mass != 0; }

  /// Loss over zeta.
  Loss loss_per_zeta() const;
};

/// What modes depend on.
struct SectorUse {
  SectorWave wave;
  double eta_low = 0;
  double eta_high = 0;
};

class SectorPair {
 public:
  SectorPair(SectorPart base, std::optional<SectorPart> damper, double tolerance);

  double tolerance() const { return tolerance_; }
  const SectorPart& base() const { return base_.part; }
  const SectorPart* damper() const { return damper_ ? &damper_->part : nullptr; }  ///< null: held

  /// Modes, found at the first call for them and kept. May be called from several threads. Throws
  /// SectorError, whose text names base or damper.
  const SectorModes& base_modes(const SectorUse& use, double zeta) const;
  const SectorModes& damper_modes(const SectorUse& use, double zeta) const;

  /// Refuses matrices that are not definite under this wave. Throws SectorError.
  void check(const SectorWave& wave) const;

 private:
  struct Found {
    std::once_flag once;
    SectorModes modes;
  };
  struct Kept {
    SectorPart part;
    const char* name;
    mutable std::map<std::array<double, 5>, std::shared_ptr<Found>> found = {};
    mutable std::map<std::array<Index, 2>, std::shared_ptr<std::once_flag>> checked = {};
  };

  const SectorModes& modes(const Kept& kept, const SectorUse& use, double zeta) const;
  void check(const Kept& kept, const SectorWave& wave) const;

  Kept base_;
  std::optional<Kept> damper_;
  double tolerance_;
  mutable std::mutex mutex_;
};

/// The model of `parameters`, whose `sectors` are given and have one contact. Throws SectorError.
FrictionSystem build_sector_system(const SystemParameters& parameters);

/// The same of sectors with several contacts. Throws SectorError.
ContactSystem build_contact_system(const SystemParameters& parameters);

/// The use that `parameters` make of their sectors.
SectorUse sector_use(const SystemParameters& parameters);

/// C = alpha M + beta K as a loss. Throws SectorError where C has any other part beyond 1e-10 of itself.
Loss proportional_loss(const SparseMatrix& damping, const SparseMatrix& mass, const SparseMatrix& stiffness);

}  // namespace arcslip
