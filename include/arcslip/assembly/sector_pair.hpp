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

#include "arcslip/assembly/structures.hpp"
#include "arcslip/sectors/matrix_market.hpp"
#include "arcslip/sectors/sector_modes.hpp"

namespace arcslip {

class KnownTurning;
class SectorSolves;

/// How the response of a sector is found: as a sum over modes, which damping must be proportional or modal
/// for, or by sparse solves at each eta.
enum class SectorPath { reduced, full };

/// As case files have it: its name.
std::string to_string(SectorPath path);

/// A linear combination of the outputs of a sector, whose motion is wanted.
struct SectorOutput {
  /// One of them.
  struct Term {
    Index output;   ///< its position
    double weight;  ///< finite
  };
  std::string name;         ///< the column's, behind Y_ or U_
  std::vector<Term> terms;  ///< one or more
};

/// One of the two with its damping: zeta times that of a kind, and what is there besides.
struct SectorPart {
  FiniteSector sector;  ///< checked, with a contact; with damping on the full path only
  DampingKind damping_kind = DampingKind::structural;  ///< of the part by zeta
  double reference_frequency = 1;                      ///< eta at which viscous damping has the loss 2 zeta
  Loss fixed;                                          ///< what is there besides
  std::uint64_t fingerprint = 0;                       ///< of the files it was read from
  std::vector<DofPlace> places = {};                   ///< of the dofs, or none
  std::vector<SectorOutput> combinations = {};         ///< that are wanted beside the sector's outputs
  Index untold = 0;  ///< how many of these, the last ones, are there for combinations alone

  /// Whether it is damped where zeta is 0.
  bool is_damped() const { return sector.damping.size() != 0 || fixed.viscous != 0 || fixed.mass != 0; }

  /// Loss over zeta.
  Loss loss_per_zeta() const;
  /// The whole loss, but for the sector's own damping.
  Loss loss(double zeta) const { return fixed + zeta * loss_per_zeta(); }
};

/// What modes depend on.
struct SectorUse {
  SectorWave wave;                       ///< under which
  double eta_low = 0;                    ///< the window in which they give the response
  double eta_high = 0;                   ///< >= eta_low
  std::vector<Rotation> rotations = {};  ///< at which they do; none: at rest
};

/// Keeps what it has found. May be used from several threads.
class SectorPair : public Structures {
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

  /// Solves, kept as modes are: sparse ones on the full path, where damping is not modal, else of the modes
  /// at rest, if rotation is felt that couples them; or null.
  std::shared_ptr<const SectorSolves> base_solves(const SectorUse& use, double zeta) const;
  std::shared_ptr<const SectorSolves> damper_solves(const SectorUse& use, double zeta) const;

  /// Modes of a part that turns, kept as well.
  std::shared_ptr<const KnownTurning> turning(bool is_base, const SectorUse& use, double zeta) const;

  // Of the system's contacts, any number of them; one alone where it is reduced.
  ContactSystem wave(const SystemParameters& system) const override;
  /// Of what turns in the coordinates of its modes at rest.
  ContactModes seen(const SystemParameters& system, bool is_base) const override;
  /// The modes at rest of what turns, with what rotation couples them by, as `seen` has them; null of a part
  /// that does not feel it.
  std::shared_ptr<const SectorModes> turning_modes(const SystemParameters& system, bool is_base) const;
  bool is_one_contact(const SystemParameters& system) const override;
  /// The speed, where it is felt and follows no engine order.
  std::vector<SystemParameter> parameters(const SystemParameters& system) const override;
  PairLosses losses(const SystemParameters& system) const override;
  /// Refuses matrices that are not definite under this wave.
  void check(Index wave_number, Index nodes) const override;
  std::shared_ptr<const Structures> in_modes() const override;
  bool feels_rotation() const override {
    return base_.part.sector.feels_rotation() || (damper_ && damper_->part.sector.feels_rotation());
  }
  std::vector<PartModes> modes(const SystemParameters& system) const override;

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
    mutable Places<std::vector<double>, std::shared_ptr<const SectorModes>> modes = {};
    mutable Places<std::vector<double>, std::shared_ptr<const SectorSolves>> solves = {};
    mutable Places<std::vector<double>, std::shared_ptr<const KnownTurning>> turning = {};
    mutable Places<std::array<Index, 2>, bool> checked = {};
  };

  template <class Key, class Value, class Make>
  const Value& found(const Kept& kept, Places<Key, Value>& places, const Key& key, const Make& make) const;
  std::shared_ptr<const SectorModes> modes(const Kept& kept, const SectorUse& use, double zeta) const;
  std::shared_ptr<const SectorSolves> solves(const Kept& kept, const SectorUse& use, double zeta) const;
  void check(const Kept& kept, const SectorWave& wave) const;

  Kept base_;
  std::optional<Kept> damper_;
  double tolerance_;
  SectorPath path_;
  mutable std::mutex mutex_;
};

/// C = alpha M + beta K as a loss. Throws SectorError where C has any other part beyond 1e-10 of itself.
Loss proportional_loss(const SparseMatrix& damping, const SparseMatrix& mass, const SparseMatrix& stiffness);

}  // namespace arcslip
