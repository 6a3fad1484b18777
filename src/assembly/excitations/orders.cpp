// Engine orders one by one: each with its amplitude and phase.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "arcslip/assembly/excitation.hpp"

namespace arcslip {
namespace {

enum Lists { orders, amplitude, phase };

/// What a list tells of the i-th order; `otherwise` where it is not given.
double entry(const Excitation& load, Lists list, std::size_t i, double otherwise) {
  return load.lists[list].empty() ? otherwise : load.lists[list][i];
}

Complex order_share(const Excitation& load, int h) {
  const std::vector<double>& all = load.lists[orders];
  const auto place = std::find(all.begin(), all.end(), h);
  if (place == all.end()) return 0;
  const auto i = static_cast<std::size_t>(place - all.begin());
  const double angle = entry(load, phase, i, 0);
  const double size = entry(load, amplitude, i, 1);
  return angle == 0 ? Complex(size) : size * Complex(std::cos(angle), std::sin(angle));
}

std::optional<WrongSetting> what_is_wrong(const Excitation& load) {
  const std::vector<double>& all = load.lists[orders];
  if (all.empty()) return WrongSetting{"orders", "expected one order or more, got none"};
  if (!std::is_sorted(all.begin(), all.end(), std::less_equal<>()))
    return WrongSetting{"orders", "expected orders that ascend"};
  for (const auto& [list, name] : {std::pair(amplitude, "amplitude"), std::pair(phase, "phase")}) {
    const std::size_t count = load.lists[list].size();
    if (count != 0 && count != all.size())
      return WrongSetting{name,
                          fmt::format("expected {} numbers, as many as orders, got {}", all.size(), count)};
  }
  if (all.front() == 0 && entry(load, phase, 0, 0) != 0)
    return WrongSetting{"phase",
                        fmt::format("expected 0 of the order 0, the mean, got {}", entry(load, phase, 0, 0))};
  return {};
}

}  // namespace

ExcitationKind orders_excitation() {
  const Setting order{"orders", 0, 0, 255, true, "h, at the frequency h eta on h n waves; 0 is the mean"};
  return {"orders",
          "engine orders, each with its amplitude and phase: p_0 + Re sum p_h e^{j h theta} at node 1",
          {},
          {{order},
           {any_value("amplitude", 1, "|p_h|/F of each order, negative in antiphase"), "1 of each"},
           {any_value("phase", 0, "of p_h, radians"), "0 of each"}},
          order_share,
          [](const Excitation& load) {
            const std::vector<double>& all = load.lists[orders];
            return std::all_of(all.begin(), all.end(), [](double h) { return static_cast<int>(h) % 2 == 1; });
          },
          what_is_wrong,
          [](const Excitation& load) {
            return std::vector<int>(load.lists[orders].begin(), load.lists[orders].end());
          }};
}

}  // namespace arcslip
