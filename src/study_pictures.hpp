#pragma once

// Which pictures there are of a preload study: the columns and the designs of optimum.csv decide it.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gnuplot.hpp"

namespace arcslip {

/// `input` is the section `case` of summary.json. Throws InputError where the folder does not hold what
/// `arcslip study` writes, or nothing that can be drawn.
std::vector<Picture> study_pictures(const std::string& folder, const nlohmann::ordered_json& input);

}  // namespace arcslip
