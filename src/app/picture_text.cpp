#include "app/picture_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>

namespace arcslip {
namespace {

using nlohmann::ordered_json;
using Names = std::vector<std::string>;

/// A name of a library problem: Greek letters by their sign, "u1" and "u_mid" with indices, words as they
/// are.
std::string library_symbol(const std::string& name) {
  static const std::map<std::string, std::string, std::less<>> greek = {
      {"alpha", "α"}, {"beta", "β"},  {"gamma", "γ"},  {"delta", "δ"}, {"epsilon", "ε"}, {"zeta", "ζ"},
      {"eta", "η"},   {"kappa", "κ"}, {"lambda", "λ"}, {"mu", "μ"},    {"nu", "ν"},      {"xi", "ξ"},
      {"rho", "ρ"},   {"sigma", "σ"}, {"tau", "τ"},    {"omega", "ω"}, {"Omega", "Ω"}};
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  std::size_t end = std::min(name.find('_'), name.size());
  const bool has_underscore = end < name.size();
  if (!has_underscore)
    end = static_cast<std::size_t>(std::find_if(name.begin(), name.end(), is_digit) - name.begin());
  const std::string stem = name.substr(0, end);
  const auto letter = greek.find(stem);
  if (letter == greek.end() && stem.size() != 1) return plain(name);
  const std::string index = plain(name.substr(end + (has_underscore ? 1 : 0)));
  const std::string sign = italic(letter == greek.end() ? plain(stem) : letter->second);
  return index.empty() ? sign : fmt::format("{}_{{{}}}", sign, index);
}

std::string value_text(const ordered_json& value) {
  if (value.is_string()) return plain(value.get<std::string>());
  if (!value.is_number()) return plain(value.dump());
  std::string text = fmt::format("{:.6g}", value.get<double>());
  for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos; at += std::string_view("−").size())
    text.replace(at, 1, "−");
  return text;
}

}  // namespace

std::string plain(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  std::erase_if(text,
                [](char c) { return std::string_view("\"\\{}^@&~").find(c) != std::string_view::npos; });
  return text;
}

std::string italic(const std::string& text) { return fmt::format("{{/:Italic {}}}", text); }

std::string symbol(const std::string& name, bool is_friction) {
  static const std::map<std::string, std::string, std::less<>> symbols = {
      {"preload", italic("P")},
      {"force", italic("F")},
      {"wave_number", italic("n")},
      {"elements", italic("N")},
      {"mass_ratio", italic("M") + "*"},
      {"frequency_ratio", italic("γ")},
      {"slenderness", italic("L") + "/" + italic("h") + "_D"},
      {"poisson_ratio", italic("ν")},
      {"interface_stiffness", italic("K") + "_{FD}"},
      {"circumference", italic("L")},
      {"radius", italic("r")},
      {"friction_coefficient", italic("μ")},
      {"preload_per_length", italic("p") + "_0"},
      {"force_per_length", italic("f") + "_0"},
      {"R_over_S", italic("R") + "/" + italic("S")}};
  const auto found = symbols.find(name);
  return !is_friction || found == symbols.end() ? library_symbol(name) : found->second;
}

std::string axis_title(const std::string& name, bool is_friction) {
  static const std::map<std::string, std::string, std::less<>> words = {
      {"eta", "frequency"},
      {"P", "preload"},
      {"zeta", "damping ratio"},
      {"zeta_B", "base damping"},
      {"R_over_S", "relative amplitude"},
      {"mass_ratio", "mass ratio"},
      {"frequency_ratio", "frequency ratio"},
      {"slenderness", "slenderness"},
      {"interface_stiffness", "interface stiffness"},
      {"force", "force"},
      {"wave_number", "wave number"},
      {"elements", "elements"},
      {"Y", "amplitude"}};
  const auto found = words.find(name);
  if (!is_friction || found == words.end()) return symbol(name, is_friction);
  return fmt::format("{}{}{}{}", found->second, blank, blank, symbol(name, true));
}

std::string quote(const std::string& text) { return fmt::format("\"{}\"", text); }

std::string quote_all(const Names& texts) {
  std::string words;
  for (const std::string& text : texts) words += fmt::format("{}\"{}\"", words.empty() ? "" : " ", text);
  return words;
}

std::string label(const ordered_json& values, const Names& differ, bool is_friction) {
  Names parts;
  for (const auto& [key, value] : values.items()) {
    if (std::find(differ.begin(), differ.end(), key) == differ.end()) continue;
    parts.push_back(fmt::format("{}{}={}{}", symbol(key, is_friction), blank, blank, value_text(value)));
  }
  return fmt::format("{}", fmt::join(parts, fmt::format(",{}", blank)));
}

}  // namespace arcslip
