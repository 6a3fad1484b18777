// Stops on both sides, which the motion meets beyond a clearance g: f = k (x -+ g) for |x| > g, else 0.

#include "arcslip/elements/element_kind.hpp"
#include "arcslip/elements/memoryless.hpp"

namespace arcslip {

ElementKind clearance_element() {
  return {
      "clearance",
      "elastic stops on both sides of a clearance",
      {{given_positive("stiffness", "k of the stops"), true}, {given_positive("gap", "g, to each side")}},
      [](const ElementKind::Values& values) {
        const Jet k = values.settings[0];
        const Jet g = values.settings[1];
        constexpr double endless = std::numeric_limits<double>::infinity();
        return std::make_shared<MemorylessElement>(PiecewiseLaw({{g, {}}, {endless, {-k * g, k}}}), k.value);
      }};
}

}  // namespace arcslip
