#include "app/pictures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>

#include "app/picture_text.hpp"
#include "app/study_pictures.hpp"
#include "arcslip/cases/case_file.hpp"
#include "arcslip/version.hpp"
#include "cases/structure_kind.hpp"
#include "results/result_table.hpp"

namespace arcslip {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using Names = std::vector<std::string>;

constexpr std::size_t most_panels = 3;

/// The colours of the branches. Those that one request led to have the same, and its values for a label; of a
/// single request each branch has its own, without a label.
struct Colours {
  std::string labels;  ///< one word for each colour
  std::string groups;  ///< one word for each branch: the number of its colour
};

Colours colours_of(const ordered_json& branches, bool is_friction) {
  Names differ;
  const ordered_json& first = branches.at(0).at("values");
  for (const auto& [key, value] : first.items()) {
    const auto same = [&, &name = key, &expected = value](const ordered_json& branch) {
      return branch.at("values").at(name) == expected;
    };
    if (!std::all_of(branches.begin(), branches.end(), same)) differ.push_back(key);
  }
  Names labels;
  Names groups;
  for (const ordered_json& branch : branches) {
    const std::string text = label(branch.at("values"), differ, is_friction);
    const auto known = std::find(labels.begin(), labels.end(), text);
    const auto group = differ.empty() ? groups.size() : static_cast<std::size_t>(known - labels.begin());
    if (differ.empty()) labels.emplace_back();
    if (!differ.empty() && known == labels.end()) labels.push_back(text);
    groups.push_back(std::to_string(group + 1));
  }
  return {quote_all(labels), fmt::format("{}", fmt::join(groups, " "))};
}

/// Decides what is drawn of a run.
class Decision {
 public:
  /// `drawn` is the table that pictures are drawn from.
  Decision(const ResultTable& table, const ordered_json& summary, std::string drawn)
      : table_(table),
        drawn_(std::move(drawn)),
        system_(summary.at("case").at("system")),
        branch_(summary.at("case").at("branch")) {
    const std::string model = system_.at("model").get<std::string>();
    const StructureKind* kind = structure_of(model);
    is_friction_ = kind != nullptr;
    is_relative_ = is_friction_ && kind->frequency_unit.empty();
    is_requested_ = !summary.at("case").at("continuation").at("stop_at").empty();
    colours_ = colours_of(summary.at("branches"), is_friction_);
  }

  std::vector<Picture> pictures() const {
    if (branch_.contains("curve")) return of_curves();
    const std::string parameter = branch_.at("parameter").get<std::string>();
    if (!is_friction_) {
      const bool known = table_.has("unstable");
      return {panels("branch", parameter, known ? "stability" : "plain", observables(parameter), quote(""))};
    }
    if (branch_.value("response", "forced") == "limit_cycle")
      return {panels("limit_cycle", parameter, "plain", {"R_over_S", "eta"}, quote(""))};
    if (branch_.value("response", "forced") == "nonlinear_mode")
      return {panels("nonlinear_mode", parameter == "R" ? "R_over_S" : parameter, "plain", {"eta", "zeta"},
                     quote(""))};
    table_.require({parameter, "S", "R_over_S", "Y", "beta", "alpha", "psi", "dissipated"});
    std::vector<Picture> all;
    for (const char* name : {"amplitude", "relative", "phases", "phase_difference", "dissipated"})
      all.push_back({name, name,
                     settings(parameter, table_.has("unstable") ? "stability" : "regimes", quote("")),
                     drawn_});
    return all;
  }

 private:
  /// The columns between the parameters, which are settings of the system, and what is said of the step.
  /// Those whose extrema are asked for come first.
  Names observables(const std::string& parameter) const {
    Names found;
    for (const ordered_json& name : branch_.value("extrema_of", ordered_json::array()))
      found.push_back(name.get<std::string>());
    for (std::size_t i = 4; i < table_.columns().size(); ++i) {
      const std::string& name = table_.columns()[i];
      if (name == "unstable" || name == "arclength") break;
      if (name == parameter || system_.contains(name)) continue;
      if (std::find(found.begin(), found.end(), name) == found.end()) found.push_back(name);
    }
    found.resize(std::min(found.size(), most_panels));
    return found;
  }

  std::vector<Picture> of_curves() const {
    static const std::map<std::string, std::string, std::less<>> lines = {
        {"fold", "folds"},
        {"branch_point", "branch points"},
        {"hopf", "Hopf points"},
        {"peak", "peaks"},
        {"trough", "troughs"},
        {"switch", italic("R") + blank + "=" + blank + italic("S")},
        {"phase_resonance", "phase resonances"}};
    const Names pair = branch_.at("parameters").get<Names>();
    const std::string type = branch_.at("curve").get<std::string>();
    // Along a curve the parameter turns; extrema are those of the first parameter, or on a ridge its
    // height's.
    const bool is_ridge = type == "peak" || type == "trough";
    const std::string height =
        branch_.contains("extrema_of") ? branch_.at("extrema_of").at(0).get<std::string>() : "Y";
    const std::string second = fmt::format("fold{}in{}{}", blank, blank, symbol(pair.at(1), is_friction_));
    const auto extremum = [&](const char* kind) {
      return fmt::format("{}{}of{}{}", kind, blank, blank,
                         is_ridge ? italic(height) : symbol(pair.at(0), is_friction_));
    };
    const std::string names = quote_all(
        {type == "level" ? branch_.at("level_of").get<std::string>() : lines.at(type), "fold", second, "peak",
         extremum("peak"), "trough", extremum("trough"), "user", is_requested_ ? "requested" : ""});
    const bool has_regimes =
        is_friction_ && type != "switch" && branch_.value("response", "") != "limit_cycle";
    const char* style = has_regimes ? "regimes" : "plain";
    std::vector<Picture> all = {panels("curve", pair.at(0), style, {pair.at(1)}, names)};
    if (is_friction_) all.push_back(panels("amplitude", pair.at(1), style, {"Y"}, names));
    return all;
  }

  /// See plots/style.gp.
  Names settings(const std::string& parameter, const std::string& style, const std::string& names) const {
    const std::string title =
        parameter == "eta" && is_relative_
            ? axis_title(parameter, true) + fmt::format("{}={}{{/:Italic ω}}/{{/:Italic Ω}}_D", blank, blank)
            : axis_title(parameter, is_friction_);
    return {fmt::format("{} {} branch", parameter, style), colours_.labels, colours_.groups,
            fmt::format("{} {}", quote(title), names)};
  }

  /// A picture with a panel for each of the columns over the parameter.
  Picture panels(const std::string& name, const std::string& parameter, const std::string& style,
                 const Names& columns, const std::string& names) const {
    table_.require({parameter, "arclength"});
    table_.require(columns);
    Names words;
    for (const std::string& column : columns) {
      words.push_back(column);
      words.push_back(axis_title(column, is_friction_));
    }
    Names all = settings(parameter, style, names);
    all.push_back(quote_all(words));
    return {name, "panels", all, drawn_};
  }

  const ResultTable& table_;
  std::string drawn_;
  const ordered_json& system_;
  const ordered_json& branch_;
  bool is_friction_ = false;
  bool is_relative_ = false;
  bool is_requested_ = false;
  Colours colours_;
};

}  // namespace

std::string drawn_table(const std::string& folder) {
  const auto path = [&](const char* name) { return fs::path(folder) / name; };
  const auto header = [&](const char* name) {
    std::ifstream file(path(name));
    std::string line;
    std::getline(file, line);
    return line;
  };
  std::error_code none;
  const bool newer =
      fs::last_write_time(path("branches.csv"), none) > fs::last_write_time(path("curves.csv"), none);
  return !newer && header("curves.csv") == header("branches.csv") ? "curves.csv" : "branches.csv";
}

ordered_json summary_of(const std::string& folder) {
  std::error_code none;
  if (!fs::is_directory(folder, none)) {
    throw InputError(
        fmt::format("{}: is not a folder; expected one that arcslip run or study has written", folder));
  }
  const std::string path = (fs::path(folder) / "summary.json").string();
  std::ifstream file = open_results(path);
  try {
    return ordered_json::parse(file);
  } catch (const ordered_json::parse_error& error) {
    throw InputError(fmt::format("{}: is not JSON (byte {})", path, error.byte));
  }
}

std::string reading(const std::string& folder, const ordered_json& summary,
                    const std::function<std::string()>& use) {
  const std::string version =
      summary.is_object() && summary.contains("arcslip") ? summary.at("arcslip").dump() : "";
  const std::string other =
      version.empty() || version == fmt::format("\"{}\"", release)
          ? ""
          : fmt::format(" (the results are of arcslip {}, this is \"{}\"; run the case again)", version,
                        release);
  const auto refuse = [&] {
    return InputError(fmt::format("{}: is not a summary that arcslip has written{}",
                                  (fs::path(folder) / "summary.json").string(), other));
  };
  try {
    return use();
  } catch (const InputError& error) {
    throw InputError(error.what() + other);
  } catch (const ordered_json::exception&) {
    throw refuse();
  } catch (const std::out_of_range&) {
    throw refuse();
  }
}

std::vector<Picture> pictures_of(const std::string& folder) {
  const ordered_json summary = summary_of(folder);
  std::vector<Picture> all;
  reading(folder, summary, [&] {
    const bool has_run = !summary.at("case").contains("study");
    if (has_run) {
      const ResultTable table(fs::path(folder) / "branches.csv", {"branch", "point", "type", "regime"},
                              "points");
      all = Decision(table, summary, drawn_table(folder)).pictures();
    }
    if (!has_run || summary.contains("study")) {
      const ordered_json& study = has_run ? summary.at("study") : summary;
      for (Picture& picture : study_pictures(folder, study.at("case"))) all.push_back(std::move(picture));
    }
    return "";
  });
  if (!all.empty()) return all;
  throw InputError(
      fmt::format("{}: nothing to draw; expected sweep.csv of at most {} designs beside it, or one or two "
                  "keys of for_each with numbers",
                  (fs::path(folder) / "optimum.csv").string(), most_curves));
}

}  // namespace arcslip
