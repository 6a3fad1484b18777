// The files of a study, read from its database.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/study_columns.hpp"
#include "results/study_store.hpp"

namespace arcslip {
namespace {

using problems::Peak;

/// The columns of sweep.csv.
const std::vector<ExtraColumn> sweep_columns = {{"curve", "s.curve"},
                                                {"peak_branch", "s.peak_branch"},
                                                {"P", "s.P"},
                                                {"eta_peak", "s.eta_peak"},
                                                {"Y_max", "s.Y_max"},
                                                {"Y_nd_max", "d.Y_nd_max"},
                                                {"ratio", "s.Y_max/d.Y_nd_max"},
                                                {"R_over_S", "s.R_over_S"},
                                                {"dissipated", "s.dissipated"},
                                                {"is_global", "s.is_global"},
                                                {"type", "s.type"},
                                                {"site", "s.site"},
                                                {"by_P", "s.by_P"},
                                                {"by_mu", "s.by_mu"},
                                                {"by_F", "s.by_F"},
                                                {"by_mass_ratio", "s.by_mass_ratio"},
                                                {"by_frequency_ratio", "s.by_frequency_ratio"}};

/// The column of a design that has its number, and those of for_each.
std::vector<ExtraColumn> key_columns(const std::vector<std::string>& keys, std::size_t each) {
  std::vector<ExtraColumn> columns = {{"curve", fmt::format("d.curve/{}", each)}};
  for (const std::string& key : keys) columns.push_back({key, "d." + sql_name(key)});
  return columns;
}

/// All rows of a query as CSV, below the names of its columns.
void write_table(const Database& database, const std::vector<ExtraColumn>& columns, const std::string& tables,
                 const Sink& sink) {
  std::vector<std::string> names;
  std::vector<std::string> values;
  for (const ExtraColumn& column : columns) {
    names.push_back(column.name);
    values.push_back(column.value);
  }
  sink(fmt::format("{}\n", fmt::join(names, ",")));
  Statement query = database.prepare(fmt::format("SELECT {} FROM {}", fmt::join(values, ", "), tables));
  std::string row;
  while (query.step()) {
    row.clear();
    for (int i = 0; i < query.columns(); ++i) {
      if (i > 0) row += ',';
      query.write_csv(i, row);
    }
    row += '\n';
    sink(row);
  }
}

}  // namespace

void StudyStore::write_optimum(const Sink& sink) const {
  std::vector<ExtraColumn> columns = key_columns(keys_, each_);
  for (const char* name : optimum_columns) columns.push_back({name, fmt::format("d.{}", name)});
  for (const ExtraColumn& column : extras_.optimum_columns()) columns.push_back(column);
  write_table(*database_, columns,
              "designs d" + extras_.join_units() + of_equal_rings(each_) + " ORDER BY d.curve", sink);
}

void StudyStore::write_sweep(const Sink& sink) const {
  std::vector<ExtraColumn> columns = sweep_columns;
  columns.front().value = fmt::format("s.curve/{}", each_);
  for (const ExtraColumn& column : extras_.sweep_columns()) columns.push_back(column);
  write_table(*database_, columns,
              "sweep s CROSS JOIN designs d ON d.curve = s.curve" + extras_.join_units() +
                  of_equal_rings(each_) + " ORDER BY s.curve, s.peak_branch, s.point",
              sink);
}

void StudyStore::write_robust(const Sink& sink) const {
  std::vector<ExtraColumn> columns = key_columns(keys_, each_);
  for (const ExtraColumn& column : extras_.robust_columns()) columns.push_back(column);
  write_table(
      *database_, columns,
      "designs d LEFT JOIN robust r ON r.curve = d.curve" + extras_.join_units() + " ORDER BY d.curve", sink);
}

void StudyStore::write_quantiles(const Sink& sink) const {
  write_table(*database_, extras_.quantile_columns(),
              "quantiles q CROSS JOIN designs d ON d.curve = q.curve" + extras_.join_units() +
                  " ORDER BY q.curve, q.point",
              sink);
}

void StudyStore::write_patterns(const Sink& sink) const {
  std::vector<ExtraColumn> columns = key_columns(keys_, each_);
  columns.push_back({"pattern", fmt::format("d.curve % {}", each_)});
  for (const char* name : {"P_opt", "eta_opt", "Y_opt", "kind"})
    columns.push_back({name, fmt::format("d.{}", name)});
  write_table(*database_, columns, "designs d ORDER BY d.curve", sink);
}

std::vector<problems::PeakBranch> StudyStore::branches(std::size_t item) const {
  Statement row = database_->prepare(
      fmt::format("SELECT peak_branch, P, Y_max, by_P, is_global, site FROM sweep WHERE curve = {} ORDER BY "
                  "peak_branch, point",
                  item));
  std::vector<problems::PeakBranch> all;
  while (row.step()) {
    if (static_cast<std::size_t>(row.integer(0)) == all.size()) all.emplace_back();
    Peak peak;
    peak.preload = row.real(1);
    peak.Y = row.real(2);
    peak.sensitivity.preload = row.real(3);
    peak.is_global = row.integer(4) != 0;
    peak.site = row.text(5) == to_string(problems::PeakSite::stick) ? problems::PeakSite::stick
                                                                    : problems::PeakSite::slip;
    all.back().push_back(peak);
  }
  return all;
}

}  // namespace arcslip
