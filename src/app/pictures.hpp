#pragma once

// Which pictures there are of a folder of results. The section `case` of summary.json and the columns of the
// tables decide it.

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/gnuplot.hpp"

namespace arcslip {

/// Throws InputError where the folder does not hold what `arcslip run` or `arcslip study` writes, or holds no
/// points.
std::vector<Picture> pictures_of(const std::string& folder);

/// The folder's summary.json. Throws InputError where it is none that can be read.
nlohmann::ordered_json summary_of(const std::string& folder);

/// What `use` gives, which reads the folder's summary and tables: what it misses there is thrown as an
/// InputError, which says so where another version of arcslip has written them.
std::string reading(const std::string& folder, const nlohmann::ordered_json& summary,
                    const std::function<std::string()>& use);

/// The table that pictures of a run are drawn from: that of its curves, unless the branches have been changed
/// since, or it is not there.
std::string drawn_table(const std::string& folder);

}  // namespace arcslip
