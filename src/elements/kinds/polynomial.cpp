// f = k_1 x + k_3 x^3 + k_5 x^5: a linear spring where k_1 alone is given.

#include <cmath>

#include "arcslip/elements/element_kind.hpp"
#include "arcslip/elements/memoryless.hpp"

namespace arcslip {

ElementKind polynomial_element() {
  return {"polynomial",
          "a spring of force k_1 x + k_3 x^3 + k_5 x^5",
          {{any_value("linear", 0, "k_1"), true},
           {any_value("cubic", 0, "k_3"), true},
           {any_value("quintic", 0, "k_5"), true}},
          [](const ElementKind::Values& values) {
            const auto& k = values.settings;
            constexpr double endless = std::numeric_limits<double>::infinity();
            return std::make_shared<MemorylessElement>(PiecewiseLaw({{endless, {0, k[0], 0, k[1], 0, k[2]}}}),
                                                       values.usual_stiffness + std::abs(k[0].value));
          }};
}

}  // namespace arcslip
