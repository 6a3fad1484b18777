#include "pictures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "arcslip/case_file.hpp"

namespace arcslip {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using Names = std::vector<std::string>;

constexpr std::size_t most_panels = 3;
constexpr const char* blank = "\u00a0";  // unbreakable, since readers of SVG drop others beside markup

std::ifstream open(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!fs::is_regular_file(path) || !file) {
    throw InputError(
        fmt::format("{}: cannot be read; expected a file that arcslip run has written", path.string()));
  }
  return file;
}

/// branches.csv, of which only the first line and whether there is a second are read.
class Table {
 public:
  explicit Table(fs::path path) : path_(std::move(path)) {
    std::ifstream file = open(path_);
    std::string line;
    std::getline(file, line);
    std::istringstream header(line);
    for (std::string name; std::getline(header, name, ',');) columns_.push_back(name);
    require({"branch", "point", "type", "regime"});
    if (!std::getline(file, line)) throw InputError(fmt::format("{}: holds no points", path_.string()));
  }

  const Names& columns() const { return columns_; }
  bool has(const std::string& name) const {
    return std::find(columns_.begin(), columns_.end(), name) != columns_.end();
  }

  void require(const Names& names) const {
    for (const std::string& name : names) {
      if (has(name)) continue;
      throw InputError(fmt::format("{}: has no column {}; expected a table that arcslip run has written",
                                   path_.string(), name));
    }
  }

 private:
  fs::path path_;
  Names columns_;
};

/// Text without what gnuplot would take for markup or for the end of a word.
std::string plain(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  std::erase_if(text,
                [](char c) { return std::string_view("\"\\{}^@&~").find(c) != std::string_view::npos; });
  return text;
}

std::string italic(const std::string& text) { return fmt::format("{{/:Italic {}}}", text); }

/// A name of a library problem: Greek letters by their sign, "u1" and "u_mid" with indices, words as they
/// are.
std::string library_symbol(const std::string& name) {
  static const std::map<std::string, std::string, std::less<>> greek = {
      {"alpha", "α"}, {"beta", "β"},  {"gamma", "γ"},  {"delta", "δ"}, {"epsilon", "ε"}, {"zeta", "ζ"},
      {"eta", "η"},   {"kappa", "κ"}, {"lambda", "λ"}, {"mu", "μ"},    {"nu", "ν"},      {"xi", "ξ"},
      {"rho", "ρ"},   {"sigma", "σ"}, {"tau", "τ"},    {"omega", "ω"}, {"Omega", "Ω"}};
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  std::size_t end = std::min(name.find('_'), name.size());
  const bool has_underscore = end < name.size();
  if (!has_underscore)
    end = static_cast<std::size_t>(std::find_if(name.begin(), name.end(), is_digit) - name.begin());
  const std::string stem = name.substr(0, end);
  const auto letter = greek.find(stem);
  if (letter == greek.end() && stem.size() != 1) return plain(name);
  const std::string index = plain(name.substr(end + (has_underscore ? 1 : 0)));
  const std::string sign = italic(letter == greek.end() ? plain(stem) : letter->second);
  return index.empty() ? sign : fmt::format("{}_{{{}}}", sign, index);
}

/// The symbol that the paper has for a key of [system] or a column, in gnuplot's markup.
std::string symbol(const std::string& name, bool is_friction) {
  static const std::map<std::string, std::string, std::less<>> symbols = {
      {"preload", italic("P")},
      {"force", italic("F")},
      {"wave_number", italic("n")},
      {"elements", italic("N")},
      {"mass_ratio", italic("M") + "*"},
      {"frequency_ratio", italic("γ")},
      {"slenderness", italic("L") + "/" + italic("h") + "_D"},
      {"poisson_ratio", italic("ν")},
      {"interface_stiffness", italic("K") + "_{FD}"},
      {"circumference", italic("L")},
      {"radius", italic("r")},
      {"friction_coefficient", italic("μ")},
      {"preload_per_length", italic("p") + "_0"},
      {"force_per_length", italic("f") + "_0"},
      {"R_over_S", italic("R") + "/" + italic("S")}};
  const auto found = symbols.find(name);
  return !is_friction || found == symbols.end() ? library_symbol(name) : found->second;
}

/// What stands along an axis.
std::string axis_title(const std::string& name, bool is_friction) {
  static const std::map<std::string, std::string, std::less<>> words = {{"eta", "frequency"},
                                                                        {"P", "preload"},
                                                                        {"zeta_B", "base damping"},
                                                                        {"R_over_S", "relative amplitude"},
                                                                        {"Y", "amplitude"}};
  const auto found = words.find(name);
  if (!is_friction || found == words.end()) return symbol(name, is_friction);
  return fmt::format("{}{}{}{}", found->second, blank, blank, symbol(name, true));
}

std::string quote(const std::string& text) { return fmt::format("\"{}\"", text); }

std::string quote_all(const Names& texts) {
  std::string words;
  for (const std::string& text : texts) words += fmt::format("{}\"{}\"", words.empty() ? "" : " ", text);
  return words;
}

std::string value_text(const ordered_json& value) {
  if (value.is_string()) return plain(value.get<std::string>());
  if (!value.is_number()) return plain(value.dump());
  std::string text = fmt::format("{:.6g}", value.get<double>());
  for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos; at += std::string_view("−").size())
    text.replace(at, 1, "−");
  return text;
}

/// "P = 0.1" for those of a branch's values that `differ`.
std::string label(const ordered_json& values, const Names& differ, bool is_friction) {
  Names parts;
  for (const auto& [key, value] : values.items()) {
    if (std::find(differ.begin(), differ.end(), key) == differ.end()) continue;
    parts.push_back(fmt::format("{}{}={}{}", symbol(key, is_friction), blank, blank, value_text(value)));
  }
  return fmt::format("{}", fmt::join(parts, fmt::format(",{}", blank)));
}

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
  Decision(const Table& table, const ordered_json& summary)
      : table_(table), system_(summary.at("case").at("system")), branch_(summary.at("case").at("branch")) {
    const std::string model = system_.at("model").get<std::string>();
    is_friction_ = model == "rods" || model == "beams";
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
    table_.require({parameter, "S", "R_over_S", "Y", "beta", "alpha", "psi", "dissipated"});
    std::vector<Picture> all;
    for (const char* name : {"amplitude", "relative", "phases", "dissipated"})
      all.push_back({name, name, settings(parameter, "regimes", quote(""))});
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
        {"fold", "folds"},       {"branch_point", "branch points"},
        {"hopf", "Hopf points"}, {"peak", "peaks"},
        {"trough", "troughs"},   {"switch", italic("R") + blank + "=" + blank + italic("S")}};
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
    const std::string names = quote_all({lines.at(type), "fold", second, "peak", extremum("peak"), "trough",
                                         extremum("trough"), "user", is_requested_ ? "requested" : ""});
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
        parameter == "eta" && is_friction_
            ? axis_title(parameter, true) + fmt::format("{}={}{{/:Italic ω}}/{{/:Italic Ω}}_D", blank, blank)
            : axis_title(parameter, is_friction_);
    return {fmt::format("{} {}", parameter, style), colours_.labels, colours_.groups,
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
    return {name, "panels", all};
  }

  const Table& table_;
  const ordered_json& system_;
  const ordered_json& branch_;
  bool is_friction_ = false;
  bool is_requested_ = false;
  Colours colours_;
};

}  // namespace

std::vector<Picture> pictures_of(const std::string& folder) {
  if (!fs::is_directory(folder)) {
    throw InputError(fmt::format("{}: is not a folder; expected one that arcslip run has written", folder));
  }
  const Table table(fs::path(folder) / "branches.csv");
  const std::string path = (fs::path(folder) / "summary.json").string();
  std::ifstream file = open(path);
  try {
    const ordered_json summary = ordered_json::parse(file);
    return Decision(table, summary).pictures();
  } catch (const ordered_json::parse_error& error) {
    throw InputError(fmt::format("{}: is not JSON (byte {})", path, error.byte));
  } catch (const ordered_json::exception&) {
    throw InputError(fmt::format("{}: is not a summary that arcslip run has written", path));
  } catch (const std::out_of_range&) {
    throw InputError(fmt::format("{}: is not a summary that arcslip run has written", path));
  }
}

}  // namespace arcslip
