// Who may include whom:
//
//   types <- continuation
//   types <- mechanics
//   continuation, mechanics <- problems <- files <- command line

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "catch.hpp"
#include "places.hpp"

namespace {

namespace fs = std::filesystem;

enum class Layer { types, continuation, mechanics, problems, files, command_line };

std::set<std::string, std::less<>> words(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

const std::set<std::string, std::less<>> mechanics = words(R"(
annular_plate bracketed_newton chain_sector complex_factors contact contact_force contact_modes disturbance_flow
disturbed_wave
dynamic_stiffness
elements extended_sector finite_sector first_crossing full_receptance harmonic_system
hysteresis_loop interval interval_response krylov_space lowest_frequency matrix_market modal_model odd_motion
physical_scale precise reduced_pair refined_solve ring ring_disturbances ring_motion ring_record ring_response ring_sector
ring_stability ring_waves ritz_space sector sector_modes sector_pair sector_reduction sector_solver
shape_functions spectrum stick_pattern stick_schedule system turned_flow)");
const std::set<std::string, std::less<>> files = words(R"(
atomic_file branch_columns branch_file branch_table case_file certificate_results continuation_section database for_each
geometry_section input_file output output_folder printable results run_files runs sector_files sector_section
stability_results study_case study_checksum study_extras study_results study_run study_store summary_file
system_section toml_depth toml_reader uncertain_section verification_results)");

/// The layer of one of our files, given below the top of the tree or as it is written in an include.
Layer layer_of(const fs::path& file) {
  for (const fs::path& folder : file.parent_path()) {
    if (folder == "continuation") return Layer::continuation;
    if (folder == "problems") return Layer::problems;
  }
  const std::string name = file.stem().string();
  if (name == "types" || name == "zero_between") return Layer::types;
  if (mechanics.contains(name)) return Layer::mechanics;
  if (files.contains(name)) return Layer::files;
  return Layer::command_line;
}

/// The layer that an include asks for; none for a library that every layer may use.
std::optional<Layer> included_layer(const fs::path& file, const std::string& target, bool quoted) {
  if (target.starts_with("CLI/")) return Layer::command_line;
  if (target.starts_with("toml++/") || target.starts_with("nlohmann/")) return Layer::files;
  if (target.starts_with("arcslip/")) return layer_of(target);
  if (quoted) return layer_of((file.parent_path() / target).lexically_normal());
  return std::nullopt;
}

bool may_include(Layer from, Layer to) {
  if (from == Layer::types || from == Layer::continuation || from == Layer::mechanics) {
    return to == from || to == Layer::types;
  }
  return to <= from;
}

/// Whether `line`, in `file`, is an include against the layers.
bool forbidden(const fs::path& file, const std::string& line) {
  static const std::regex include(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::smatch match;
  if (!std::regex_search(line, match, include)) return false;
  const std::optional<Layer> target = included_layer(file, match[2], match[1] == "\"");
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

/// Whether a line names what only the mechanics may know. The project's own name is no such word.
bool names_physics(const std::string& line) {
  static const std::regex project("arcslip", std::regex::icase);
  std::string text = std::regex_replace(line, project, "");
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
          return layer_of(line.file) <= Layer::problems && prints(line.text);
        }) == std::vector<std::string>{});
}

TEST_CASE("The continuation engine knows no word of physics", "[layers]") {
  CHECK(lines_where([](const Line& line) {
          return layer_of(line.file) == Layer::continuation && names_physics(line.text);
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
      {"include/arcslip/types.hpp", "#include \"arcslip/elements.hpp\"", true},
      {"continuation/trace.cpp", "#include \"arcslip/continuation/branch.hpp\"", false},
      {"continuation/trace.cpp", "#include \"arcslip/types.hpp\"", false},
      {"continuation/trace.cpp", "#include <fmt/format.h>", false},
      {"continuation/trace.cpp", "#include \"arcslip/contact.hpp\"", true},
      {"continuation/trace.cpp", "#include \"../src/command_run.hpp\"", true},
      {"continuation/trace.cpp", "#include <nlohmann/json.hpp>", true},
      {"include/arcslip/continuation/problem.hpp", "#include <arcslip/system.hpp>", true},
      {"include/arcslip/continuation/problem.hpp", "  #  include  \"arcslip/problems/any.hpp\"", true},
      {"src/sector.cpp", "#include \"arcslip/precise.hpp\"", false},
      {"src/sector.cpp", "#include \"arcslip/continuation/problem.hpp\"", true},
      {"src/sector.cpp", "// #include \"arcslip/continuation/problem.hpp\"", false},
      {"include/arcslip/contact.hpp", "#include \"arcslip/problems/forced_response.hpp\"", true},
      {"include/arcslip/contact.hpp", "#include \"arcslip/case_file.hpp\"", true},
      {"problems/forced_response.cpp", "#include \"arcslip/contact.hpp\"", false},
      {"problems/forced_response.cpp", "#include \"arcslip/continuation/trace.hpp\"", false},
      {"problems/forced_response.cpp", "#include \"arcslip/results.hpp\"", true},
      {"include/arcslip/problems/forced_response.hpp", "#include <toml++/toml.h>", true},
      {"src/case_file.cpp", "#include \"toml_reader.hpp\"", false},
      {"src/results.cpp", "#include \"arcslip/problems/forced_response.hpp\"", false},
      {"src/results.cpp", "#include \"arcslip/command_run.hpp\"", true},
      {"src/results.cpp", "#include <CLI/CLI.hpp>", true},
      {"src/command_run.cpp", "#include \"arcslip/results.hpp\"", false},
      {"src/main.cpp", "#include \"arcslip/command_run.hpp\"", false},
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
