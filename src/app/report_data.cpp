#include "app/report_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <unordered_map>
#include <vector>

#include "app/results_folder.hpp"
#include "arcslip/cases/case_file.hpp"
#include "arcslip/version.hpp"
#include "cases/structure_kind.hpp"
#include "results/answer.hpp"
#include "results/result_table.hpp"

namespace arcslip {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::size_t most_report_rows = 100'000;  // of a table: a page that browsers still draw at once

/// As it may stand in a script: no "<", by which one could end.
std::string script_text(const ordered_json& value) {
  std::string text = value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  std::string safe;
  for (const char c : text) c == '<' ? safe.append("\\u003c") : safe.append(1, c);
  return safe;
}

/// A column of a table as JSON, to which values are added one by one.
class JsonColumn {
 public:
  void add(const std::string& field) {
    double number = 0;
    const char* const end = field.data() + field.size();
    const auto [at, error] = std::from_chars(field.data(), end, number);
    const bool is_number = error == std::errc() && at == end;
    const auto place = places_.try_emplace(is_number ? "" : field, places_.size()).first->second;
    is_text_ = is_text_ || !is_number;
    const char* const comma = numbers_.empty() ? "" : ",";
    numbers_ +=
        is_number && std::isfinite(number) ? fmt::format("{}{}", comma, number) : comma + std::string("null");
    words_ += fmt::format("{}{}", comma, place);
  }

  std::string text() const {
    if (!is_text_) return "[" + numbers_ + "]";
    std::vector<std::string> words(places_.size());
    for (const auto& [word, place] : places_) words[place] = word;
    return fmt::format(R"({{"words":{},"at":[{}]}})", script_text(words), words_);
  }

 private:
  std::unordered_map<std::string, std::size_t> places_;
  std::string numbers_;
  std::string words_;
  bool is_text_ = false;
};

/// What of a table nobody looks at in a picture.
bool is_shown(const std::string& column) { return column != "iterations" && column != "residual"; }

std::size_t count_rows(const ResultTable& table) {
  std::size_t rows = 0;
  table.for_each_row([&](const std::vector<std::string>& /*fields*/) { ++rows; });
  return rows;
}

/// A table; of too many rows those that are special, and of the others as many as there is room for.
std::string table_text(const ResultTable& table) {
  const std::size_t rows = count_rows(table);
  const std::size_t every = (rows + most_report_rows - 1) / most_report_rows;
  const std::optional<std::size_t> type =
      table.has("type") ? std::optional(table.place("type")) : std::nullopt;
  std::vector<JsonColumn> columns(table.columns().size());
  std::size_t row = 0;
  table.for_each_row([&](const std::vector<std::string>& fields) {
    const bool is_special = type && fields[*type] != "regular";
    if (row++ % every != 0 && !is_special) return;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (is_shown(table.columns()[k])) columns[k].add(fields[k]);
    }
  });
  std::string text;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (!is_shown(table.columns()[k])) continue;
    text +=
        fmt::format("{}{}:{}", text.empty() ? "" : ",", script_text(table.columns()[k]), columns[k].text());
  }
  return fmt::format(R"({{"rows":{},"every":{},"columns":{{{}}}}})", rows, every, text);
}

std::string run_text(const fs::path& folder, const ordered_json& summary) {
  const ResultTable branches(folder / "branches.csv", {"branch", "point", "type", "regime", "arclength"},
                             "points");
  std::vector<std::string> answer = run_answer(summary);
  std::string more;
  std::error_code none;
  if (fs::exists(folder / "verify.csv", none)) {
    const ResultTable verified(folder / "verify.csv",
                               {"branch", "point", "type", "difference_harmonics", "difference_time"},
                               "points");
    if (const std::string sentence = verification_answer(verified); !sentence.empty())
      answer.push_back(sentence);
    more = R"(,"verified":)" + table_text(verified);
  }
  if (fs::exists(folder / "sectors.csv", none)) {
    const ResultTable sectors(folder / "sectors.csv",
                              {"branch", "point", "type", "eta", "P", "sector", "contact", "state"},
                              "contacts");
    if (const std::size_t rows = count_rows(sectors); rows > 0 && rows <= most_report_rows)
      more += R"(,"sectors":)" + table_text(sectors);
  }
  const std::string drawn = drawn_table(folder.string());
  ordered_json own = summary;
  own.erase("study");
  return fmt::format(R"({{"answer":{},"summary":{},"table":{},"points":{}{}}})", script_text(answer),
                     script_text(own), script_text(drawn),
                     table_text(ResultTable(folder / drawn, branches.columns(), "points")), more);
}

std::string study_text(const fs::path& folder, const ordered_json& summary) {
  struct Part {
    const char* name;
    const char* holds;
    std::vector<std::string> columns;
  };
  const std::array parts = {
      Part{"optimum",
           "designs",
           {"curve", "P_opt", "eta_opt", "Y_opt", "ratio_opt", "kind", "P_low", "P_high"}},
      Part{"sweep", "peaks", {"curve", "peak_branch", "P", "eta_peak", "Y_max", "is_global", "type"}},
      Part{"robust", "designs", {"curve", "P_q95", "Y_q95", "Y_q95_opt"}},
      Part{"quantiles", "preloads", {"curve", "P"}}};
  std::string text =
      fmt::format(R"({{"answer":{},"summary":{})",
                  script_text(study_answer(folder.string(), summary.at("case"))), script_text(summary));
  for (const Part& part : parts) {
    const fs::path path = folder / fmt::format("{}.csv", part.name);
    std::error_code none;
    if (fs::exists(path, none) || &part == &parts.front())
      text += fmt::format(R"(,"{}":{})", part.name, table_text(ResultTable(path, part.columns, part.holds)));
  }
  return text + "}";
}

}  // namespace

std::string report_data(const std::string& folder) {
  const ordered_json summary = summary_of(folder);
  return reading(folder, summary, [&] {
    const bool has_run = !summary.at("case").contains("study");
    if (summary.at("case").contains(ordered_json::json_pointer("/branch/surface")))
      throw InputError(
          fmt::format("{}: holds a surface, which reports do not show; arcslip plot draws it", folder));
    ordered_json models;
    for (const StructureKind& kind : structure_kinds()) {
      for (const std::string& model : kind.models) models[model] = kind.frequency_unit;
    }
    std::string text = fmt::format(R"({{"arcslip":"{}","by":{},"models":{})", release,
                                   script_text(summary.at("arcslip")), script_text(models));
    if (has_run) text += R"(,"run":)" + run_text(folder, summary);
    if (!has_run || summary.contains("study"))
      text += R"(,"study":)" + study_text(folder, has_run ? summary.at("study") : summary);
    return text + "}";
  });
}

}  // namespace arcslip
