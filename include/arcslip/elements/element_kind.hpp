#pragma once

// The elements that [[element]] of a case file may name. Each is one file in src/elements/kinds: NAME.cpp
// defines `ElementKind NAME_element()`, and the build finds it.

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "arcslip/elements/element.hpp"
#include "arcslip/setting.hpp"

namespace arcslip {

/// A kind of element.
struct ElementKind {
  /// What one is made of.
  struct Values {
    std::vector<Jet> settings;   ///< in their order, with derivatives by one of them if it is continued
    double usual_stiffness = 1;  ///< the static one that its coordinate meets, > 0
    double rate = two_pi;        ///< w over eta, in the time that the structure's masses are given in
    bool closes = false;         ///< whether there is a closing coordinate
  };

  std::string name;     ///< what case files call it
  std::string meaning;  ///< one line

  /// A number that it takes.
  struct Value : Setting {
    bool scales_force = false;  ///< whether the force is proportional to all such values together
    int power_of_friction = 0;  ///< of a factor on all friction coefficients, where the load has it as well
  };
  std::vector<Value> settings;                                        ///< all of them
  std::function<std::shared_ptr<const Element>(const Values&)> make;  ///< one with these values
  bool has_memory = false;       ///< whether its force follows from the way that the motion has taken
  bool follows = false;          ///< whether small disturbances are followed through that memory
  bool is_odd = true;            ///< whether an odd motion meets an odd force
  bool takes_any_orders = true;  ///< whether even orders and 0 may be balanced beside it
  Index slides = 1;              ///< along how many coordinates it acts before a closing one

  /// Whether it acts along a closing coordinate, which makes it one that is not odd.
  enum class Closing { cannot, may, must } closes = Closing::cannot;
};

/// All of them, in alphabetical order.
const std::vector<ElementKind>& element_kinds();

/// The one of this name, or null.
const ElementKind* find_element_kind(const std::string& name);

}  // namespace arcslip
