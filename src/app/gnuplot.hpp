#pragma once

// gnuplot, run once for each picture and format. A picture appears whole or not at all.

#include <string>
#include <vector>

namespace arcslip {

/// A picture: its file's name without ending, the script in plots/ that draws it without ".gp", what that
/// script is told after the paths and the format, see plots/style.gp, and the table that it reads.
struct Picture {
  std::string name;
  std::string script;
  std::vector<std::string> settings;
  std::string table;
};

struct GnuplotNotFound {};

/// Draws what the tables in `folder` hold as PNG and SVG, all at the same time, and prints the files'
/// names. Throws OutputError, GnuplotNotFound.
void draw(const std::string& folder, const std::vector<Picture>& pictures);

}  // namespace arcslip
