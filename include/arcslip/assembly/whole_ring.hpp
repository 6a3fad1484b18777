#pragma once

// The whole ring in place of one sector: the N x c contacts of all sectors, which need not be alike, under
// any load at one frequency. Sector i = 0..N-1 moves as a sum over the waves m = 0..N-1,
//
//   d_i = sum_m d(m) e^{-j a_m i},   a_m = 2 pi m/N,
//
// and each wave has its own compliance c(m) between the ports of one sector, so that those of all are
//
//   C_ij = (1/N) sum_m c(m) e^{-j a_m (i - j)},   y_i = sum_m A_m y(m) e^{-j a_m i},
//
// A_m that of the load, p_i = sum_m A_m p e^{-j a_m i}. Waves m and N - m differ by a transposition, but for
// those of sectors that turn, of which each has its own c(m). What is not the same in all sectors is a linear
// element on some motions x = B^T d of base or damper, with the stiffness D(eta) = K (1 + j loss) - w^2 M:
//
//   C' = C - C B (D^-1 + B^T C B)^-1 B^T C,   y' = y - C B (D^-1 + B^T C B)^-1 B^T y      [Woodbury]
//
// Damping that is modal stays that of the equal sectors' modes.
//
// Motion in time and disturbances take the whole for a single sector under the wave 0, of N c contacts: by
// its real modes, those of the equal sectors or, where something is not the same in all, combinations of
// them.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arcslip/assembly/structures.hpp"

namespace arcslip {

class RingPart;

/// How a load goes round the ring. The force of the system is its amplitude.
struct WholeLoad {
  /// Over the sectors.
  enum class Course {
    travelling,  ///< the system's wave n, in its harmonic h that of h n
    standing,    ///< cos(n theta_i): half the wave n, half the wave -n, in every harmonic
    point,       ///< on sector 1 alone
    given        ///< as `sectors` says, in every harmonic
  };
  Course course = Course::travelling;  ///< which
  Index wave_number = 0;               ///< n of a standing one
  std::vector<Complex> sectors = {};   ///< N amplitudes of e^{jwt}
};

/// As case files have it: its name.
std::string to_string(WholeLoad::Course course);

/// A linear element in some sectors, beside what all have: it meets x = sum of weights times motions.
struct RingChange {
  /// One motion in one sector.
  struct Term {
    Index sector;   ///< from 0
    Index port;     ///< one of those of the part, see RingMake
    double weight;  ///< finite
  };

  bool on_base = true;                ///< or on the damper
  std::vector<std::vector<Term>> of;  ///< the x, as many as rows of the matrices
  Matrix stiffness;                   ///< K, symmetric
  Matrix mass = {};                   ///< M, symmetric; of size 0 where it has none
};

/// What a whole ring is made of.
struct RingMake {
  Index sectors = 2;                                  ///< N >= 2
  std::shared_ptr<const Structures> structures = {};  ///< of one sector; null: rods and beams
  std::vector<SectorContact> contacts = {};           ///< of one sector, as its structures have them
  WholeLoad load = {};                                ///< round the ring
  /// The last of what is wanted of base and damper that is not told but for changes; the ports that these
  /// name.
  Index base_ports = 0;
  Index damper_ports = 0;
  std::vector<WantedOutput> wanted =
      {};  ///< by which rods and beams are asked for ports, after a system's own
  std::vector<RingChange> changes = {};  ///< to both
  /// The highest amplitude of the equal ring, where that of this one is told over it; NaN: not known yet.
  std::optional<double> equal_peak = {};
  bool in_modes = false;  ///< whether base and damper are told by the modes of the changed whole
};

/// The modes at rest of the changed whole, with what rotation couples them by, over those of base and damper
/// one after the other: v_i^T G v_k and v_i^T K_2 v_k.
struct TurningWholeModes {
  ContactModes base;    ///< real ones, loaded
  ContactModes damper;  ///< the same, without load
  Matrix gyroscopic;
  Matrix stiffness_speed2;
};

/// The structures of all sectors. Its system's contacts are all N x c, those of sector 1 first.
class WholeRing final : public Structures {
 public:
  /// Throws std::invalid_argument where numbers do not fit.
  explicit WholeRing(RingMake make);

  /// What it was made of.
  const RingMake& make() const { return make_; }
  Index sectors() const { return make_.sectors; }

  /// A system of it as that of one sector alone, under its wave.
  SystemParameters one_sector(const SystemParameters& system) const;

  /// A system of it with the ring of equal sectors in its place.
  SystemParameters equal(const SystemParameters& system) const;

  /// A system of it whose amplitude is told over that of the equal ring.
  SystemParameters told_over(const SystemParameters& system, double equal_peak) const;

  /// Resonances of base, damper and the stuck whole, and the stuck damper's antiresonances, of all waves of
  /// the equal sectors, as they turn.
  std::vector<double> landmarks(const SystemParameters& system) const;

  /// Throws std::invalid_argument where changes take more than there is at rest, as far as modes tell it.
  void check_changes(const SystemParameters& system) const;

  ContactSystem wave(const SystemParameters& system) const override;
  /// Of sectors that turn, told by modes. Throws std::invalid_argument.
  TurningWholeModes turning(const SystemParameters& system) const;
  bool is_one_contact(const SystemParameters& /*system*/) const override { return false; }
  PairLosses losses(const SystemParameters& system) const override;
  double nodes(const SystemParameters& system) const override;
  double circular_frequency() const override;
  void check(Index wave_number, Index nodes) const override;
  /// The speed, where it may be continued.
  std::vector<SystemParameter> parameters(const SystemParameters& system) const override;
  bool feels_rotation() const override;
  std::vector<PartModes> modes(const SystemParameters& system) const override;
  bool has_equations() const override;
  std::shared_ptr<const Structures> in_modes() const override;
  const WholeRing* whole() const override { return this; }

 private:
  const Structures& sector() const;
  std::vector<Complex> amplitudes(Index wave_number) const;
  std::shared_ptr<const RingPart> part(const SystemParameters& system, bool is_base) const;

  RingMake make_;
};

/// N x c contacts that differ by factors from those of one sector: on their stiffness, and on the force under
/// which they slip. Each list has one number for each contact of the whole, or none where all are 1; nothing
/// rubs where `missing`. Throws std::invalid_argument where the numbers do not fit.
struct RingContacts {
  std::vector<double> limit = {};
  std::vector<double> stiffness = {};
  std::vector<bool> missing = {};

  std::vector<SectorContact> of(const std::vector<SectorContact>& sector, Index sectors) const;
};

}  // namespace arcslip
