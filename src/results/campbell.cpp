#include "results/campbell.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "arcslip/assembly/resonances.hpp"
#include "arcslip/assembly/structures.hpp"
#include "results/mode_table.hpp"

namespace arcslip {
namespace {

/// The system's wave and the one that runs the other way, if that is another one.
std::vector<Index> both_ways(const SystemParameters& system) {
  const Index n = std::abs(system.wave_number);
  if (2 * n % system.elements == 0) return {n};
  return {n, -n};
}

/// Of one wave at rest, to be varied in its speed over the range.
SystemParameters over_speeds(const SystemParameters& system, Index wave, const CampbellRange& range) {
  SystemParameters one = system;
  one.harmonics = {1};
  one.wave_number = wave;
  one.rotation = {range.low, 0};
  one.varied = "speed";
  one.speed_low = range.low;
  one.speed_high = range.high;
  return one;
}

}  // namespace

void check_campbell(const SystemParameters& system) {
  if (!structures_of(system).feels_rotation())
    throw std::invalid_argument(
        "a Campbell diagram is of sectors that feel rotation, by `gyroscopic` or `stiffness_speed2`");
}

std::string campbell_csv(const ProblemRequest& problem, const CampbellRange& range) {
  constexpr int count = 101;
  std::string text = fmt::format("speed,wave_number,part,mode,{},zeta\n", frequency_names(problem));
  for (const Index wave : both_ways(problem.system)) {
    const SystemParameters system = over_speeds(problem.system, wave, range);
    const ContactSystem slow = build_wave(system);
    for (int i = 0; i < count; ++i) {
      const double part = static_cast<double>(i) / (count - 1);
      const double speed = range.low + part * (range.high - range.low);
      ContactSystem at = slow;
      at.base = slow.base.varied({.loss = slow.base.loss(), .speed = speed - range.low});
      at.damper = slow.damper.varied({.loss = slow.damper.loss(), .speed = speed - range.low});
      for_each_mode(resonances(at), [&](const Resonance& mode, Index number) {
        if (system.eta_high > 0 && mode.eta > system.eta_high) return;
        text += fmt::format("{:.17g},{},{},{},{},{:.17g}\n", speed, wave, mode.part, number,
                            frequency_columns(problem, mode.eta), mode.damping);
      });
    }
  }
  return text;
}

std::string crossings_csv(const ProblemRequest& problem, const CampbellRange& range) {
  std::string text = fmt::format("engine_order,wave_number,part,mode,speed,{}\n", frequency_names(problem));
  const Index sectors = problem.system.elements;
  for (Index order = 1; order <= 2 * sectors; ++order) {
    for (const Index wave : both_ways(problem.system)) {
      if ((order + wave) % sectors != 0) continue;
      SystemParameters system = problem.system;
      system.harmonics = {1};
      system.varied.clear();
      system.wave_number = wave;
      system.rotation = {0, 1 / static_cast<double>(order)};
      for_each_mode(resonances(build_wave(system)), [&](const Resonance& mode, Index number) {
        const double speed = system.rotation.at(mode.eta);
        if (!(speed >= range.low && speed <= range.high) || mode.eta > system.eta_high) return;
        text += fmt::format("{},{},{},{},{:.17g},{}\n", order, wave, mode.part, number, speed,
                            frequency_columns(problem, mode.eta));
      });
    }
  }
  return text;
}

}  // namespace arcslip
