#include "results/mode_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <map>
#include <set>

#include "arcslip/assembly/structures.hpp"
#include "arcslip/sectors/finite_sector.hpp"

namespace arcslip {
namespace {

constexpr std::array part_names = {"base", "damper", "stuck"};

/// From 0 or, of rings, from 1 to as many as N nodes tell apart.
std::pair<Index, Index> waves_of(const SystemParameters& system) {
  if (system.structures == nullptr) return {1, (system.elements - 1) / 2};
  return {feels_rotation(system) ? -(system.elements - 1) / 2 : 0, system.elements / 2};
}

/// Of one wave; a free ring that turns has none where it moves as a whole, which is no reason to tell none at
/// all.
WaveModes wave_modes(const SystemParameters& system, Index own) {
  const Index n = system.wave_number;
  structures_of(system).check(n, system.elements);
  try {
    return {n, resonances(system, build_wave(system)), ""};
  } catch (const SectorError& error) {
    if (!feels_rotation(system) || std::abs(n) == std::abs(own)) throw;
    return {n, {}, error.what()};
  }
}

}  // namespace

std::string frequency_names(const ProblemRequest& problem) {
  return problem.physical ? "eta,frequency_Hz" : "eta";
}

std::string frequency_columns(const ProblemRequest& problem, double eta) {
  const std::string text = fmt::format("{:.17g}", eta);
  return problem.physical ? fmt::format("{},{:.17g}", text, problem.physical->frequency(eta)) : text;
}

std::vector<WaveModes> modes_of(const ProblemRequest& problem, Index highest) {
  SystemParameters system = problem.system;
  system.harmonics = {1};
  system.rotation.per_eta = 0;  // an order has one wave: at rest
  const auto [first, last] = waves_of(system);
  std::vector<WaveModes> waves;
  for (Index n = std::max(first, -highest); n <= std::min(last, highest); ++n) {
    system.wave_number = n;
    waves.push_back(wave_modes(system, problem.system.wave_number));
    if (system.eta_high > 0)
      std::erase_if(waves.back().modes, [&](const Resonance& mode) { return mode.eta > system.eta_high; });
  }
  return waves;
}

std::string modes_csv(const ProblemRequest& problem, const std::vector<WaveModes>& waves) {
  std::string text = fmt::format("wave_number,part,mode,{},zeta\n", frequency_names(problem));
  for (const WaveModes& wave : waves) {
    for_each_mode(wave.modes, [&](const Resonance& mode, Index number) {
      text += fmt::format("{},{},{},{},{:.17g}\n", wave.wave_number, mode.part, number,
                          frequency_columns(problem, mode.eta), mode.damping);
    });
  }
  return text;
}

std::string modes_text(const ProblemRequest& problem, const std::vector<WaveModes>& waves) {
  constexpr std::size_t most_columns = 6;
  constexpr std::size_t most_rows = 40;
  const auto& scale = problem.physical;
  using Column = std::pair<std::size_t, Index>;  // part, number within it
  std::set<Column> columns;
  std::vector<std::map<Column, std::string>> rows;
  for (const WaveModes& wave : waves) {
    auto& row = rows.emplace_back();
    for_each_mode(wave.modes, [&](const Resonance& mode, Index number) {
      const auto part = std::find(part_names.begin(), part_names.end(), mode.part) - part_names.begin();
      const Column column(part, number);
      columns.insert(column);
      row[column] =
          fmt::format("{:.6g} {:7.1e}", scale ? scale->frequency(mode.eta) : mode.eta, mode.damping);
    });
  }
  const std::vector<Column> shown(
      columns.begin(),
      std::next(columns.begin(), static_cast<std::ptrdiff_t>(std::min(columns.size(), most_columns))));
  std::string text = fmt::format("{} and damping ratio of each mode\n\n{:>5}",
                                 scale ? "Frequency in Hz" : "Frequency eta", "n");
  for (const auto& [part, number] : shown)
    text += fmt::format("  {:>18}", fmt::format("{} {}", part_names[part], number));
  text += columns.size() > shown.size() ? "  ...\n" : "\n";
  for (std::size_t i = 0; i < std::min(rows.size(), most_rows); ++i) {
    text += fmt::format("{:>5}", waves[i].wave_number);
    if (!waves[i].refusal.empty())
      text += "  none: " + waves[i].refusal;
    else
      for (const Column& column : shown) text += fmt::format("  {:>18}", rows[i][column]);
    text += "\n";
  }
  if (rows.size() > most_rows) text += fmt::format("... and {} more\n", rows.size() - most_rows);
  return text;
}

}  // namespace arcslip
