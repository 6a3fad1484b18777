#include "keys/toml_depth.hpp"

#include <algorithm>

namespace arcslip {
namespace {

/// What follows the string that `text` begins with, whose end may be missing.
std::string_view after_string(std::string_view text) {
  const char quote = text[0];
  const bool several = text.size() >= 3 && text[1] == quote && text[2] == quote;
  std::size_t at = several ? 3 : 1;
  for (; at < text.size(); ++at) {
    if (text[at] == '\\' && quote == '"') {
      ++at;
    } else if (several ? text.substr(at, 3) == text.substr(0, 3) : text[at] == quote || text[at] == '\n') {
      break;
    }
  }
  at += several ? 3 : 1;
  for (int more = 0; several && more < 2 && at < text.size() && text[at] == quote; ++more) ++at;
  return text.substr(std::min(text.size(), at));
}

}  // namespace

long line_nested_too_deep(std::string_view text) {
  const std::string_view whole = text;
  int parts = 1;
  while (!text.empty()) {
    const char c = text[0];
    if (c == '"' || c == '\'') {
      text = after_string(text);
      continue;
    }
    if (c == '#') text.remove_prefix(std::min(text.find('\n'), text.size() - 1));
    if (c == '.') ++parts;
    if (parts > deepest_key) return 1 + std::count(whole.begin(), whole.end() - std::ssize(text), '\n');
    if (std::string_view("\n=,[]{}#").find(c) != std::string_view::npos) parts = 1;
    text.remove_prefix(1);
  }
  return 0;
}

}  // namespace arcslip
