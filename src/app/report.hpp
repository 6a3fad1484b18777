#pragma once

// A folder of results as one page of HTML that needs nothing besides itself: plots/report.html with our style
// and scripts, the library that draws, and the results as JSON.

#include <string>

namespace arcslip {

/// The library that draws, share/arcslip/report/plotly-basic.min.js, is not there.
struct PlotlyNotFound {
  std::string path;  ///< where it was looked for
};

/// The page. Throws InputError where the folder does not hold what `arcslip run` or `arcslip study` writes,
/// PlotlyNotFound, OutputError where a part of the page is missing.
std::string report_page(const std::string& folder);

}  // namespace arcslip
