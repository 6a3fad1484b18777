#pragma once

// Python, run once to draw the pictures of a folder with matplotlib.

#include <string>
#include <vector>

namespace arcslip {

/// No Python was found that has matplotlib.
struct MatplotlibNotFound {};

/// What is asked of the pictures is wrong, in one line.
struct WrongRequest {
  std::string reason;
};

/// Draws what the tables in `folder` hold, as `options` of plots/plot.py have it, and gives the names of the
/// files, one a line. Python is `python3` or, where that has no matplotlib, the system's; the environment
/// variable ARCSLIP_PYTHON names another. Throws InputError, OutputError, Interrupted, MatplotlibNotFound,
/// WrongRequest.
std::string draw(const std::string& folder, const std::vector<std::string>& options);

}  // namespace arcslip
