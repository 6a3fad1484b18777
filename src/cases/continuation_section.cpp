#include "cases/continuation_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <climits>

#include "keys/printable.hpp"

namespace arcslip {
namespace {

using continuation::PointType;

/// One special point by its name, or a table of names and counts.
void read_stop_after(continuation::TraceOptions& options, const TomlSection& section) {
  constexpr const char* expected =
      "the type of a special point, or a table of types and counts: \"fold\", { fold = 2, peak = 5 }";
  const auto type_of = [&](const std::string& name, const TomlSection& place, const std::string& key) {
    const auto type = continuation::point_type(name);
    if (!type || *type == PointType::regular || *type == PointType::start || *type == PointType::end)
      place.fail(key, fmt::format("unknown type '{}'; expected {}", printable(name, longest_text), expected));
    return *type;
  };
  const toml::node& node = section.require("stop_after", expected);
  if (const auto name = node.value_exact<std::string>()) {
    options.stop_after = {{type_of(*name, section, "stop_after"), 1, {}}};
    return;
  }
  const TomlSection counts = section.inside("stop_after", expected);
  for (const auto& [key, value] : *node.as_table()) {
    const std::string name(key.str());
    const PointType type = type_of(name, counts, name);
    options.stop_after.push_back({type, counts.integer(name, at_least(1, INT_MAX)), {}});
  }
}

}  // namespace

const KeyTable<continuation::TraceOptions>& continuation_keys() {
  using S = continuation::TraceOptions;
  using K = Key<S>;
  const auto least_step = [](const S& options) {
    return NumberRule{up_to(options.max_step).holds, " > 0 and <= max_step"};
  };
  const auto range = [](const S& options) {
    return within(std::min(options.from, options.to), std::max(options.from, options.to));
  };
  static const KeyTable<S> keys{
      {K("tolerance", &S::tolerance, inside(0, 1e-2),
         "of the scaled residual and of the correction that is left, in the problem's scale"),
       K("max_step", &S::max_step, up_to(1), "largest step", unit("scaled arclength")),
       K("min_step", &S::min_step, {" > 0 and <= max_step", least_step},
         "smallest step; a branch that asks for less has ended", unit("scaled arclength")),
       K::special(
           "branch_point_pairs", "true or false", "whether two branch points within one step are looked for",
           [](S& options, const TomlSection& section) {
             options.branch_point_pairs = section.boolean("branch_point_pairs");
           },
           otherwise("false with several contacts and more than 24 unknowns, of cycles true where "
                     "multipliers are near 1, else true")),
       K("max_points", &S::max_points, at_least(2, INT_MAX), "of a branch, at most"),
       K("max_branches", &S::max_branches, at_least(1, INT_MAX),
         "that are followed with `switching`, at most"),
       K("stop_at", &S::stop_at, {" from `from` to `to`", range},
         "values of the parameter to land on exactly; in a study preloads at which every peak gets a row"),
       K::special("stop_after", "name or table",
                  "ends a branch at a special point: `\"fold\"`, or `{ fold = 2, peak = 5 }`; not in a study",
                  read_stop_after, otherwise("never")),
       K("max_seconds", &S::max_seconds, positive(),
         "of a branch with all its parts, the search for its first point included", unit("s"),
         otherwise("no limit"), unresolved)}};
  return keys;
}

}  // namespace arcslip
