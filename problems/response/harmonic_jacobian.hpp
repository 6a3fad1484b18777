#pragma once

// dF/du of large rings, of which most contacts stick: with the rows of F in all harmonics h,
//
//   w_h (f_h/K + A_h (x - f/K - x0)_h) /|x|,   A_h = (1 + C_h K)^{-1},
//
// it is diag(w) (1 + S E) less what |x| adds, S = 1 - A, E = f'/K - 1 by elements: zero of what sticks.

#include <vector>

#include "arcslip/continuation/linear/condensed_jacobian.hpp"
#include "arcslip/structure/contact_modes.hpp"

namespace arcslip::problems {

class HarmonicJacobian final : public continuation::CondensedJacobian {
 public:
  /// Of so many coordinates in so many harmonics; `sectors` has that of each coordinate.
  HarmonicJacobian(Index harmonics, std::vector<Index> sectors);

  /// What of a harmonic does not depend on the elements: A_h and w_h.
  void set_order(Index order, const ContactMatrix& inverse, double weight);

  /// E of an element, in which the harmonics of a coordinate follow one another, by Re and Im; those that are
  /// not told are zero.
  void clear_elements();
  Matrix& add_element(Index first, Index coordinates);

  /// Of F = .../|u|.
  void set_size(const Vector& residual, const Vector& u);

  void couple(const Vector& x, Vector& out) const override;
  void couple_transposed(const Vector& x, Vector& out) const override;
  void couple_absolute(const Vector& x, Vector& out) const override;
  void fill(Matrix& k) const override;
  /// None where sectors differ in how many coordinates they have.
  std::unique_ptr<continuation::Preconditioner> precondition() const override;

 private:
  struct Block {
    Index first;  // of its coordinates
    Index coordinates;
    Matrix change;  // E
  };
  Index place(Index coordinate, Index order) const { return 2 * (coordinate * harmonics_ + order); }
  Index count() const { return static_cast<Index>(sectors_.size()); }

  std::vector<ComplexMatrix> waves() const;

  Index harmonics_;
  std::vector<Index> sectors_;               // of each coordinate
  std::vector<std::vector<Index>> members_;  // the coordinates of each sector
  std::vector<ContactMatrix> stuck_;         // S of each harmonic
  std::vector<Block> blocks_;
};

}  // namespace arcslip::problems
