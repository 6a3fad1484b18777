#pragma once

// Numbers of the sectors of a whole ring, as case files give them: a list, a CSV file, or a scatter.

#include <cstdint>
#include <string>
#include <vector>

#include "keys/key_table.hpp"

namespace arcslip {

/// Deviations z_i of N sectors round a ring: of mean 0 and variance 1, the same with every standard library,
/// normal, and correlated over the distance d between sectors as exp(-(d/L)^2/2), or not at all where L = 0.
std::vector<double> scattered(Index count, std::uint64_t seed, double correlation);

/// The seed of a pattern of the same scatter: of the pattern 1 the seed itself.
std::uint64_t seed_of_pattern(std::uint64_t seed, std::uint64_t pattern);

/// A table of numbers scatters about 1.
struct ScatterSettings {
  /// How factors follow from z.
  enum class Law {
    lognormal,  ///< exp(s z - s^2/2): of mean 1 and standard deviation `scatter`
    normal      ///< 1 + scatter z
  };
  double scatter = 0;
  Index seed = 1;
  double correlation = 0;  ///< L, in sectors
  Law law = Law::lognormal;
};

/// Its keys.
const KeyTable<ScatterSettings>& scatter_keys();

/// Rows of numbers of a file that a key names, between commas; what follows # on a line is a comment. Throws
/// InputError.
std::vector<std::vector<double>> number_rows(const TomlSection& section, const std::string& key);

/// The same from a file, or from a list of rows or of single numbers, which are `expected`. Throws
/// InputError.
std::vector<std::vector<double>> listed_rows(const TomlSection& section, const std::string& key,
                                             const std::string& expected);

/// Factors on something in each of N sectors, all > 0: `each` numbers a sector, which follow one another, or
/// one for all of its. A scatter gives those of one pattern, of the pattern 0 all 1. Throws InputError.
std::vector<double> factors_of_sectors(const TomlSection& section, const std::string& key, Index sectors,
                                       Index each, Index pattern);

/// Numbers of sectors, from 1 to N, as they count from 0. Throws InputError.
std::vector<Index> listed_sectors(const TomlSection& section, const std::string& key, Index sectors);

}  // namespace arcslip
