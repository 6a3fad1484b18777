#pragma once

// Which pictures there are of a folder of results. The section `case` of summary.json and the columns of the
// tables decide it.

#include <string>
#include <vector>

#include "app/gnuplot.hpp"

namespace arcslip {

/// Throws InputError where the folder does not hold what `arcslip run` or `arcslip study` writes, or holds no
/// points.
std::vector<Picture> pictures_of(const std::string& folder);

}  // namespace arcslip
