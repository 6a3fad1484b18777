#pragma once

// What tests of `arcslip plot` share.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "catch.hpp"
#include "program.hpp"

namespace arcslip::testing {

namespace fs = std::filesystem;

/// Whether pictures can be drawn here; a warning if not.
inline bool has_matplotlib() {
  for (const char* python : {"python3", "/usr/bin/python3"}) {
    const std::string command = std::string(python) + " -c 'import importlib.util as u, sys; " +
                                "sys.exit(u.find_spec(\"matplotlib\") is None)' >/dev/null 2>&1";
    if (std::system(command.c_str()) == 0) return true;
  }
  WARN("matplotlib is not installed: nothing is drawn");
  return false;
}

/// A script of this text, in the folder, that can stand for Python.
inline std::string false_python(const TemporaryFolder& folder, const std::string& script) {
  fs::create_directories(folder.path("bin"));
  const std::string file = folder.write("bin/python3", "#!/bin/sh\n" + script);
  fs::permissions(file, fs::perms::owner_all);
  return file;
}

inline Outcome plotted(const std::string& folder, const std::string& options = "") {
  return arcslip_program("plot '" + folder + "' --format svg " + options);
}

/// Requires all pictures in the folder, from their first bytes to their last, and nothing besides the
/// results. Most tests draw SVG alone, which takes half the time.
inline void require_pictures(const std::string& folder, std::size_t least_size,
                             const std::vector<std::string>& drawn, const std::set<std::string>& results,
                             bool has_png = false) {
  std::set<std::string> expected = results;
  for (const std::string& picture : drawn) {
    CAPTURE(picture);
    const fs::path path = fs::path(folder) / picture;
    const std::string svg = read(path.string() + ".svg");
    CHECK(svg.size() > least_size);
    CHECK_THAT(svg.substr(0, 200), ContainsSubstring("<?xml") && ContainsSubstring("<svg"));
    CHECK(svg.find("</svg>") != std::string::npos);
    expected.insert(picture + ".svg");
    if (!has_png) continue;
    const std::string png = read(path.string() + ".png");
    CHECK(png.size() > least_size);
    CHECK(png.substr(0, 8) == "\x89PNG\r\n\x1a\n");
    CHECK(png.substr(png.size() - std::min<std::size_t>(png.size(), 8), 4) == "IEND");
    expected.insert(picture + ".png");
  }
  CHECK(names_in(folder) == expected);
}

}  // namespace arcslip::testing
