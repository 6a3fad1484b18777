#pragma once

// A finite-element sector as one travelling wave sees it, in sparse matrices:
//
//   A(a) = T^H A T,   T : (d_L, d_I) -> (d_L, d_I, d_L e^{-ja}),   A = M, C, K, G, K_2
//
// All of them, and those of every a, have one pattern of entries, so that one symbolic analysis serves them
// all.

#include <vector>

#include "arcslip/sectors/finite_sector.hpp"

namespace arcslip {

/// Compressed by columns.
using ComplexSparseMatrix = Eigen::SparseMatrix<Complex>;

/// Owns all that it needs of the sector.
class SectorReduction {
 public:
  /// `sector` is checked. Reduces for a = 0.
  explicit SectorReduction(const FiniteSector& sector);

  /// Reduces for another propagation constant, given as e^{-ja}. Allocates nothing.
  void set_forward(Complex forward);

  /// Hermitian, one row for each dof of the left boundary and then of the interior.
  const ComplexSparseMatrix& mass() const { return mass_.reduced; }
  const ComplexSparseMatrix& stiffness() const { return stiffness_.reduced; }
  const ComplexSparseMatrix& damping() const { return damping_.reduced; }  ///< 0 x 0: none
  /// G, skew-Hermitian, and K_2; 0 x 0: none.
  const ComplexSparseMatrix& gyroscopic() const { return gyroscopic_.reduced; }
  const ComplexSparseMatrix& stiffness_speed2() const { return stiffness_speed2_.reduced; }
  const ComplexVector& load() const { return load_; }

  /// Of reduced dofs.
  Index size() const { return map_.size; }
  /// Reduced dof of a dof of the sector.
  Index reduced_dof(Index dof) const { return map_.reduced[static_cast<std::size_t>(dof)]; }
  /// What its reduced dof is multiplied by to give this dof: e^{-ja} on the right boundary, else 1.
  Complex factor(Index dof) const { return map_.is_right[static_cast<std::size_t>(dof)] ? forward_ : 1.0; }

 private:
  struct Coupling {  ///< an entry with one dof on the right
    int entry;
    bool ahead;  ///< its column is: it carries e^{-ja}, else e^{ja}
    double value;
  };
  struct Part {
    std::vector<double> within;  ///< for each entry of the pattern what no a changes
    std::vector<Coupling> couplings;
    ComplexSparseMatrix reduced;
  };

  Part part(const SparseMatrix& matrix, const ComplexSparseMatrix& pattern) const;
  void reduce(Part& part) const;

  SectorMap map_;
  Complex forward_ = 1;
  ComplexVector sector_load_;
  Part mass_;
  Part stiffness_;
  Part damping_;
  Part gyroscopic_;
  Part stiffness_speed2_;
  ComplexVector load_;
};

/// Largest quotient of the diagonals of stiffness and mass: a bound from below of the largest w*^2, close to
/// it. The mass is positive definite.
double largest_square(const SectorReduction& reduction);

/// Refuses a reduced mass that is not positive definite by 1e-12 of its diagonal. Throws SectorError naming a
/// dof of `sector`, the first without which the mass of it and of those eliminated before is definite.
void check_mass(const FiniteSector& sector, const SectorReduction& reduction);

}  // namespace arcslip
