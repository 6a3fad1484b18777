#include "keys/toml_depth.hpp"

#include <string>

#include "catch.hpp"

using arcslip::line_nested_too_deep;

namespace {

/// A dotted key of so many parts.
std::string key_of(int parts) {
  std::string key = "a";
  for (int i = 1; i < parts; ++i) key += i % 2 == 0 ? ".a" : " . \"b.b\"";
  return key;
}

}  // namespace

TEST_CASE("A key that nests too deep is found, with its line") {
  using arcslip::deepest_key;
  CHECK(line_nested_too_deep("") == 0);
  CHECK(line_nested_too_deep(key_of(deepest_key) + " = 1\n") == 0);
  CHECK(line_nested_too_deep(key_of(deepest_key + 1) + " = 1\n") == 1);
  CHECK(line_nested_too_deep("x = 1 # it's\n\n[" + key_of(1000) + "]") == 3);
  CHECK(line_nested_too_deep("x = { " + key_of(1000) + " = 1 }") == 1);
  CHECK(line_nested_too_deep("x = '''\n\"''''\n" + key_of(1000)) == 3);
  CHECK(line_nested_too_deep("{ x = \"\"\"\\\"\"\"\"\", " + key_of(1000)) == 1);
}

TEST_CASE("Dots that nest nothing count for nothing") {
  const std::string dots(1000, '.');
  CHECK(line_nested_too_deep("x = \"\\\"" + dots + "\"\ny = '" + dots + "\\'\n") == 0);
  CHECK(line_nested_too_deep("x = \"\"\"\n\\\"\"\"" + dots + "\n\"\" " + dots + "\"\"\"\n# " + dots) == 0);
  std::string numbers = "x = [";
  for (int i = 0; i < 1000; ++i) numbers += "0.1, ";
  CHECK(line_nested_too_deep(numbers + "]") == 0);
}
