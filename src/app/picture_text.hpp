#pragma once

// Words of the pictures in gnuplot's markup: the paper's symbols, titles of axes, labels of branches.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace arcslip {

/// An unbreakable blank, since readers of SVG drop others beside markup.
inline constexpr const char* blank = "\u00a0";

/// Text without what gnuplot would take for markup or for the end of a word.
std::string plain(std::string text);

std::string italic(const std::string& text);

/// The symbol of a key of [system] or a column: the paper's for systems with friction, else as it is named.
std::string symbol(const std::string& name, bool is_friction);

/// What stands along an axis.
std::string axis_title(const std::string& name, bool is_friction);

/// Words as scripts take them, each in double quotes.
std::string quote(const std::string& text);
std::string quote_all(const std::vector<std::string>& texts);

/// "P = 0.1" for those of a branch's values that `differ`.
std::string label(const nlohmann::ordered_json& values, const std::vector<std::string>& differ,
                  bool is_friction);

}  // namespace arcslip
