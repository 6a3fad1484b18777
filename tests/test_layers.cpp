// Who may include whom: a file those of its own folder and of the folders before it, the mechanics nothing of
// the engine.

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "catch.hpp"
#include "places.hpp"

namespace {

namespace fs = std::filesystem;

/// The folders in the order in which they may use one another; those of one row are one layer.
constexpr std::array<std::string_view, 14> layers = {
    "types base", "continuation",  "formulas", "motion", "structure",     "sectors", "elements",
    "assembly",   "time interval", "problems", "keys",   "cases results", "python",  "app"};

/// The place of one of the layers among all.
std::size_t layer(std::string_view folder) {
  for (std::size_t i = 0; i < layers.size(); ++i) {
    std::istringstream names{std::string(layers[i])};
    for (std::string name; names >> name;) {
      if (name == folder) return i;
    }
  }
  throw std::invalid_argument("no layer has the folder " + std::string(folder));
}

/// The layer of one of our files, given below the top of the tree or as it is written in an include.
std::size_t layer_of(const fs::path& file) {
  if (file.filename() == "arcslip.hpp") return layer("app");  // of all layers, for other projects
  for (const fs::path& folder : file.parent_path()) {
    if (folder != "include" && folder != "arcslip" && folder != "src") return layer(folder.string());
  }
  return layer("types");
}

/// The layer that an include asks for; none for a library that every layer may use.
std::optional<std::size_t> included_layer(const std::string& target, bool quoted) {
  if (target.starts_with("CLI/")) return layer("app");
  if (target.starts_with("toml++/")) return layer("keys");
  if (target.starts_with("nlohmann/")) return layer("keys");
  if (quoted || target.starts_with("arcslip/")) return layer_of(target);
  return std::nullopt;
}

bool may_include(std::size_t from, std::size_t to) {
  const bool mechanics = from > layer("continuation") && from < layer("problems");
  return to <= from && !(mechanics && to == layer("continuation"));
}

/// Whether `line`, in `file`, is an include against the layers.
bool forbidden(const fs::path& file, const std::string& line) {
  static const std::regex include(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::smatch match;
  if (!std::regex_search(line, match, include)) return false;
  const std::optional<std::size_t> target = included_layer(match[2], match[1] == "\"");
  return target && !may_include(layer_of(file), *target);
}

struct Line {
  fs::path file;  ///< below the top of the tree
  int number;
  std::string text;
};

std::vector<Line> source_lines() {
  const fs::path top = arcslip::testing::source_folder();
  std::vector<Line> lines;
  for (const char* folder : {"continuation", "include", "problems", "src"}) {
    for (const auto& entry : fs::recursive_directory_iterator(top / folder)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
      std::ifstream file(entry.path());
      std::string text;
      for (int number = 1; std::getline(file, text); ++number) {
        lines.push_back({entry.path().lexically_relative(top), number, text});
      }
    }
  }
  return lines;
}

/// "file:number: text" of each line that meets the condition.
template <class Condition>
std::vector<std::string> lines_where(const Condition& condition) {
  std::vector<std::string> found;
  for (const Line& line : source_lines()) {
    if (!condition(line)) continue;
    found.push_back(line.file.string() + ":" + std::to_string(line.number) + ": " + line.text);
  }
  return found;
}

/// "namespace::Name" of each type that has several definitions, in headers or outside unnamed namespaces.
std::vector<std::string> types_defined_twice(const std::vector<Line>& lines) {
  static const std::regex begins(R"(^namespace (\S*) ?\{$)");
  static const std::regex defines(R"(^(?:struct|class|enum class) (\w+)(?: final)?(?: ?: .*)? \{.*$)");
  std::string place;
  bool unnamed = false;
  std::set<std::string> seen;
  std::set<std::string> twice;
  for (const Line& line : lines) {
    std::smatch match;
    if (std::regex_match(line.text, match, begins)) {
      unnamed = match[1].length() == 0;
      if (!unnamed) place = match[1].str() + "::";
    } else if (line.text == "}  // namespace") {
      unnamed = false;
    } else if (!unnamed && std::regex_match(line.text, match, defines)) {
      if (!seen.insert(place + match[1].str()).second) twice.insert(place + match[1].str());
    }
  }
  return {twice.begin(), twice.end()};
}

bool contains_any(std::string_view text, const std::vector<std::string_view>& words) {
  return std::any_of(words.begin(), words.end(), [&](auto word) { return text.find(word) != text.npos; });
}

/// Whether a line names what only the mechanics may know. The project's own name is no such word, nor are the
/// points of bifurcation theory where multipliers are roots of 1.
bool names_physics(const std::string& line) {
  static const std::regex others("arcslip|resonance_1_[1-4]", std::regex::icase);
  std::string text = std::regex_replace(line, others, "");
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return contains_any(text, {"frequency", "frequencies", "harmonic", "contact", "friction", "stick", "slip",
                             "resonance", "vibration"});
}

bool prints(const std::string& line) {
  return contains_any(
      line, {"<iostream>", "<fstream>", "std::cout", "std::cerr", "std::clog", "printf", "fmt::print"});
}

}  // namespace

TEST_CASE("No file includes another against the layers", "[layers]") {
  REQUIRE(source_lines().size() > 1000);
  CHECK(lines_where([](const Line& line) { return forbidden(line.file, line.text); }) ==
        std::vector<std::string>{});
}

TEST_CASE("Continuation, mechanics and problems neither print nor write", "[layers]") {
  CHECK(lines_where([](const Line& line) {
          return layer_of(line.file) <= layer("problems") && prints(line.text);
        }) == std::vector<std::string>{});
}

TEST_CASE("The continuation engine knows no word of physics", "[layers]") {
  CHECK(lines_where([](const Line& line) {
          return layer_of(line.file) == layer("continuation") && names_physics(line.text);
        }) == std::vector<std::string>{});
}

TEST_CASE("No type has two definitions", "[layers]") {
  CHECK(types_defined_twice(source_lines()) == std::vector<std::string>{});
  const auto of = [](const std::string& text) {
    std::istringstream stream(text);
    std::vector<Line> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back({"", 0, line});
    return types_defined_twice(lines);
  };
  const std::string twice = "namespace a {\nstruct Ring {\n}  // namespace a\n";
  CHECK(of(twice + "namespace a {\nclass Ring : public Shape {\n") == std::vector<std::string>{"a::Ring"});
  CHECK(of(twice + "enum class Ring { one, two };\n") == std::vector<std::string>{"a::Ring"});
  CHECK(of(twice + "namespace a::b {\nstruct Ring {\n").empty());
  CHECK(of(twice + "namespace a {\nnamespace {\nstruct Ring {\n").empty());
  CHECK(of(twice + "namespace a {\nstruct Ring;\nstruct Ring::Part {\n").empty());
}

TEST_CASE("Includes against the layers are recognised", "[layers]") {
  struct Example {
    const char* file;
    const char* line;
    bool forbidden;
  };
  const Example example = GENERATE(values<Example>({
      {"include/arcslip/types.hpp", "#include <Eigen/Core>", false},
      {"include/arcslip/types.hpp", "#include \"arcslip/time/ring.hpp\"", true},
      {"continuation/path/trace.cpp", "#include \"arcslip/continuation/path/branch.hpp\"", false},
      {"continuation/path/trace.cpp", "#include \"arcslip/types.hpp\"", false},
      {"continuation/path/trace.cpp", "#include <fmt/format.h>", false},
      {"continuation/path/trace.cpp", "#include \"arcslip/elements/contact.hpp\"", true},
      {"continuation/path/trace.cpp", "#include \"app/commands.hpp\"", true},
      {"continuation/path/trace.cpp", "#include <nlohmann/json.hpp>", true},
      {"include/arcslip/continuation/problem/problem.hpp", "#include <arcslip/assembly/system.hpp>", true},
      {"include/arcslip/continuation/problem/problem.hpp", "  #  include  \"arcslip/problems/any.hpp\"",
       true},
      {"src/sectors/sector.cpp", "#include \"arcslip/structure/precise.hpp\"", false},
      {"src/sectors/sector.cpp", "#include \"arcslip/continuation/problem/problem.hpp\"", true},
      {"src/sectors/sector.cpp", "// #include \"arcslip/continuation/problem/problem.hpp\"", false},
      {"src/structure/modal_model.cpp", "#include \"arcslip/sectors/sector_modes.hpp\"", true},
      {"include/arcslip/elements/contact.hpp", "#include \"arcslip/problems/response/forced_response.hpp\"",
       true},
      {"include/arcslip/elements/contact.hpp", "#include \"arcslip/cases/case_file.hpp\"", true},
      {"problems/response/forced_response.cpp", "#include \"arcslip/elements/contact.hpp\"", false},
      {"problems/response/forced_response.cpp", "#include \"arcslip/continuation/path/trace.hpp\"", false},
      {"problems/response/forced_response.cpp", "#include \"arcslip/results/results.hpp\"", true},
      {"include/arcslip/problems/response/forced_response.hpp", "#include <toml++/toml.h>", true},
      {"src/cases/case_file.cpp", "#include \"keys/toml_reader.hpp\"", false},
      {"src/keys/toml_reader.cpp", "#include \"arcslip/cases/case_file.hpp\"", true},
      {"src/results/results.cpp", "#include \"arcslip/problems/response/forced_response.hpp\"", false},
      {"src/results/results.cpp", "#include \"app/commands.hpp\"", true},
      {"src/results/results.cpp", "#include <CLI/CLI.hpp>", true},
      {"src/app/commands/run.cpp", "#include \"arcslip/results/results.hpp\"", false},
  }));
  CAPTURE(example.file, example.line);
  CHECK(forbidden(example.file, example.line) == example.forbidden);
}

TEST_CASE("Words of physics and printing are recognised", "[layers]") {
  CHECK(names_physics("/// at a Resonance"));
  CHECK(names_physics("const int stick_slip = 0;"));
  CHECK_FALSE(names_physics("namespace arcslip::continuation {"));
  CHECK(prints("  fmt::print(\"{}\", x);"));
  CHECK(prints("#include <iostream>"));
  CHECK_FALSE(prints("  return fmt::format(\"{}\", x);"));
}
