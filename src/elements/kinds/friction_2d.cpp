// Elastic Coulomb friction along two dofs, the friction circle, under a normal force that follows from the
// motion along a third one, N = max(0, N_0 + k_n g), with lift-off, or that is constant.

#include "arcslip/elements/circle/circle_element.hpp"
#include "arcslip/elements/element_kind.hpp"

namespace arcslip {

ElementKind friction_element();

ElementKind friction_2d_element() {
  ElementKind kind{
      "friction_2d",
      "dry friction in a plane, along two dofs together, with lift-off along a third one if there is one",
      friction_element().settings, [](const ElementKind::Values& values) {
        const auto& s = values.settings;
        return std::make_shared<CircleElement>(
            CircleElement::Settings{s[2], s[0], s[1], s[3], s[4], values.usual_stiffness}, values.closes);
      }};
  kind.settings[2] = {given_positive("mu", "it slips where its force is mu N in any direction"), false, 1};
  kind.has_memory = true;
  kind.follows = true;
  kind.slides = 2;
  kind.closes = ElementKind::Closing::may;
  return kind;
}

}  // namespace arcslip
