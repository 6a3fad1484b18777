#pragma once

// The rigid motions of base and damper at rest, against which the structures do not hold the mean, the
// harmonic 0. Those that elements may hold, as they move their coordinates, are the columns of S, and
//
//   x_0 + C_0 f_0 = x0_0 + S alpha,   S^H f_0 = l,
//
// with C_0 of what deforms, l the mean load on each and alpha as large as this balance wants. What no element
// tells from others, as that base and damper move together, has no place: columns of the damper come first,
// and one that depends on those before it is left out, so that the base stays where it is.

#include <functional>
#include <string>
#include <vector>

#include "arcslip/assembly/coordinates.hpp"

namespace arcslip {

struct HarmonicSystem;

/// Those of a system; none where the mean is not balanced. Immutable.
class RigidMotions {
 public:
  /// Throws std::invalid_argument where the mean load moves what no element holds, and of structures free to
  /// move that are solved for or whose contacts do not act back.
  RigidMotions(const HarmonicSystem& system, const Coordinates& coordinates);

  /// n, and the position of the harmonic 0 among the orders.
  Index count() const { return std::ssize(all_); }
  Index order() const { return order_; }

  /// S, coordinates x n.
  const ComplexMatrix& moves() const { return moves_; }

  /// l, n.
  const ComplexVector& load() const { return load_; }

  /// alpha over x_0 - x0_0 + C_0 f_0, n x coordinates.
  const ComplexMatrix& parts() const { return parts_; }

  /// How far each moves a contact dof of base or damper, n; of `structure`, which has the same modes.
  ComplexVector at(const ContactModes& structure, bool is_base, Index dof) const;

  /// A number for each, that of its structure.
  Vector of_each(double base, double damper) const;

  /// Motions that are possible while these coordinates are held, n x any number.
  ComplexMatrix loose(const std::function<bool(Index coordinate)>& is_held) const;

  /// What moves in these, "the damper".
  std::string name(const ComplexMatrix& motions) const;

 private:
  struct Motion {
    bool is_base;
    std::size_t mode;  ///< of its structure
  };
  void add(const ContactModes& structure, bool is_base, const Coordinates& coordinates);
  void check_load(const ContactModes& structure, const Complex& load, const ComplexVector& like) const;

  Index order_ = 0;
  std::vector<Motion> all_;
  ComplexMatrix moves_;
  ComplexMatrix held_;  ///< of S the rows of coordinates in which something remembers the mean
  ComplexMatrix parts_;
  ComplexVector load_;
};

}  // namespace arcslip
