#include "mutation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "vocabulary.hpp"

namespace arcslip::fuzz {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace

/// Bytes that no terminal should see.
std::string Mutator::garbage() {
  const std::vector<std::string> pieces = {"\x1b[2J",
                                           "\n",
                                           "\r",
                                           "\t",
                                           std::string(1, '\0'),
                                           "\x7f",
                                           "\xff\xfe",
                                           "\xc2\x9b",
                                           "\xe2\x80\xae",
                                           "\xf0\x9f\x99\x82",
                                           "\"",
                                           "'",
                                           "\\",
                                           "{",
                                           "}",
                                           "[",
                                           "]",
                                           "=",
                                           ",",
                                           "#",
                                           ".",
                                           " ",
                                           "\\u001b[31m",
                                           "\\n",
                                           "\\u0000",
                                           "\"\"\"",
                                           "'''"};
  std::string text;
  for (std::size_t i = 0; i <= pick(4); ++i) text += one_of(pieces);
  return text;
}

std::string Mutator::text_value() {
  if (chance(0.6)) return one_of(words);
  if (chance(0.5)) return garbage();
  return std::string(pick(4) == 0 ? 100'000 : pick(300), static_cast<char>('a' + pick(26)));
}

std::string Mutator::value() {
  switch (pick(12)) {
    case 0: return fmt::format("\"{}\"", text_value());
    case 1: return fmt::format("'{}'", text_value());
    case 2: return fmt::format("[{}, {}]", value(), value());
    case 3: return fmt::format("{{ {} = {} }}", one_of(keys), value());
    case 4:
      return "{ from = " + one_of(numbers) + ", to = " + one_of(numbers) + ", count = " + one_of(numbers) +
             " }";
    case 5: return chance(0.5) ? "true" : "false";
    case 6: return chance(0.5) ? "1979-05-27T07:32:00Z" : "07:32:00";
    case 7: return chance(0.5) ? "[]" : "{}";
    default: return one_of(numbers);
  }
}

void Mutator::change_bytes(std::string& text) {
  for (std::size_t i = 0; i <= pick(3); ++i) {
    const std::size_t at = pick(text.size() + 1);
    switch (pick(5)) {
      case 0: text.insert(at, garbage()); break;
      case 1: text.insert(at, 1, static_cast<char>(pick(256))); break;
      case 2: text.erase(at, 1 + pick(8)); break;
      case 3: text.insert(at, text.substr(pick(text.size() + 1), pick(40))); break;
      default:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << pick(8)));
    }
  }
  if (chance(0.05)) text.resize(pick(text.size() + 1));
}

/// Puts another value behind the '=' of a line, or in the place of a number.
void Mutator::change_value(std::string& text) {
  std::vector<std::string> lines = lines_of(text);
  if (lines.empty()) return;
  for (int i = 0; i < 20; ++i) {
    std::string& line = lines[pick(lines.size())];
    const std::size_t equals = line.find('=');
    if (equals == line.npos || line[0] == '#') continue;
    const std::size_t digit = line.find_first_of("0123456789", equals);
    if (digit != line.npos && chance(0.5)) {
      const std::size_t end = std::min(line.find_first_not_of("0123456789.eE+-_", digit), line.size());
      line.replace(digit, end - digit, one_of(numbers));
    } else {
      line = line.substr(0, equals) + "= " + value();
    }
    break;
  }
  text = joined(lines);
}

void Mutator::change_lines(std::string& text) {
  std::vector<std::string> lines = lines_of(text);
  if (lines.empty()) return;
  const std::size_t at = pick(lines.size());
  switch (pick(3)) {
    case 0: lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at)); break;
    case 1: lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), lines[pick(lines.size())]); break;
    default: std::swap(lines[at], lines[pick(lines.size())]);
  }
  text = joined(lines);
}

void Mutator::insert_key(std::string& text) {
  std::vector<std::string> lines = lines_of(text);
  std::string key = chance(0.9) ? one_of(keys) : fmt::format("\"{}\"", text_value());
  if (chance(0.1)) key += "." + one_of(keys);
  std::string line = key + " = " + value();
  if (chance(0.1)) line = "[" + one_of(sections) + "]";
  if (chance(0.05)) line = "[[" + one_of(sections) + "]]";
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(pick(lines.size() + 1)), line);
  text = joined(lines);
}

/// Long, wide or deep.
void Mutator::grow(std::string& text) {
  const std::size_t size = one_of(std::vector<std::size_t>{100, 1000, 20'000});
  std::string repeated;
  const auto repeat = [&](const std::string& piece) {
    for (std::size_t i = 0; i < size; ++i) repeated += piece;
  };
  switch (pick(6)) {
    case 0: repeat("a."); break;
    case 1: repeat("["); break;
    case 2: repeat("{a="); break;
    case 3: repeat("x"); break;
    case 4: repeat(one_of(numbers) + ", "); break;
    default: repeat("\n[a]\n"); break;
  }
  const std::vector<std::string> starts = {"\n", "\nx = ", "\n[", "\ntitle = \"",
                                           "\n[branch.for_each]\npreload = ["};
  text.insert(chance(0.5) ? text.size() : pick(text.size() + 1), one_of(starts) + repeated + "b = 1");
}

/// Another number in the place of one, as somebody might have chosen it.
void Mutator::nudge(std::string& text) {
  for (int i = 0; i < 20; ++i) {
    const std::size_t at = text.find_first_of("123456789", pick(text.size() + 1));
    if (at == text.npos) continue;
    const std::size_t line = text.rfind('\n', at) + 1;
    if (text.find_first_of("=[#", line) > at || text[line] == '#') continue;
    const std::size_t end = std::min(text.find_first_not_of("0123456789.eE+-", at), text.size());
    const std::string word = text.substr(at, end - at);
    const bool whole = word.find_first_of(".eE") == word.npos && chance(0.8);
    const double number = std::strtod(word.c_str(), nullptr);
    const double other = number * std::pow(10, std::uniform_real_distribution<double>(-1.5, 1.5)(random_));
    text.replace(at, end - at, whole ? fmt::format("{:.0f}", std::ceil(other)) : fmt::format("{}", other));
    return;
  }
}

std::string Mutator::mutated(std::string text) {
  const std::size_t changes = chance(0.5) ? 1 : 1 + pick(5);
  const bool gently = chance(0.5);
  for (std::size_t i = 0; i < changes; ++i) {
    const std::size_t kind = pick(20);
    if (gently) {
      nudge(text);
    } else if (kind < 10) {
      change_value(text);
    } else if (kind < 13) {
      change_lines(text);
    } else if (kind < 17) {
      insert_key(text);
    } else if (kind < 19) {
      change_bytes(text);
    } else {
      grow(text);
    }
  }
  return text;
}

std::string Mutator::setting() {
  std::string key = one_of(sections) + "." + one_of(keys);
  if (chance(0.1)) key = garbage();
  std::string text = key + "=" + (chance(0.9) ? value() : garbage());
  std::erase(text, '\0');  // which no argument can hold
  return text;
}

}  // namespace arcslip::fuzz
