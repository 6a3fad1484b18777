// A stop on one side, which the motion meets beyond a gap g: f = k (x - g) for x > g, else 0. One that
// presses at rest, g < 0, is told from that rest: f + k g, and k g where it is left.

#include <algorithm>

#include "arcslip/elements/element_kind.hpp"
#include "arcslip/elements/memoryless.hpp"

namespace arcslip {

ElementKind unilateral_element() {
  ElementKind kind{
      "unilateral",
      "an elastic stop on one side of a gap",
      {{given_positive("stiffness", "k of the stop"), true},
       {any_value("gap", std::numeric_limits<double>::quiet_NaN(), "g; negative where it presses at rest"),
        false}},
      [](const ElementKind::Values& values) {
        const Jet k = values.settings[0];
        const Jet g = values.settings[1];
        constexpr double endless = std::numeric_limits<double>::infinity();
        const Jet rest = g.value < 0 ? k * g : Jet(0);
        return std::make_shared<MemorylessElement>(
            PiecewiseLaw({{g, {rest}}, {endless, {rest - k * g, k}}}, true), k.value);
      }};
  kind.is_odd = false;
  return kind;
}

}  // namespace arcslip
