#include "results/study_extras.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace arcslip {
namespace {

void append(std::vector<ExtraColumn>& columns, bool wanted, const std::vector<ExtraColumn>& more) {
  if (wanted) columns.insert(columns.end(), more.begin(), more.end());
}

std::string insertion(const std::string& table, std::size_t columns) {
  return fmt::format("INSERT INTO {} VALUES ({})", table,
                     fmt::join(std::vector<std::string>(columns, "?"), ","));
}

}  // namespace

std::vector<std::string> quantile_names(const problems::Uncertainty& uncertainty, const char* prefix) {
  std::vector<std::string> names;
  for (const double quantile : uncertainty.quantiles)
    names.push_back(fmt::format("{}q{:g}", prefix, 100 * quantile));
  return names;
}

StudyExtras::StudyExtras(const StudyCase& study) : study_(study) {
  has_harmonics_ = std::count(study.keys.begin(), study.keys.end(), "harmonics") > 0 ||
                   study.design(0).harmonics_tolerance.has_value();
}

std::string StudyExtras::tables() const {
  std::string sql;
  if (has_harmonics_)
    sql += "CREATE TABLE harmonics (curve INTEGER PRIMARY KEY, count INTEGER, orders TEXT);";
  if (is_physical())
    sql += "CREATE TABLE units (curve INTEGER PRIMARY KEY, frequency, length, preload, energy);";
  if (has_robust())
    sql += "CREATE TABLE robust (curve INTEGER PRIMARY KEY, P, Y, Y_opt, error, sampling_error);";
  if (has_quantiles()) {
    sql += fmt::format(
        "CREATE TABLE quantiles (curve, point, P, \"{}\", \"{}\", PRIMARY KEY (curve, point)) WITHOUT ROWID;",
        fmt::join(quantile_names(*study_.uncertain), "\", \""),
        fmt::join(quantile_names(*study_.uncertain, "error_"), "\", \""));
  }
  return sql;
}

void StudyExtras::open(const Database& database) {
  if (has_harmonics_) insert_harmonics_ = database.prepare(insertion("harmonics", 3));
  if (is_physical()) insert_units_ = database.prepare(insertion("units", 5));
  if (has_robust()) insert_robust_ = database.prepare(insertion("robust", 6));
  if (has_quantiles())
    insert_quantiles_ = database.prepare(insertion("quantiles", 3 + 2 * study_.uncertain->quantiles.size()));
}

void StudyExtras::close() {
  insert_harmonics_.reset();
  insert_units_.reset();
  insert_robust_.reset();
  insert_quantiles_.reset();
}

void StudyExtras::add(std::size_t curve, const problems::PreloadStudy& result,
                      const problems::UncertainPeaks* uncertain) {
  const auto key = static_cast<std::int64_t>(curve);
  if (!result.harmonics.empty()) {
    insert_harmonics_->bind(key).bind(static_cast<std::int64_t>(result.harmonics.size()));
    insert_harmonics_->bind(fmt::format("{}", fmt::join(result.harmonics, " "))).run();
  }
  if (is_physical()) {
    const PhysicalScale scale = study_.design(curve).physical.value();
    insert_units_->bind(key).bind(scale.frequency(1)).bind(scale.displacement(1));
    insert_units_->bind(scale.preload(1)).bind(scale.energy(1)).run();
  }
  if (uncertain == nullptr || !uncertain->failure.empty()) return;
  insert_robust_->bind(key).bind(uncertain->preload).bind(uncertain->Y);
  insert_robust_->bind(uncertain->Y_nominal).bind(uncertain->error).bind(uncertain->sampling_error).run();
  if (!has_quantiles()) return;
  std::int64_t point = 0;
  for (const problems::QuantileRow& row : uncertain->rows) {
    insert_quantiles_->bind(key).bind(point++).bind(row.preload);
    for (const double Y : row.Y) insert_quantiles_->bind(Y);
    for (const double error : row.errors) insert_quantiles_->bind(error);
    insert_quantiles_->run();
  }
}

std::vector<ExtraColumn> StudyExtras::optimum_columns() const {
  if (!is_physical()) return {};
  return {{preload_name(), "d.P_opt*u.preload"},
          {preload_name("low_"), "d.P_low*u.preload"},
          {preload_name("high_"), "d.P_high*u.preload"},
          {"frequency_Hz", "d.eta_opt*u.frequency"},
          {"Y_m", "d.Y_opt*u.length"},
          {"Y_nd_max_m", "d.Y_nd_max*u.length"},
          {"energy_J", "d.energy*u.energy"}};
}

std::vector<ExtraColumn> StudyExtras::sweep_columns() const {
  if (!is_physical()) return {};
  return {{preload_name(), "s.P*u.preload"},
          {"frequency_Hz", "s.eta_peak*u.frequency"},
          {"Y_m", "s.Y_max*u.length"}};
}

std::string StudyExtras::join_units() const {
  return is_physical() ? " LEFT JOIN units u ON u.curve = d.curve" : "";
}

std::vector<ExtraColumn> StudyExtras::robust_columns() const {
  std::vector<ExtraColumn> columns = {{"P_q95", "r.P"},
                                      {"Y_q95", "r.Y"},
                                      {"ratio_q95", "r.Y/d.Y_nd_max"},
                                      {"P_opt", "d.P_opt"},
                                      {"Y_q95_opt", "r.Y_opt"},
                                      {"ratio_q95_opt", "r.Y_opt/d.Y_nd_max"},
                                      {"error", "r.error"},
                                      {"sampling_error", "r.sampling_error"}};
  append(columns, is_physical(), {{preload_name(), "r.P*u.preload"}, {"Y_q95_m", "r.Y*u.length"}});
  return columns;
}

std::vector<ExtraColumn> StudyExtras::quantile_columns() const {
  std::vector<ExtraColumn> columns = {{"curve", "q.curve"}, {"P", "q.P"}};
  const std::vector<std::string> names = quantile_names(study_.uncertain.value());
  for (const std::string& name : names) columns.push_back({"Y_" + name, fmt::format("q.\"{}\"", name)});
  for (const std::string& name : names)
    columns.push_back({"ratio_" + name, fmt::format("q.\"{}\"/d.Y_nd_max", name)});
  for (const std::string& name : quantile_names(*study_.uncertain, "error_"))
    columns.push_back({name, fmt::format("q.\"{}\"", name)});
  append(columns, is_physical(), {{preload_name(), "q.P*u.preload"}});
  return columns;
}

}  // namespace arcslip
