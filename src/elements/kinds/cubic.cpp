// f = k_3 x^3: hardening, or softening where k_3 < 0.

#include "arcslip/elements/element_kind.hpp"
#include "arcslip/elements/memoryless.hpp"

namespace arcslip {

ElementKind cubic_element() {
  return {
      "cubic",
      "a spring of force k_3 x^3",
      {{any_value("coefficient", std::numeric_limits<double>::quiet_NaN(), "k_3, negative where it softens"),
        true}},
      [](const ElementKind::Values& values) {
        return cubic_spring(values.settings[0], values.usual_stiffness);
      }};
}

}  // namespace arcslip
