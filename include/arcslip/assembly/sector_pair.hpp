#pragma once

// Base and damper as finite-element sectors, with their modes or sparse solves for each travelling wave that
// is asked for.
//
// A contact of a sector has the stiffness k and slips where the force k R reaches L P: S = L P/k.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "arcslip/assembly/system.hpp"
#include "arcslip/sectors/sector_modes.hpp"

namespace arcslip {

class FullReceptance;

/// How the response of a sector is found: as a sum over modes, which damping must be proportional or modal
/// for, or by sparse solves at each eta.
enum class SectorPath { reduced, full };

/// As case files have it: its name.
std::string to_string(SectorPath path);

/// One of the two with its damping: zeta times that of a kind, and what is there besides.
struct SectorPart {
  FiniteSector sector;  ///< checked, with a contact; with damping on the full path only
  DampingKind damping_kind = DampingKind::structural;  ///< of the part by zeta
  double reference_frequency = 1;                      ///< eta at which viscous damping has the loss 2 zeta
  Loss fixed;                                          ///< what is there besides
  std::uint64_t fingerprint = 0;                       ///< of the files it was read from

  /// Whether it is damped where zeta is 0.
  bool is_damped() const { return sector.damping.size() != 0 || fixed.viscous != 0 || fixed.mass != 0; }

  /// Loss over zeta.
  Loss loss_per_zeta() const;
  /// The whole loss, but for the sector's own damping.
  Loss loss(double zeta) const { return fixed + zeta * loss_per_zeta(); }
};

/// What modes depend on.
struct SectorUse {
  SectorWave wave;      ///< under which
  double eta_low = 0;   ///< the window in which they give the response
  double eta_high = 0;  ///< >= eta_low
};

/// Keeps what it has found. May be used from several threads.
class SectorPair {
 public:
  /// Without damper the base rubs on what is held. `tolerance` is that of the modes' response, relative.
  SectorPair(SectorPart base, std::optional<SectorPart> damper, double tolerance,
             SectorPath path = SectorPath::reduced);

  /// What it was made of.
  double tolerance() const { return tolerance_; }
  SectorPath path() const { return path_; }
  const SectorPart& base() const { return base_.part; }
  const SectorPart* damper() const { return damper_ ? &damper_->part : nullptr; }  ///< null: held

  /// Modes, found at the first call for them and kept; on the full path those of resonances alone, which are
  /// compared with nothing. May be called from several threads. Throws SectorError, whose text names base or
  /// damper.
  const SectorModes& base_modes(const SectorUse& use, double zeta) const;
  const SectorModes& damper_modes(const SectorUse& use, double zeta) const;

  /// Sparse solves, kept as modes are; of the full path. Damping is not modal.
  std::shared_ptr<const FullReceptance> base_solves(const SectorWave& wave, double zeta) const;
  std::shared_ptr<const FullReceptance> damper_solves(const SectorWave& wave, double zeta) const;

  /// Refuses matrices that are not definite under this wave. Throws SectorError.
  void check(const SectorWave& wave) const;

 private:
  /// What is made at the first call for it.
  template <class Value>
  struct Once {
    std::once_flag flag;
    Value value{};
  };
  template <class Key, class Value>
  using Places = std::map<Key, Once<Value>>;
  struct Kept {
    SectorPart part;
    const char* name;
    mutable Places<std::array<double, 5>, SectorModes> modes = {};
    mutable Places<std::array<double, 3>, std::shared_ptr<const FullReceptance>> solves = {};
    mutable Places<std::array<Index, 2>, bool> checked = {};
  };

  template <class Key, class Value, class Make>
  const Value& found(const Kept& kept, Places<Key, Value>& places, const Key& key, const Make& make) const;
  const SectorModes& modes(const Kept& kept, const SectorUse& use, double zeta) const;
  std::shared_ptr<const FullReceptance> solves(const Kept& kept, const SectorWave& wave, double zeta) const;
  void check(const Kept& kept, const SectorWave& wave) const;

  Kept base_;
  std::optional<Kept> damper_;
  double tolerance_;
  SectorPath path_;
  mutable std::mutex mutex_;
};

/// The pair on the reduced path. Throws SectorError where its damping has no modes, as a matrix beyond mass
/// and stiffness.
std::shared_ptr<const SectorPair> reduced(const SectorPair& pair);

/// The model of `parameters`, whose `sectors` are given, reduced and with one contact. Throws SectorError.
FrictionSystem build_sector_system(const SystemParameters& parameters);

/// The same of sectors with any number of contacts, reduced or in full. Throws SectorError.
ContactSystem build_contact_system(const SystemParameters& parameters);

/// Whether `parameters` are those of sectors that only a ContactSystem serves: with several contacts, or in
/// full.
bool needs_contact_system(const SystemParameters& parameters);

/// The use that `parameters` make of their sectors.
SectorUse sector_use(const SystemParameters& parameters);

/// C = alpha M + beta K as a loss. Throws SectorError where C has any other part beyond 1e-10 of itself.
Loss proportional_loss(const SparseMatrix& damping, const SparseMatrix& mass, const SparseMatrix& stiffness);

}  // namespace arcslip
