#pragma once

// A folder of results: its summary, and the table that pictures of its runs are drawn from.

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace arcslip {

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
