#pragma once

// Base or damper of a whole ring, as its contacts and some further motions in each sector see it.

#include <Eigen/LU>
#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include "arcslip/assembly/whole_ring.hpp"
#include "arcslip/sectors/sector_modes.hpp"
#include "arcslip/structure/contact_modes.hpp"

namespace arcslip {

/// Immutable; may be used from several threads.
class RingPart {
 public:
  /// What is the same in all sectors, and what is not.
  struct Given {
    Index contacts = 1;  ///< of a sector, the first ones of its ports
    std::vector<ContactModes>
        waves;  ///< m = 0..N-1, of the ports of one sector, each with its load times sqrt(N)
    std::vector<RingChange> changes = {};  ///< of this part
    Loss loss = {};                        ///< of the changes; its modal part does not count
    double circular_frequency = two_pi;    ///< w over eta
    bool turns = false;         ///< whether waves m and N - m may differ by more than a transposition
    bool varies_speed = false;  ///< whether rates by the speed are wanted
    /// Of what turns the modes at rest of the waves 0..N/2, of the same ports.
    std::vector<std::shared_ptr<const SectorModes>> turning = {};
  };
  explicit RingPart(Given given);

  /// Of the N x c contacts under this factor of the load, with so many revolutions added to the speed; rates
  /// are by it. With a port (>= 0) rows for its motions in all sectors follow, and nothing else is filled.
  VariedReceptance at(double eta, double load, double speed, Index port = -1) const;

  /// Of the same, with what the changes take.
  CycleWork work(double eta, double load, const ContactVector& forces, double speed) const;

  /// The modes of the equal sectors as the whole's contacts see it, with their loads.
  ContactModes modes() const;

  /// Modes, with what rotation couples them by, 0 x 0 where it does not.
  struct Changed {
    ContactModes modes;
    Matrix gyroscopic;
    Matrix stiffness_speed2;
  };

  /// Throws std::invalid_argument where changes take more mass or stiffness than there is, as far as waves
  /// are told by modes.
  void check_changes() const;

  /// The modes of the changed whole at rest, real ones; those of rigid motions with the frequency 0. Throws
  /// std::invalid_argument where changes leave no modes that damping keeps apart, and as `check_changes`.
  Changed changed_modes() const;

 private:
  /// The modes of the equal sectors, two real ones of each two waves that run opposite ways.
  struct RealModes {
    std::vector<double> squares;  ///< D: eta_k^2
    std::vector<Vector> motion;   ///< D: of all ports of all sectors, by `place`
    std::vector<Complex> load;    ///< D
    Matrix gyroscopic = {};       ///< D x D, or 0 x 0
    Matrix stiffness_speed2 = {};
  };
  struct SameModes;  ///< some of one wave, of one frequency
  static std::vector<SameModes> same_modes(const ContactModes& wave);
  void add_single(Index wave, const SameModes& modes, RealModes& all) const;
  void add_pairs(Index wave, const SameModes& modes, const std::vector<SameModes>& back,
                 RealModes& all) const;
  void add_real(Index wave, const ContactVector& shape, double part, double square, Complex load,
                RealModes& all) const;
  RealModes real_modes() const;
  void add_turning(Index wave, RealModes& all) const;
  void couple(Index wave, Index first, const ComplexMatrix& of_wave, Matrix& all) const;
  RealModes turning_modes() const;
  Matrix changed_rows(const RealModes& all) const;
  struct ChangedModes {
    Vector squares;  ///< D: eta_k^2, 0 of rigid motions
    Matrix shapes;   ///< D x D: in the modes of the equal sectors
  };
  ChangedModes with_changes(const RealModes& all) const;
  void check_changes(const RealModes& all, const Matrix& rows) const;

  /// What a number may be in a row of: itself and its slopes, by eta and by the speed.
  enum Slope : Index { itself, along_eta, along_speed };

  /// Motions of all ports of all sectors under the load of each wave, ports x N, and compliances between
  /// ports of sectors that are 0..N-1 apart, a column for each lag: its block, then the slopes of that.
  struct Tuned {
    ComplexMatrix entries;
    std::vector<ComplexMatrix> free;  // by Slope
  };
  Tuned tuned(double eta, double speed) const;
  Index slopes() const { return given_.varies_speed ? 2 : 1; }

  /// D(eta) of all changes, one after the other, with its derivative.
  struct Stiffness {
    ComplexMatrix value;
    ComplexMatrix by_eta;
  };
  Stiffness stiffness(double eta) const;
  ComplexMatrix times_changes(const ComplexMatrix& blocks, const ComplexMatrix& x) const;

  /// Rows of the compliance of the changed whole, with L = C_pB, S = B^T C B, T = (D^-1 + S)^-1 and H = L T:
  ///   C_pc' = C_pc - H_p R_c^T,   C_pc,q' = C_pc,q - V_p H~_c^T - H_p V~_c^T - K_p D_q K~_c^T
  /// by q = eta or the speed, V = L_q - H S_q/2, K = L - H S, and of the motions y' = y - H x with x = B^T y.
  /// R^T = B^T C_c and what has ~ are those of C^T, the same where C is symmetric.
  struct Rows {
    ComplexMatrix left;                // L
    std::vector<ComplexMatrix> slope;  // L_q
    ComplexMatrix held;                // H
    std::vector<ComplexMatrix> rate;   // V
    ComplexMatrix kept;                // K, where D changes with eta
  };
  /// All that is found once for an eta and a speed.
  struct Solved {
    double eta;
    double speed;
    Tuned tuned;
    Stiffness changes;
    ComplexMatrix between;                       // S
    std::vector<ComplexMatrix> between_slope;    // S_q
    Eigen::PartialPivLU<ComplexMatrix> factors;  // of 1 + D S
    Rows contacts;
    Rows forces;  // of C^T, where it is not the same

    const Rows& from() const { return forces.left.size() > 0 ? forces : contacts; }
  };
  std::shared_ptr<const Solved> solved(double eta, double speed) const;
  Rows rows(const Solved& all, const std::vector<std::array<Index, 2>>& places, bool of_forces) const;
  void add_changes(const Solved& all, const Rows& own, double load, VariedReceptance& response) const;

  double rate() const { return given_.circular_frequency * given_.circular_frequency; }  // w^2 over eta^2
  Index count() const { return std::ssize(given_.waves); }
  Index place(Index sector, Index port) const { return sector * ports_ + port; }
  /// Of one port's motion per force on another one, each by `place`.
  Complex entry(const Tuned& tuned, Slope slope, Index to, Index from) const {
    const auto& [to_sector, to_port] = places_[static_cast<std::size_t>(to)];
    const auto& [from_sector, from_port] = places_[static_cast<std::size_t>(from)];
    const Index lag = to_sector - from_sector + (to_sector < from_sector ? count() : 0);
    return tuned.entries((slope * ports_ + from_port) * ports_ + to_port, lag);
  }
  /// Rows of C B, or of C^T B, for ports (sector, port) in a list.
  ComplexMatrix times_rows(const Tuned& tuned, Slope slope, const std::vector<std::array<Index, 2>>& places,
                           bool of_forces) const;
  ComplexMatrix between_rows(const Tuned& tuned, Slope slope) const;
  ComplexVector of_rows(const ComplexMatrix& motions) const;

  Given given_;
  Index ports_;
  bool is_modal_;                                    // whether all waves are sums over modes at rest
  ComplexMatrix turns_;                              // e^{-j a_m i}, m x i
  ComplexMatrix transform_;                          // e^{-j a_m i}/N
  std::vector<bool> is_loaded_;                      // of each wave
  std::vector<std::vector<RingChange::Term>> rows_;  // of all changes
  Matrix stiffness_;                                 // of all changes, one after the other
  Matrix mass_;
  std::vector<std::array<Index, 2>> contacts_;  // sector and port of each
  std::vector<std::array<Index, 2>> places_;    // the same of each `place`
  mutable std::atomic<std::shared_ptr<const Solved>>
      last_;  // that was asked for, which outputs ask for again
};

}  // namespace arcslip
