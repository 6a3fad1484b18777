#include "results/study_store.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "arcslip/version.hpp"
#include "results/output.hpp"
#include "results/study_columns.hpp"
#include "results/summary_file.hpp"

namespace arcslip {
namespace {

using nlohmann::ordered_json;
using problems::Optimum;
using problems::Peak;
using problems::PeakSensitivity;

/// What is stored of each peak; sweep.csv shows Y_nd_max and the ratio as well.
constexpr std::array peak_columns = {
    "curve",     "peak_branch", "point", "P",    "eta_peak", "Y_max", "R_over_S",      "dissipated",
    "is_global", "type",        "site",  "by_P", "by_mu",    "by_F",  "by_mass_ratio", "by_frequency_ratio"};
std::string placeholders(std::size_t count) {
  return fmt::format("{}", fmt::join(std::vector<std::string>(count, "?"), ","));
}

/// The tables of a study with its input, in an empty database.
void create(Database& database, const StudyCase& study) {
  std::string columns;
  for (const std::string& key : study.keys) columns += sql_name(key) + ", ";
  columns += fmt::format("{}", fmt::join(optimum_columns, ", "));
  // Columns without a type keep what they are given to the last bit.
  database.execute(
      fmt::format("BEGIN;"
                  "CREATE TABLE study (version TEXT, input TEXT, designs INTEGER, checksum INTEGER);"
                  "CREATE TABLE runs (run INTEGER PRIMARY KEY, begun TEXT DEFAULT CURRENT_TIMESTAMP);"
                  "CREATE TABLE designs (curve INTEGER PRIMARY KEY, {}, failure TEXT, free_eta, run INTEGER, "
                  "checksum INTEGER);"
                  "CREATE TABLE sweep ({}, PRIMARY KEY (curve, peak_branch, point)) WITHOUT ROWID;{}",
                  columns, fmt::join(peak_columns, ", "), StudyExtras(study).tables()));
  database.prepare("INSERT INTO study VALUES (?, ?, ?, NULL)")
      .bind(release)
      .bind(study.resolved.dump())
      .bind(static_cast<std::int64_t>(study.items()))
      .run();
  database.prepare("UPDATE study SET checksum = ?").bind(input_checksum(database)).run();
  database.execute("COMMIT");
}

void remove(const std::string& path) {
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
}

bool is_there(const std::string& path) {
  std::error_code none;
  return std::filesystem::exists(path, none);
}

/// Brings what stands beside a database into it, and makes sure that nobody else uses it.
void settle(const std::string& path) {
  if (is_there(path)) Database(path).execute("PRAGMA journal_mode = DELETE");
}

/// The key that differs between the input of a study before and now, or empty.
std::string difference(ordered_json before, const StudyCase& study) {
  ordered_json now = ordered_json::parse(study.resolved.dump());
  before.erase("title");
  now.erase("title");
  if (before == now) return "";
  const ordered_json change = ordered_json::diff(before, now);
  std::string key = change.empty() ? "/study/for_each" : change[0]["path"].get<std::string>();
  std::replace(key.begin(), key.end(), '/', '.');
  return key.substr(1);
}

void bind(Statement& row, const ordered_json& value) {
  if (value.is_number_integer()) {
    row.bind(value.get<std::int64_t>());
  } else if (value.is_number()) {
    row.bind(value.get<double>());
  } else {
    row.bind(value.is_string() ? value.get<std::string>() : value.dump());
  }
}

void bind(Statement& row, const PeakSensitivity& by) {
  row.bind(by.preload).bind(by.friction).bind(by.force).bind(by.mass_ratio).bind(by.frequency_ratio);
}

void bind_nothing(Statement& row, int count) {
  for (int i = 0; i < count; ++i) row.bind_null();
}

/// In the order of the columns.
void bind(Statement& row, const Optimum& optimum, double free_Y) {
  const Peak& peak = optimum.peak;
  row.bind(peak.preload).bind(peak.eta).bind(peak.Y).bind(peak.Y / free_Y).bind(to_string(optimum.kind));
  row.bind(optimum.low).bind(optimum.high).bind(free_Y).bind(peak.R_over_S).bind(peak.dissipated);
  row.bind(optimum.energy).bind(optimum.damping).bind(to_string(peak.site));
  bind(row, peak.sensitivity);
  if (optimum.other) {
    row.bind(optimum.other->eta);
    bind(row, optimum.other->sensitivity);
  } else {
    bind_nothing(row, 6);
  }
}

void bind_failed(Statement& row, double free_Y) {
  bind_nothing(row, 4);
  row.bind("failed");
  bind_nothing(row, 2);
  free_Y > 0 ? row.bind(free_Y) : row.bind_null();
  bind_nothing(row, static_cast<int>(optimum_columns.size()) - 8);
}

}  // namespace

StudyStore::StudyStore(const std::string& folder, const StudyCase& study, bool resume)
    : folder_(folder),
      path_(folder + "/study.sqlite"),
      keys_(study.keys),
      count_(study.items()),
      each_(study.each()),
      sweep_(study.sweep || study.patterns > 0),
      extras_(study) {
  if (resume && is_there(path_)) {
    check_same(study);
  } else {
    begin(study);
  }
  open();
}

StudyStore::~StudyStore() {
  try {
    end_batch();
  } catch (const OutputError&) {
    // What is not stored is computed again.
  }
}

void StudyStore::begin(const StudyCase& study) {
  const std::string temporary = fmt::format("{}.{}.tmp", path_, getpid());
  // SQLite tries to read what it cannot write, and tells why that fails.
  std::FILE* const file = std::fopen(temporary.c_str(), "wb");
  if (file == nullptr)
    throw OutputError(
        fmt::format("{}: cannot be written: {}", path_, std::generic_category().message(errno)));
  std::fclose(file);
  try {
    {
      Database database(temporary);
      create(database, study);
    }
    try {
      settle(path_);
    } catch (const NoDatabase&) {
      // It is to be replaced, whatever it was.
    }
  } catch (...) {
    remove(temporary);
    throw;
  }
  for (const char* side : {"-wal", "-shm", "-journal"}) remove(path_ + side);
  std::error_code error;
  std::filesystem::rename(temporary, path_, error);
  if (error) {
    remove(temporary);
    throw OutputError(fmt::format("{}: cannot be written: {}", path_, error.message()));
  }
  // What the former study gave is no longer what the folder holds.
  forget_study(folder_);
  for (const char* name : {"optimum.csv", "sweep.csv", "robust.csv", "quantiles.csv", "patterns.csv"})
    remove(folder_ + "/" + name);
}

void StudyStore::check_same(const StudyCase& study) const {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: --resume: {}; without --resume it is begun anew", path_, why));
  };
  try {
    settle(path_);
    const Database database(path_);
    Statement row = database.prepare("SELECT version, input FROM study");
    if (!row.step()) refuse("it holds no study");
    const std::string version = row.text(0);
    const bool is_version = version.find_first_not_of("0123456789.") == std::string::npos;
    if (is_version && version != release)
      refuse(fmt::format("it was begun by arcslip {}, this is {}", version, release));
    if (!is_version || !has_whole_input(database)) refuse("its input is damaged");
    const std::string other = difference(ordered_json::parse(row.text(1)), study);
    if (!other.empty()) refuse(fmt::format("it was begun with another {}", other));
    Database model;
    create(model, study);
    const std::string wrong = damage(database, model, static_cast<std::int64_t>(study.items()));
    if (!wrong.empty()) refuse(wrong);
  } catch (const NoDatabase&) {
    refuse("it holds no study");
  }
}

void StudyStore::open() {
  database_.emplace(path_);
  database_->execute(
      "PRAGMA busy_timeout = 1000; PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL; INSERT INTO runs "
      "DEFAULT VALUES");
  Statement last = database_->prepare("SELECT max(run) FROM runs");
  last.step();
  run_ = last.integer(0);
  const std::size_t columns = 1 + keys_.size() + optimum_columns.size() + 4;
  insert_design_ = database_->prepare(fmt::format("INSERT INTO designs VALUES ({})", placeholders(columns)));
  insert_peak_ =
      database_->prepare(fmt::format("INSERT INTO sweep VALUES ({})", placeholders(peak_columns.size())));
  extras_.open(*database_);
  checksums_.emplace(*database_);
}

std::vector<bool> StudyStore::finished() const {
  std::vector<bool> finished(count_);
  for (Statement row = database_->prepare("SELECT curve FROM designs"); row.step();)
    finished.at(static_cast<std::size_t>(row.integer(0))) = true;
  return finished;
}

void StudyStore::add(std::size_t curve, const ordered_json& values, const problems::PreloadStudy& result,
                     const problems::UncertainPeaks* uncertain) {
  if (!batch_begun_) {
    database_->execute("BEGIN IMMEDIATE");
    batch_begun_ = Clock::now();
  }
  database_->execute("SAVEPOINT design");
  try {
    insert(curve, values, result, uncertain);
  } catch (...) {
    abandon_design();
    throw;
  }
  database_->execute("RELEASE design");
}

/// Where the database has not given up the whole transaction by itself.
void StudyStore::abandon_design() {
  try {
    database_->execute("ROLLBACK TO design; RELEASE design");
  } catch (const OutputError&) {
    batch_begun_.reset();
  }
}

void StudyStore::insert(std::size_t curve, const ordered_json& values, const problems::PreloadStudy& result,
                        const problems::UncertainPeaks* uncertain) {
  Statement& row = *insert_design_;
  row.bind(static_cast<std::int64_t>(curve));
  for (const std::string& key : keys_) bind(row, values.at(key));
  const bool failed = !result.failure.empty() || !result.optimum;
  if (failed) {
    bind_failed(row, result.free_Y);
  } else {
    bind(row, *result.optimum, result.free_Y);
  }
  std::string failure = result.failure;
  if (failed && failure.empty()) failure = "there is no peak in the window";
  if (!failed && uncertain != nullptr) failure = uncertain->failure;
  row.bind(failure).bind(result.free_eta).bind(run_).bind_null().run();
  if (sweep_) add_sweep(curve, result);
  extras_.add(curve, result, failed ? nullptr : uncertain);
  checksums_->store(static_cast<std::int64_t>(curve));
}

void StudyStore::keep() {
  constexpr std::chrono::milliseconds moment(5);
  if (batch_begun_ && Clock::now() - *batch_begun_ >= moment) end_batch();
}

void StudyStore::end_batch() {
  if (!batch_begun_) return;
  batch_begun_.reset();
  database_->execute("COMMIT");
}

void StudyStore::add_sweep(std::size_t curve, const problems::PreloadStudy& result) {
  for (std::size_t branch = 0; branch < result.branches.size(); ++branch) {
    std::int64_t point = 0;
    for (const Peak& peak : result.branches[branch]) {
      Statement& row = *insert_peak_;
      row.bind(static_cast<std::int64_t>(curve)).bind(static_cast<std::int64_t>(branch)).bind(point++);
      row.bind(peak.preload).bind(peak.eta).bind(peak.Y).bind(peak.R_over_S).bind(peak.dissipated);
      row.bind(static_cast<std::int64_t>(peak.is_global)).bind(to_string(peak.type));
      row.bind(to_string(peak.site));
      bind(row, peak.sensitivity);
      row.run();
    }
  }
}

void StudyStore::visit(Which which, const std::function<bool(const StoredDesign&)>& visitor) const {
  const bool robust = extras_.has_robust();
  Statement row = database_->prepare(fmt::format(
      "SELECT d.curve, d.kind, d.failure, d.P_opt, d.eta_opt, d.Y_opt, d.ratio_opt, d.free_eta, {}, "
      "{} FROM designs d {} {} {} ORDER BY d.curve",
      robust ? "r.P, r.Y/d.Y_nd_max" : "NULL, NULL", extras_.has_harmonics() ? "h.orders" : "''",
      extras_.has_harmonics() ? "LEFT JOIN harmonics h ON h.curve = d.curve" : "",
      robust ? "LEFT JOIN robust r ON r.curve = d.curve" : "",
      which == Which::failed ? "WHERE d.failure <> ''" : of_equal_rings(each_)));
  while (row.step()) {
    const auto item = static_cast<std::size_t>(row.integer(0));
    if (!visitor({item / each_, item, row.text(1), row.text(2), row.real(3), row.real(4), row.real(5),
                  row.real(6), row.real(7), row.real(8), row.real(9), row.text(10)}))
      return;
  }
}

void StudyStore::tidy() {
  end_batch();
  insert_design_.reset();
  insert_peak_.reset();
  extras_.close();
  checksums_.reset();
  try {
    database_->execute("PRAGMA journal_mode = DELETE");
  } catch (const DatabaseInUse&) {
    // Whoever reads it at this moment leaves the file as it is, which is complete as well.
  }
}

}  // namespace arcslip
