#pragma once

// Response of a finite-element sector under a travelling wave at its contact dofs and outputs:
//
//   Z(eta) = K (1 + j (beta eta + delta)) + j w* (C + 2 pi mu M) - w*^2 M,   w* = 2 pi eta
//   c   = E^T Z^{-1} E        dc/deta   = -X_l^T Z' X_r,   X_r = Z^{-1} E,  X_l = Z^{-T} E
//   y_0 = E^T Z^{-1} F        dy_0/deta = -X_l^T Z' Z^{-1} F
//
// to which a speed Omega adds Omega^2 K_2 + j w* Omega G, of which the losses are no part; slopes by the
// speed follow in the same way.
//
// and of outputs, which are dofs, the same entries of -Z^{-1} Z' X_r and -Z^{-1} Z' Z^{-1} F.
//
// E has a column for each contact, with 1 at its dof and -1 at that which it is against. One symbolic
// analysis serves the sparse LU factorisations of Z at every eta.

#include <memory>

#include "arcslip/sectors/sector_reduction.hpp"
#include "arcslip/structure/modal_model.hpp"
#include "arcslip/structure/rotation.hpp"

namespace arcslip {

class ComplexFactors;

/// Motions of m contacts and p outputs at a given eta, or how they change.
struct SectorMotions {
  ComplexMatrix compliance;  ///< c, m x m: motion of the contact of the row per force on that of the column
  ComplexVector free;        ///< y_0, m: the response without contact
  ComplexMatrix output_compliance;  ///< p x m: motion of the outputs per force on a contact
  ComplexVector output_free;        ///< p: motion of the outputs without contact
  ComplexVector load_motion;        ///< m+1: X^T F*, the motion F^H d that the load does work on

  /// Gives all of them their size, filled with a number.
  void fill(Index contacts, Index outputs, const Complex& value);
};

/// The response, of X = [X_r, Z^{-1} F].
struct SectorResponse : SectorMotions {
  SectorMotions by_eta;    ///< its derivatives
  SectorMotions by_speed;  ///< and those by the speed, zero at rest
  ComplexMatrix damping;   ///< X^H Im Z X, m+1 x m+1: by pi what damping takes a cycle
};

/// Serves one thread. Owns all that it needs of the sector.
class SectorSolver {
 public:
  /// `sector` is checked, `forward` is e^{-ja}. `loss` is that of damping proportional to stiffness and mass,
  /// beside the sector's own C; modal damping is no part of Z. Throws SectorError where the reduced mass is
  /// not positive definite.
  SectorSolver(const FiniteSector& sector, Complex forward, const Loss& loss);
  ~SectorSolver();
  SectorSolver(const SectorSolver&) = delete;
  SectorSolver& operator=(const SectorSolver&) = delete;

  /// The response at eta and a speed, in revolutions, valid until the next call. Throws std::domain_error
  /// where Z is singular.
  const SectorResponse& at(double eta, double speed = 0);

  /// The matrices that Z is made of.
  const SectorReduction& reduction() const { return reduction_; }

  /// m, p, and how many factorisations there were.
  Index contacts() const { return std::ssize(contacts_); }
  Index outputs() const { return std::ssize(outputs_); }
  int factorisations() const;  ///< since the start, all with one symbolic analysis

 private:
  void assemble(double eta);
  void turn(double eta, double speed);
  void set_right_hand_sides();
  void collect();
  void collect_slopes(const ComplexSparseMatrix& slope, SectorMotions& slopes);
  void collect_works(double eta);

  SectorReduction reduction_;
  Loss loss_;
  struct Contact {
    Index dof;      // reduced
    Index against;  // as well, or ground
  };
  std::vector<Contact> contacts_;
  std::vector<Index> outputs_;             // dofs of the sector
  ComplexSparseMatrix dynamic_stiffness_;  // Z
  ComplexSparseMatrix slope_;              // dZ/deta
  ComplexSparseMatrix speed_slope_;        // dZ by the speed, of a sector that feels it
  ComplexMatrix right_;                    // X_r and Z^{-1} F
  ComplexMatrix left_;                     // X_l and Z^{-T} F*
  ComplexMatrix product_;                  // Z' or Im Z times `right_`
  SectorResponse response_;
  std::unique_ptr<ComplexFactors> factors_;
};

}  // namespace arcslip
