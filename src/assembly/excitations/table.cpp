// Any load, by its values at equal distances over a wavelength, which is one turn where the load has one
// wave: what a node feels over a period. Between them it is the trigonometric polynomial through them.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arcslip/assembly/excitation.hpp"

namespace arcslip {
namespace {

/// p_h/F of the values at theta = 2 pi k/K, k = 0, ..., K - 1.
Complex table_share(const Excitation& load, int h) {
  const std::vector<double>& values = load.lists[0];
  const auto count = static_cast<int>(values.size());
  if (2 * h > count) return 0;
  Complex sum = 0;
  for (int k = 0; k < count; ++k)
    sum += values[static_cast<std::size_t>(k)] *
           std::polar(1.0, -two_pi * (static_cast<long>(h) * k % count) / count);
  const bool is_whole = h == 0 || 2 * h == count;  // not one of two
  return is_whole ? Complex(sum.real() / count) : 2.0 / count * sum;
}

/// Whether it is nothing but rounding.
bool is_nothing(const Excitation& load, int h) {
  double most = 0;
  for (const double value : load.lists[0]) most = std::max(most, std::abs(value));
  return std::abs(table_share(load, h)) <= 1e-14 * most;
}

int highest(const Excitation& load) {
  auto h = static_cast<int>(load.lists[0].size() / 2);
  while (h > 0 && is_nothing(load, h)) --h;
  return h;
}

}  // namespace

ExcitationKind table_excitation() {
  return {"table",
          "values at equal distances over a period, in all harmonics that they tell",
          {},
          {{any_value("values", 0, "of the load over F at theta = 0, 2 pi/K, ...: K of them"), "", true}},
          table_share,
          [](const Excitation& load) {
            for (int h = 0; h <= highest(load); h += 2) {
              if (!is_nothing(load, h)) return false;
            }
            return true;
          },
          [](const Excitation& load) -> std::optional<WrongSetting> {
            if (load.lists[0].size() < 3)
              return WrongSetting{"values", fmt::format("expected 3 or more, got {}", load.lists[0].size())};
            if (highest(load) == 0) return WrongSetting{"values", "expected values that differ"};
            return {};
          }};
}

}  // namespace arcslip
