#pragma once

// A matrix close to 1 + S E of a whole ring [see harmonic_jacobian.hpp]. S is taken for that of equal sectors
// (the mean of what sectors as far apart do to one another), whose waves m have s(m) between the coordinates
// of one sector in each harmonic: what the waves have in common, the median L, acts in each sector alone; of
// what they have besides the strongest parts are kept,
//
//   S ~ L + sum_t u_t sigma_t v_t^H   by singular values of s(m) - L,
//
// so that
//
//   M = B + U (Sigma V^H E),   B = 1 + L E in each sector,
//   M^{-1} = B^{-1} - B^{-1} U W^{-1} Sigma V^H E B^{-1},   W = 1 + Sigma V^H E B^{-1} U.
//
// E is as it is, be contacts alike or not, stuck or slipping: whatever is mixed, what is left to iterations
// is small.

#include <memory>
#include <vector>

#include "arcslip/continuation/linear/condensed_jacobian.hpp"
#include "arcslip/continuation/linear/dense_bordered_solver.hpp"

namespace arcslip::problems {

class HarmonicPreconditioner final : public continuation::Preconditioner {
 public:
  /// An active unknown: in which sector, which of its coordinates, harmonic, and whether Re (0) or Im (1).
  struct Place {
    Index sector;
    Index coordinate;
    Index order;
    Index part;
  };

  /// `waves` has s(m) of each harmonic, one block of c x c after the other in c x cN; `changes` E between the
  /// active unknowns of each sector, in the order of `places`.
  HarmonicPreconditioner(Index sectors, std::vector<ComplexMatrix> waves, std::vector<Place> places,
                         const std::vector<Matrix>& changes);

  void solve(Vector& x) override { solve(x, false); }
  void solve_transposed(Vector& x) override { solve(x, true); }
  double sign() const override { return sign_; }
  void multiply_determinant(continuation::LogProduct& product) const override;

 private:
  /// A part that is kept.
  struct Kept {
    Index wave;
    Index order;
    double size;  // sigma
    ComplexVector left;
    ComplexVector right;
  };
  using Factors = std::unique_ptr<continuation::DenseBorderedSolver>;
  struct Sector {
    std::vector<Index> places;  // of its active unknowns
    Matrix change;              // E
    Factors local;              // of B
  };
  void keep(const std::vector<ComplexMatrix>& waves, std::vector<ComplexMatrix>& common);
  void set_sectors(const std::vector<Matrix>& changes, const std::vector<ComplexMatrix>& common);
  void set_between();
  Factors factored(const Matrix& matrix);
  void solve(Vector& x, bool transposed);
  Vector project(const std::vector<ComplexMatrix>& motions, bool left) const;
  std::vector<ComplexMatrix> combine(const Vector& amounts, bool left) const;
  std::vector<ComplexMatrix> blank() const;
  void take(const Sector& sector, Index index, const Vector& values,
            std::vector<ComplexMatrix>& motions) const;
  Vector give(const Sector& sector, Index index, const std::vector<ComplexMatrix>& motions) const;

  Index count_;  // of sectors
  Index each_;   // coordinates of one
  Index harmonics_;
  std::vector<Place> places_;
  std::vector<Sector> sectors_;
  std::vector<Kept> kept_;
  ComplexMatrix phases_;  // e^{-j a_m i}/sqrt(N), i x m
  Factors between_;       // of W
  double sign_ = 1;
};

}  // namespace arcslip::problems
