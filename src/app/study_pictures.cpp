#include "app/study_pictures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>

#include "app/picture_text.hpp"
#include "arcslip/cases/case_file.hpp"
#include "results/result_table.hpp"

namespace arcslip {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using Names = std::vector<std::string>;

constexpr std::size_t most_cells = 200;  // of a map's side: as many as the print resolves

/// The values of one key that are different, in rising order, with the place that each has in the list.
struct Axis {
  std::vector<double> values;
  std::vector<std::size_t> places;
};

/// Designs as optimum.csv has them, by the keys whose values are not the same in all.
class Designs {
 public:
  explicit Designs(const ResultTable& table) {
    const Names& columns = table.columns();
    const Names keys(columns.begin() + 1, std::find(columns.begin(), columns.end(), "P_opt"));
    count_ = table.read({"curve"}).front().size();
    std::vector<std::vector<ordered_json>> values = table.read(keys);
    for (std::size_t k = 0; k < keys.size(); ++k) {
      if (std::adjacent_find(values[k].begin(), values[k].end(), std::not_equal_to<>()) == values[k].end())
        continue;
      keys_.push_back(keys[k]);
      values_.push_back(std::move(values[k]));
    }
    is_numeric_ = std::all_of(values_.begin(), values_.end(), [](const auto& column) {
      return std::all_of(column.begin(), column.end(), [](const auto& value) { return value.is_number(); });
    });
  }

  std::size_t count() const { return count_; }
  bool is_numeric() const { return is_numeric_; }
  const Names& keys() const { return keys_; }

  std::string labels() const {
    Names all;
    for (std::size_t i = 0; i < count_; ++i) {
      ordered_json values = ordered_json::object();
      for (std::size_t k = 0; k < keys_.size(); ++k) values[keys_[k]] = values_[k][i];
      all.push_back(label(values, keys_, true));
    }
    return quote_all(all);
  }

  /// Whether every value of the first key stands with every value of the second, which runs faster.
  bool is_grid() const {
    if (!is_numeric_ || keys_.size() != 2) return false;
    const std::size_t second = axis(1).values.size();
    if (axis(0).values.size() * second != count()) return false;
    for (std::size_t i = 0; i < count(); ++i) {
      if (value(0, i) != value(0, i - i % second) || value(1, i) != value(1, i % second)) return false;
    }
    return true;
  }

  bool rises_or_falls() const {
    const auto steps = [&](auto compare) {
      for (std::size_t i = 1; i < count(); ++i) {
        if (!compare(value(0, i - 1), value(0, i))) return false;
      }
      return true;
    };
    return steps(std::less<>()) || steps(std::greater<>());
  }

  /// The values of a key and their places among those of the list that it was given as, counted from 1.
  Axis axis(std::size_t key) const {
    std::map<double, std::size_t> first;
    for (std::size_t i = 0; i < count(); ++i) first.emplace(value(key, i), first.size() + 1);
    Axis axis;
    for (const auto& [number, place] : first) {
      axis.values.push_back(number);
      axis.places.push_back(place);
    }
    return axis;
  }

 private:
  double value(std::size_t key, std::size_t i) const { return values_[key][i].get<double>(); }

  std::size_t count_ = 0;
  Names keys_;
  std::vector<std::vector<ordered_json>> values_;  ///< of each key
  bool is_numeric_ = false;
};

const std::string without_damper = italic("Y") + "_{ND}^{max}";
const std::string ratio_title =
    fmt::format("highest peak{}{}{}^{{max}}/{}", blank, blank, italic("Y"), without_damper);
const std::string peak_title = fmt::format("peaks{}{}{}/{}", blank, blank, italic("Y"), without_damper);
const std::string optimum_title = fmt::format("best preload{}{}{}_{{opt}}", blank, blank, italic("P"));

/// The peaks over the preload: the highest, and all of them.
std::vector<Picture> pictures_over_preload(const Designs& designs) {
  const auto picture = [&](const char* name, const char* lines, const Names& unmarked, const Names& panels) {
    Names names = {axis_title("P", true), ""};
    for (const std::string& type : unmarked) names.insert(names.end(), {type, ""});
    return Picture{
        name,
        "panels",
        {fmt::format("P {} sweep", lines), designs.labels(), "1", quote_all(names), quote_all(panels)},
        "sweep.csv"};
  };
  return {
      picture("ratio", "envelope", {"birth", "death", "exchange", "corner"}, {"ratio", ratio_title}),
      picture("peaks", "regimes", {"corner"}, {"ratio", peak_title, "eta_peak", axis_title("eta", true)})};
}

/// The optimum over the first of the keys that differ.
Picture picture_over_key(const Designs& designs) {
  std::string groups = "1";
  for (std::size_t i = 1; i < designs.count() && !designs.rises_or_falls(); ++i) groups += " 1";
  const std::string& key = designs.keys().front();
  return {"optimum",
          "panels",
          {key + " plain optimum", quote(""), groups, quote_all({axis_title(key, true), ""}),
           quote_all({"P_opt", optimum_title, "ratio_opt", ratio_title})},
          "optimum.csv"};
}

/// The places of an axis that are drawn.
std::string drawn_places(const Axis& axis) {
  const std::size_t every = (axis.places.size() + most_cells - 1) / most_cells;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < axis.places.size(); i += every) places.push_back(axis.places[i]);
  if (places.back() != axis.places.back()) places.push_back(axis.places.back());
  return fmt::format("{}", fmt::join(places, " "));
}

/// The optimum over the plane of two keys.
std::vector<Picture> maps(const Designs& designs) {
  const Names& keys = designs.keys();
  const Axis x = designs.axis(0);
  const Axis y = designs.axis(1);
  const auto map = [&](const char* name, const char* column, const std::string& title) {
    return Picture{name,
                   "map",
                   {keys[0] + " plain optimum", quote(""), "1", quote_all({axis_title(keys[0], true), ""}),
                    quote_all({keys[1], axis_title(keys[1], true), column, title, drawn_places(x),
                               drawn_places(y), std::to_string(y.values.size())})},
                   "optimum.csv"};
  };
  return {map("optimum_preload", "P_opt", optimum_title), map("attenuation", "ratio_opt", ratio_title)};
}

}  // namespace

std::vector<Picture> study_pictures(const std::string& folder, const ordered_json& input) {
  const fs::path path = fs::path(folder) / "optimum.csv";
  const ResultTable table(path, {"curve", "P_opt", "ratio_opt", "kind"}, "designs");
  const Designs designs(table);
  std::vector<Picture> all;
  if (input.at("study").at("sweep").get<bool>() && designs.count() <= most_curves) {
    ResultTable(fs::path(folder) / "sweep.csv",
                {"curve", "peak_branch", "P", "eta_peak", "ratio", "is_global", "type"}, "peaks");
    all = pictures_over_preload(designs);
  }
  if (designs.is_grid()) {
    for (Picture& picture : maps(designs)) all.push_back(std::move(picture));
  } else if (designs.is_numeric() && !designs.keys().empty() &&
             (designs.keys().size() == 1 || designs.rises_or_falls())) {
    all.push_back(picture_over_key(designs));
  }
  return all;
}

}  // namespace arcslip
