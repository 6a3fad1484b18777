#include "cases/harmonics_section.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "arcslip/assembly/structures.hpp"
#include "arcslip/motion/swing.hpp"

namespace arcslip {
namespace {

constexpr int highest_harmonic = 2 * most_harmonics - 1;

/// Refuses what is no set of harmonics.
[[noreturn]] void refuse_orders(const TomlSection& section) {
  section.mismatch("harmonics", fmt::format(R"(an odd integer from 1 to {}, a list that holds 1, or "auto")",
                                            highest_harmonic));
}

/// On how many waves a response over several periods travels in its harmonic 1.
Index read_subharmonic_wave(const TomlSection& section, const SystemParameters& system, int periods) {
  const std::vector<Index> waves = subharmonic_waves(system.wave_number, system.elements, periods);
  if (waves.empty())
    section.fail("periods",
                 fmt::format("a response over {0} periods does not travel as the load does: no whole "
                             "number m of waves has {0} m = {1} modulo {2}",
                             periods, system.wave_number, system.elements));
  if (!section.has("subharmonic_wave")) return waves.front();
  const Index given = section.integer("subharmonic_wave", at_least(0));
  if (std::find(waves.begin(), waves.end(), given) == waves.end())
    section.mismatch("subharmonic_wave", fmt::format("{}", fmt::join(waves, " or ")));
  return given;
}

}  // namespace

void read_orders(FrictionSettings& settings, const TomlSection& section) {
  const auto fits = [](double h) { return h >= 0 && h <= highest_harmonic && std::fmod(h, 1) == 0; };
  const toml::node& node = section.require("harmonics", "");
  std::vector<int>& orders = settings.harmonics;
  if (node.value<std::string>() == "auto") {
    settings.harmonics_tolerance = usual_harmonics_tolerance;
  } else if (node.is_array()) {
    const std::vector<double> listed = section.numbers("harmonics", {fits, " that is whole, from 0 to 255"});
    orders.assign(listed.begin(), listed.end());
    const auto first = std::find(orders.begin(), orders.end(), 1);
    if (first == orders.end() || !std::is_sorted(orders.begin(), orders.end(), std::less_equal<>()))
      section.fail("harmonics", "expected a list that holds 1 and ascends");
    std::rotate(orders.begin(), first, first + 1);
  } else {
    if (!node.is_integer() || !fits(static_cast<double>(*node.value<Index>())) || *node.value<Index>() == 0)
      refuse_orders(section);
    orders = odd_up_to(static_cast<int>(*node.value<Index>()));
  }
}

void complete_orders(const TomlSection& section, SystemParameters& system) {
  const toml::node* node = section.has("harmonics") ? &section.require("harmonics", "") : nullptr;
  const auto highest = static_cast<int>(node != nullptr ? node->value<Index>().value_or(1) : 1);
  const bool is_listed = node != nullptr && node->is_array();
  const auto periods = static_cast<int>(
      section.has("periods")
          ? section.integer("periods", within(1, most_periods, fmt::format(" >= 1 and <= {}", most_periods)))
          : 1);
  const bool even = section.has("even_harmonics") && section.boolean("even_harmonics");
  const bool odd = is_odd(system) && !even && periods % 2 == 1;
  if (is_listed) {
    for (const char* key : {"even_harmonics", "periods", "subharmonic_wave"}) {
      if (section.has(key)) section.fail(key, "not beside a list of harmonics");
    }
    if (!is_odd(system) && place_of_mean(system.harmonics) == std::ssize(system.harmonics))
      section.fail("harmonics", "expected 0 among them, the mean, as elements are not odd");
  } else {
    if (odd && highest % 2 == 0) refuse_orders(section);
    system.harmonics = orders_up_to(highest * periods, periods, odd);
  }
  if (periods > 1) {
    system.subharmonic_wave = read_subharmonic_wave(section, system, periods);
  } else if (section.has("subharmonic_wave")) {
    section.fail("subharmonic_wave", "only beside periods > 1");
  }
  if (std::ssize(system.harmonics) > most_orders(system))
    section.fail("harmonics", fmt::format("expected at most {} of them{}, got {}", most_orders(system),
                                          most_orders(system) == most_harmonics ? ""
                                          : is_odd(system) ? " beside elements that slide along two dofs"
                                                           : " beside elements that close",
                                          system.harmonics.size()));
}

void check_waves(const TomlSection& section, const SystemParameters& system) {
  if (system.rotation.per_eta != 0 && feels_rotation(system) && !all_odd(system.harmonics) &&
      place_of_mean(system.harmonics) < std::ssize(system.harmonics))
    section.fail("engine_order",
                 "the mean, which even harmonics call for, is not balanced at a speed that follows "
                 "eta; expected `speed`, or odd harmonics alone");
  for (const int h : system.harmonics) {
    const Index wave = h * system.first_wave() % system.elements;
    try {
      structures_of(system).check(wave, system.elements);
    } catch (const std::invalid_argument& error) {
      section.fail("harmonics",
                   fmt::format("harmonic {}, which travels as {} waves: {}", h, wave, error.what()));
    }
  }
}

}  // namespace arcslip
