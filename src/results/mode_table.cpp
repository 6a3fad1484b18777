#include "results/mode_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "arcslip/assembly/structures.hpp"

namespace arcslip {
namespace {

/// From 0 or, of rings, from 1 to as many as N nodes tell apart.
std::pair<Index, Index> waves_of(const SystemParameters& system) {
  if (system.structures == nullptr) return {1, (system.elements - 1) / 2};
  return {0, system.elements / 2};
}

/// Calls `visit` with the number of each mode within its part, from 1.
template <class Visit>
void for_each_mode(const WaveModes& wave, const Visit& visit) {
  std::map<std::string, Index> numbers;
  for (const Resonance& mode : wave.modes) visit(mode, ++numbers[mode.part]);
}

}  // namespace

std::vector<WaveModes> modes_of(const ProblemRequest& problem, Index highest) {
  SystemParameters system = problem.system;
  system.harmonics = {1};
  const auto [first, last] = waves_of(system);
  std::vector<WaveModes> waves;
  for (Index n = first; n <= std::min(last, highest); ++n) {
    system.wave_number = n;
    structures_of(system).check(n, system.elements);
    waves.push_back({n, resonances(system, build_wave(system))});
  }
  return waves;
}

std::string modes_csv(const ProblemRequest& problem, const std::vector<WaveModes>& waves) {
  const auto& scale = problem.physical;
  std::string text = fmt::format("wave_number,part,mode,eta,{}zeta\n", scale ? "frequency_Hz," : "");
  for (const WaveModes& wave : waves) {
    for_each_mode(wave, [&](const Resonance& mode, Index number) {
      text += fmt::format("{},{},{},{:.17g},", wave.wave_number, mode.part, number, mode.eta);
      if (scale) text += fmt::format("{:.17g},", scale->frequency(mode.eta));
      text += fmt::format("{:.17g}\n", mode.damping);
    });
  }
  return text;
}

std::string modes_text(const ProblemRequest& problem, const std::vector<WaveModes>& waves) {
  constexpr std::size_t most_columns = 6;
  constexpr std::size_t most_rows = 40;
  const auto& scale = problem.physical;
  std::vector<std::string> columns;
  std::vector<std::map<std::string, std::string>> rows;
  for (const WaveModes& wave : waves) {
    auto& row = rows.emplace_back();
    for_each_mode(wave, [&](const Resonance& mode, Index number) {
      const std::string name = fmt::format("{} {}", mode.part, number);
      if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.push_back(name);
      row[name] = fmt::format("{:.6g} {:7.1e}", scale ? scale->frequency(mode.eta) : mode.eta, mode.damping);
    });
  }
  // Part by part, whichever wave brought a mode first.
  const auto rank = [](const std::string& name) {
    return std::pair(name[0] == 's' ? 2 : name[0] == 'd', name.size());
  };
  std::stable_sort(columns.begin(), columns.end(), [&](const std::string& a, const std::string& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : a < b;
  });
  std::string text = fmt::format("{} and damping ratio of each mode\n\n{:>5}",
                                 scale ? "Frequency in Hz" : "Frequency eta", "n");
  const std::size_t shown = std::min(columns.size(), most_columns);
  for (std::size_t i = 0; i < shown; ++i) text += fmt::format("  {:>18}", columns[i]);
  text += columns.size() > shown ? "  ...\n" : "\n";
  for (std::size_t i = 0; i < std::min(rows.size(), most_rows); ++i) {
    text += fmt::format("{:>5}", waves[i].wave_number);
    for (std::size_t k = 0; k < shown; ++k) text += fmt::format("  {:>18}", rows[i][columns[k]]);
    text += "\n";
  }
  if (rows.size() > most_rows) text += fmt::format("... and {} more\n", rows.size() - most_rows);
  return text;
}

}  // namespace arcslip
