#pragma once

// The coordinates x = L q in which elements act on base and damper: the relative motion u - y of a contact,
// or the motion y of the base's contact dof against ground. Each row of L has an entry for one dof of the
// base, one of the damper, or both. An element that acts in several coordinates has one row after the other.
// With the forces f of the elements against x,
//
//   x_h + C_h f_h = x0_h,   C_h = L blockdiag(C_B, C_D) G^T,   x0 = L (y_0, 0),
//
// where G = L, but for contacts, and elements between both, that act on the damper and not back on the base,
// which have no entry for it.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "arcslip/elements/element.hpp"
#include "arcslip/structure/contact_modes.hpp"

namespace arcslip {

struct HarmonicSystem;
struct SystemParameters;

/// A row of L with the element that acts in it. What is said of the element is said in its first row.
struct Coordinate {
  double base = 0;                         ///< entry of L for the base's dof
  double damper = 0;                       ///< and for the damper's
  Index dof = 0;                           ///< which of their contact dofs
  std::shared_ptr<const Element> element;  ///< may be shared
  bool spares_base = false;                ///< no force on the base
  double factor = 1;                       ///< on the element's force
  bool follows_base = false;               ///< whether its force is told relative to the base's stiffness K*
  /// The element at a value of its setting that is continued, with derivatives by it; null if none is.
  std::function<std::shared_ptr<const Element>(double)> varied = {};

  Index part = 0;         ///< which of its element's coordinates it is
  std::string name = {};  ///< the element's, if it has one
  Index sector = 0;       ///< of a whole ring the one in which it is

  /// Entry of L for a structure, and of G.
  double move(bool is_base) const { return is_base ? base : damper; }
  double push(bool is_base) const { return is_base && spares_base ? 0 : move(is_base); }
};

/// Those of the elements beside the contacts, first the ones with a border; `usual_stiffness`, the static one
/// of base or damper at a contact dof, is asked for each.
std::vector<Coordinate> other_coordinates(const SystemParameters& parameters,
                                          const std::function<double(const Coordinate&)>& usual_stiffness);

/// All of a system, and what its structures do in them.
class Coordinates {
 public:
  /// First the relative motions of the contacts, then the system's further coordinates.
  explicit Coordinates(const HarmonicSystem& system);

  /// All of them, and those of contacts, which have one element each.
  Index size() const { return std::ssize(all_); }
  Index contacts() const { return contacts_; }
  const Coordinate& operator[](Index i) const { return all_[static_cast<std::size_t>(i)]; }

  /// How many elements there are, the e-th with its first coordinate, and that of a coordinate.
  Index elements() const { return std::ssize(first_); }
  const Element& element(Index e) const { return *(*this)[first(e)].element; }
  Index first(Index e) const { return first_[static_cast<std::size_t>(e)]; }
  Index element_of(Index i) const { return element_of_[static_cast<std::size_t>(i)]; }

  /// Lets an element be the only one that holds the mean of its first coordinate; false where it cannot.
  bool let_alone(Index e);

  /// How many, the first ones, of the elements have a border.
  Index switches() const { return switches_; }

  /// Whether elements act but at the contacts.
  bool has_others() const { return size() > contacts_; }

  /// C of one order, and -x0 as its `free`, with their derivatives; `each` is work space.
  struct Each {
    ContactReceptance base;    ///< the structure's own
    ContactReceptance damper;  ///< the same
  };
  void receptance(const ContactModes& base, const ContactModes& damper, double frequency, Each& each,
                  ContactReceptance& joint) const;

  /// The same of structures whose responses are known.
  void join(const ContactReceptance& of_base, const ContactReceptance& of_damper,
            ContactReceptance& joint) const;

  /// Adds the part that one structure has in L C G^T.
  void add(const ContactMatrix& compliance, bool is_base, ContactMatrix& sum) const;

  /// Forces on the contact dofs of a structure in one order, -G^T f.
  void forces_on(bool is_base, const std::vector<ElementForce>& forces, Index order,
                 ContactVector& sum) const;

 private:
  std::vector<Coordinate> all_;
  std::vector<Index> first_;
  std::vector<Index> element_of_;
  Index contacts_;
  Index switches_;
  bool spares_base_;
};

}  // namespace arcslip
