#include "cases/stored_point.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

#include "keys/printable.hpp"
#include "results/summary_file.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;

constexpr const char* point_key = "from_point";
constexpr const char* point_expected = "\"DIR:branch/point\", as \"out/figure_8:1/292\"";

/// Where a point stands.
struct Place {
  std::string folder;
  std::size_t branch = 0;
  std::size_t point = 0;
};

Place read_place(const TomlSection& section) {
  const std::string text = section.text(point_key, {});
  const std::size_t colon = text.rfind(':');
  Place place;
  char slash = 0;
  std::istringstream numbers(colon == std::string::npos ? "" : text.substr(colon + 1));
  const bool is_read = static_cast<bool>(numbers >> place.branch >> slash >> place.point);
  if (!is_read || slash != '/' || !(numbers >> std::ws).eof() || colon == 0)
    section.mismatch(point_key, point_expected);
  place.folder = text.substr(0, colon);
  return place;
}

/// The special points of its branch.
ordered_json read_special(const TomlSection& section, const Place& place) {
  const std::string shown = printable(place.folder, longest_name);
  const std::optional<ordered_json> summary = run_summary(place.folder);
  if (!summary) section.fail(point_key, fmt::format("{}: cannot be read as a folder of a run", shown));
  for (const ordered_json& branch : summary->at("branches")) {
    if (branch.value("branch", ordered_json()) == place.branch)
      return branch.value("special", ordered_json());
  }
  section.fail(point_key, fmt::format("{}: has no branch {}", shown, place.branch));
}

StoredPoint point_of(const ordered_json& state) {
  StoredPoint point;
  point.regime = continuation::regime_of_digits(state.at("regime").get<std::string>());
  point.parameters = state.at("parameters").get<std::map<std::string, double>>();
  std::istringstream unknowns(state.at("unknowns").get<std::string>());
  std::vector<double> values;
  for (double value = 0; unknowns >> value;) values.push_back(value);
  point.unknowns = Vector::Map(values.data(), std::ssize(values));
  return point;
}

}  // namespace

StoredPoint read_stored_point(const TomlSection& section) {
  const Place place = read_place(section);
  std::vector<std::size_t> others;
  try {
    for (const ordered_json& one : read_special(section, place)) {
      if (!one.contains("state")) continue;
      others.push_back(one.at("point").get<std::size_t>());
      if (others.back() == place.point) return point_of(one.at("state"));
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    section.fail(point_key,
                 fmt::format("{}/summary.json is damaged: {}", printable(place.folder, longest_name),
                             printable(error.what(), longest_name)));
  }
  section.fail(point_key,
               others.empty()
                   ? fmt::format("branch {} has no point with its unknowns; special points of branches of "
                                 "at most {} unknowns have them",
                                 place.branch, most_stored_unknowns)
                   : fmt::format("expected a special point, which of branch {} are {}, got {}; stop_at makes "
                                 "one of any value",
                                 place.branch, fmt::join(others, ", "), place.point));
}

}  // namespace arcslip
