// Elastic Coulomb friction along one dof under a normal force that follows from the motion along another one,
// N = max(0, N_0 + k_n g), with lift-off.

#include "arcslip/elements/element_kind.hpp"
#include "arcslip/elements/pressed/pressed_element.hpp"

namespace arcslip {

ElementKind friction_element() {
  ElementKind kind{
      "friction",
      "dry friction under a normal force that varies, with lift-off",
      {{given_positive("tangential_stiffness", "k_t"), true},
       {not_negative("normal_stiffness", 0, "k_n of the closing displacement g"), true},
       {not_negative("mu", std::numeric_limits<double>::quiet_NaN(), "it slips where its force is mu N"),
        false, 1},
       {any_value("normal_force", 0, "of N = N_0 + k_n g without preload; negative: an open gap of N_0/k_n"),
        true},
       {any_value("normal_per_preload", 0, "and what the preload P adds: N_0 = normal_force + this P"), true,
        -1}},
      [](const ElementKind::Values& values) {
        const auto& s = values.settings;
        return std::make_shared<PressedElement>(
            PressedElement::Settings{s[2], s[0], s[1], s[3], s[4], values.usual_stiffness});
      }};
  kind.has_memory = true;
  kind.follows = true;
  kind.is_odd = false;
  kind.closes = ElementKind::Closing::must;
  return kind;
}

}  // namespace arcslip
