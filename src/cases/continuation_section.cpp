#include "cases/continuation_section.hpp"

#include <fmt/format.h>

#include <limits>

#include "keys/printable.hpp"

namespace arcslip {
namespace {

using continuation::PointType;

const std::vector<std::string> continuation_keys = {"tolerance", "max_step",   "min_step",   "max_points",
                                                    "stop_at",   "stop_after", "max_seconds"};

/// One special point by its name, or a table of names and counts.
std::vector<continuation::StopAfter> read_stop_after(const TomlDocument& document,
                                                     const TomlSection& section) {
  constexpr const char* expected =
      "the type of a special point, or a table of types and counts: \"fold\", { fold = 2, peak = 5 }";
  std::vector<continuation::StopAfter> rules;
  if (!section.has("stop_after")) return rules;
  const toml::node& node = section.require("stop_after", expected);
  const auto type_of = [&](const std::string& name, const toml::node& place, const std::string& key) {
    const auto type = continuation::point_type(name);
    if (!type || *type == PointType::regular || *type == PointType::start || *type == PointType::end)
      document.fail(&place, key,
                    fmt::format("unknown type '{}'; expected {}", printable(name, longest_text), expected));
    return *type;
  };
  if (const toml::table* table = node.as_table()) {
    const TomlSection counts(document, "continuation.stop_after");
    for (const auto& [key, value] : *table) {
      const std::string name(key.str());
      rules.push_back(
          {type_of(name, value, counts.name(name)),
           counts.integer(name, 1, std::numeric_limits<int>::max(), [] { return "an integer >= 1"; }),
           {}});
    }
    return rules;
  }
  const auto name = node.value_exact<std::string>();
  if (!name) section.mismatch("stop_after", expected);
  rules.push_back({type_of(*name, node, section.name("stop_after")), 1, {}});
  return rules;
}

}  // namespace

continuation::TraceOptions read_continuation(const TomlDocument& document) {
  const TomlSection section(document, "continuation");
  section.allow_only(continuation_keys);
  continuation::TraceOptions options;
  options.tolerance = section.number("tolerance", inside(0, 1e-2), options.tolerance);
  options.max_step = section.number("max_step", {[](double h) { return h > 0 && h <= 1; }, " > 0 and <= 1"},
                                    options.max_step);
  options.min_step = section.number(
      "min_step", {[&](double h) { return h > 0 && h <= options.max_step; }, " > 0 and <= max_step"},
      options.min_step);
  options.max_points = section.integer(
      "max_points", 2, std::numeric_limits<int>::max(), [] { return "an integer >= 2"; }, options.max_points);
  options.max_seconds = section.number("max_seconds", positive(), options.max_seconds);
  options.stop_after = read_stop_after(document, section);
  return options;
}

void resolve_continuation(const continuation::TraceOptions& options, nlohmann::ordered_json& section) {
  section["tolerance"] = options.tolerance;
  section["max_step"] = options.max_step;
  section["min_step"] = options.min_step;
  section["max_points"] = options.max_points;
  section["stop_at"] = options.stop_at;
}

}  // namespace arcslip
