#pragma once

// Which pictures there are of a preload study: the columns and the designs of optimum.csv decide it.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/gnuplot.hpp"

namespace arcslip {

constexpr std::size_t most_curves = 200;  ///< in one picture: more cannot be told apart

/// None where nothing can be drawn. `input` is the section `case` of summary.json. Throws InputError where
/// the folder does not hold what `arcslip study` writes.
std::vector<Picture> study_pictures(const std::string& folder, const nlohmann::ordered_json& input);

}  // namespace arcslip
