#include "app/wrap.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <sstream>

namespace arcslip {
namespace {

/// Where the text of a line begins: behind the gap after its first words, if it has one.
std::size_t text_column(const std::string& line, std::size_t width) {
  const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
  const std::size_t gap = line.find("  ", first);
  const std::size_t text = gap == std::string::npos ? first : line.find_first_not_of(' ', gap);
  return text == std::string::npos || text > width / 2 ? first : text;
}

}  // namespace

std::size_t terminal_width() {
  winsize size{};
  if (isatty(STDOUT_FILENO) == 0 || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0)
    return 100;
  return std::clamp<std::size_t>(size.ws_col, 60, 120);
}

std::string wrapped(const std::string& text, std::size_t width) {
  std::string result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t indent = text_column(line, width);
    while (line.size() > width) {
      const std::size_t space = line.rfind(' ', width);
      if (space == std::string::npos || space <= indent) break;  // a word as wide as the line
      result += line.substr(0, line.find_last_not_of(' ', space) + 1) + '\n';
      line = std::string(indent, ' ') + line.substr(space + 1);
    }
    result += line + '\n';
  }
  return result;
}

std::string as_paragraphs(const std::string& text) {
  std::string result;
  const auto is_text = [&](std::size_t at) {
    return at < text.size() && text[at] != ' ' && text[at] != '\n';
  };
  std::size_t begin = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool joins = text[i] == '\n' && i > begin && is_text(begin) && is_text(i + 1);
    result += joins ? ' ' : text[i];
    if (text[i] == '\n') begin = i + 1;
  }
  return result;
}

}  // namespace arcslip
