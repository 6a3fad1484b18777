#pragma once

// `weights` of a sector's part: outputs that are linear combinations of its dofs, as a stress is.

#include <string>
#include <string_view>
#include <vector>

#include "cases/sector_part.hpp"

namespace arcslip {

/// A row of such a file.
struct WeightRow {
  std::string name;  ///< that it begins with, or "w" and its number
  Vector weights;    ///< of all dofs
};

/// The rows that `text` has, each a name, which may be left out, and `size` numbers between commas; what
/// follows # on a line is a comment. Throws MatrixTextError.
std::vector<WeightRow> read_weights(std::string_view text, const std::string& file, Index size);

/// Adds an output of this name. Refuses a name that is taken or could be another column's.
void add_combination(PartSettings& part, const std::string& name, const std::vector<Index>& dofs,
                     const std::vector<double>& weights, const TomlSection& section);

}  // namespace arcslip
