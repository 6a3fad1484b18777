#include "results/study_checksum.hpp"

#include <fmt/format.h>

namespace arcslip {
namespace {

/// All rows of a query, which is bound and at its start, bit by bit.
std::string bits_of(Statement& query) {
  std::string bits;
  while (query.step()) {
    for (int i = 0; i < query.columns(); ++i) query.write_bits(i, bits);
    bits += '\n';
  }
  return bits;
}

std::string bits_of(const Database& database, const char* sql) {
  Statement query = database.prepare(sql);
  return bits_of(query);
}

/// The first column of a query's rows.
std::vector<std::string> texts_of(const Database& database, const std::string& sql) {
  std::vector<std::string> texts;
  for (Statement row = database.prepare(sql); row.step();) texts.push_back(row.text(0));
  return texts;
}

/// Indexes apart, which change no result.
constexpr const char* schema =
    "SELECT type, name, sql FROM sqlite_master WHERE type <> 'index' ORDER BY name, type";

std::vector<std::string> tables_of_designs(const Database& database) {
  return texts_of(database,
                  "SELECT name FROM sqlite_master WHERE type = 'table' AND name NOT IN ('study', 'runs') "
                  "ORDER BY name");
}

std::string damage_of_designs(const Database& database, std::int64_t count) {
  DesignChecksums sums(database);
  for (Statement row = database.prepare("SELECT curve, checksum FROM designs"); row.step();) {
    const std::int64_t curve = row.integer(0);
    if (curve < 0 || curve >= count) return fmt::format("it has a design {} of {}", curve, count);
    if (row.integer(1) != sums.of(curve)) return fmt::format("design {} is damaged", curve);
  }
  for (const std::string& table : tables_of_designs(database)) {
    Statement stray = database.prepare(fmt::format(
        "SELECT 1 FROM {} WHERE curve NOT IN (SELECT curve FROM designs) OR curve IS NULL", table));
    if (stray.step()) return fmt::format("{} has rows of no design", table);
  }
  return "";
}

}  // namespace

std::int64_t checksum(const std::string& bits) {
  std::uint64_t hash = 14695981039346656037U;
  for (const char bit : bits) hash = (hash ^ static_cast<unsigned char>(bit)) * 1099511628211U;
  return static_cast<std::int64_t>(hash);
}

std::int64_t input_checksum(const Database& database) {
  return checksum(bits_of(database, "SELECT version, input, designs FROM study"));
}

bool has_whole_input(const Database& database) {
  Statement row = database.prepare("SELECT checksum FROM study");
  return row.step() && row.integer(0) == input_checksum(database);
}

DesignChecksums::DesignChecksums(const Database& database)
    : update_(database.prepare("UPDATE designs SET checksum = ? WHERE curve = ?")) {
  for (const std::string& table : tables_of_designs(database)) {
    std::string columns;  // but for the checksum itself
    for (const std::string& column :
         texts_of(database,
                  fmt::format("SELECT name FROM pragma_table_info('{}') WHERE name <> 'checksum'", table)))
      columns += fmt::format("{}\"{}\"", columns.empty() ? "" : ", ", column);
    rows_.push_back(
        database.prepare(fmt::format("SELECT {} FROM {} WHERE curve = ? ORDER BY 1, 2, 3", columns, table)));
  }
}

std::int64_t DesignChecksums::of(std::int64_t curve) {
  std::string bits;
  for (Statement& rows : rows_) bits += bits_of(rows.bind(curve)) + ';';
  return checksum(bits);
}

void DesignChecksums::store(std::int64_t curve) {
  const std::int64_t sum = of(curve);
  update_.bind(sum).bind(curve).run();
}

std::string damage(const Database& database, const Database& model, std::int64_t count) {
  try {
    if (bits_of(database, schema) != bits_of(model, schema)) return "its tables are others";
    if (texts_of(database, "PRAGMA integrity_check") != std::vector<std::string>{"ok"})
      return "its pages do not hold together";
    return damage_of_designs(database, count);
  } catch (const NoDatabase&) {
    return "it cannot be read";
  }
}

}  // namespace arcslip
