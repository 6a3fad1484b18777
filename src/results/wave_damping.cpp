#include "results/wave_damping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>

#include "arcslip/problems/response/nonlinear_mode.hpp"
#include "results/mode_table.hpp"

namespace arcslip {
namespace {

using problems::NonlinearMode;

/// A mode at an amplitude, from stick on.
DampedWave at_amplitude(const NonlinearMode& problem, const Resonance& stuck, double amplitude,
                        double preload) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  DampedWave found{0, 0, amplitude, none, none};
  try {
    const continuation::Guess at = problem.guess(stuck.eta, Eigen::Vector2d(amplitude, preload), {});
    found.eta = at.unknowns(NonlinearMode::frequency);
    found.zeta = at.unknowns(NonlinearMode::damping);
  } catch (const std::invalid_argument&) {  // not found at this amplitude
  }
  return found;
}

/// The system in which the waves of this one run the other way.
SystemParameters other_way(SystemParameters system) {
  system.influence = std::make_shared<const Influence>(system.influence->other_way());
  return system;
}

}  // namespace

std::vector<DampedWave> damping_of_waves(const ProblemRequest& problem, Index highest,
                                         const std::vector<double>& amplitudes) {
  std::vector<DampedWave> all;
  const auto add = [&](const ProblemRequest& one, bool backward) {
    for (const WaveModes& wave : modes_of(one, highest)) {
      if (backward && 2 * wave.wave_number % one.system.elements == 0) continue;
      SystemParameters system = one.system;
      system.varied.clear();
      system.wave_number = wave.wave_number;
      const NonlinearMode mode(build_harmonic_system(system));
      Index number = 0;
      for (const Resonance& stuck : wave.modes) {
        if (stuck.part != "stuck" || !(stuck.eta > 0)) continue;
        ++number;
        for (const double amplitude : amplitudes) {
          all.push_back(at_amplitude(mode, stuck, amplitude, system.preload));
          all.back().wave_number = backward ? -wave.wave_number : wave.wave_number;
          all.back().mode = number;
        }
      }
    }
  };
  add(problem, false);
  if (problem.system.influence) {
    ProblemRequest back = problem;
    back.system = other_way(back.system);
    add(back, true);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const DampedWave& a, const DampedWave& b) { return a.wave_number < b.wave_number; });
  return all;
}

std::string damping_csv(const ProblemRequest& problem, const std::vector<DampedWave>& waves) {
  std::string text = fmt::format("wave_number,mode,R,{},zeta\n", frequency_names(problem));
  for (const DampedWave& one : waves) {
    text += fmt::format("{},{},{:.17g},{},{:.17g}\n", one.wave_number, one.mode, one.amplitude,
                        frequency_columns(problem, one.eta), one.zeta);
  }
  return text;
}

std::string damping_text(const std::vector<DampedWave>& waves, const std::vector<double>& amplitudes) {
  constexpr std::size_t most_columns = 5;
  std::string text = "\nDamping ratio of the first stuck mode at amplitudes R\n\n    n";
  const std::size_t columns = std::min(amplitudes.size(), most_columns);
  for (std::size_t i = 0; i < columns; ++i)
    text += fmt::format("  {:>12}", fmt::format("R = {:g}", amplitudes[i]));
  text += amplitudes.size() > columns ? "  ...\n" : "\n";
  std::map<Index, std::vector<double>> rows;
  for (const DampedWave& one : waves) {
    if (one.mode == 1) rows[one.wave_number].push_back(one.zeta);
  }
  for (const auto& [wave, zetas] : rows) {
    text += fmt::format("{:>5}", wave);
    for (std::size_t i = 0; i < columns; ++i) text += fmt::format("  {:>12.4e}", zetas[i]);
    text += "\n";
  }
  return text;
}

}  // namespace arcslip
