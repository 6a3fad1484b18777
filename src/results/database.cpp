#include "results/database.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <system_error>

namespace arcslip {
namespace {

[[noreturn]] void fail(sqlite3* connection, const std::string& path) {
  const int code = connection != nullptr ? sqlite3_errcode(connection) : SQLITE_NOMEM;
  if (code == SQLITE_BUSY || code == SQLITE_LOCKED)
    throw DatabaseInUse(fmt::format("{}: cannot be written: another program uses it", path));
  const std::string what = connection != nullptr ? sqlite3_errmsg(connection) : sqlite3_errstr(code);
  if (code == SQLITE_NOTADB || code == SQLITE_CORRUPT || code == SQLITE_ERROR)
    throw NoDatabase(fmt::format("{}: is not a database of a study: {}", path, what));
  const int reason = connection != nullptr ? sqlite3_system_errno(connection) : 0;
  throw OutputError(fmt::format("{}: cannot be written: {}{}", path, what,
                                reason == 0 ? "" : ": " + std::generic_category().message(reason)));
}

}  // namespace

Statement::Statement(sqlite3* connection, std::string path, std::string_view sql)
    : connection_(connection), path_(std::move(path)), statement_(nullptr, &sqlite3_finalize) {
  sqlite3_stmt* statement = nullptr;
  check(sqlite3_prepare_v2(connection, sql.data(), static_cast<int>(sql.size()), &statement, nullptr));
  statement_.reset(statement);
}

void Statement::check(int code) const {
  if (code != SQLITE_OK) fail(connection_, path_);
}

Statement& Statement::bind(double value) {
  check(sqlite3_bind_double(statement_.get(), ++bound_, value));
  return *this;
}

Statement& Statement::bind(std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), ++bound_, value));
  return *this;
}

Statement& Statement::bind(std::string_view value) {
  check(sqlite3_bind_text64(statement_.get(), ++bound_, value.data(), value.size(), SQLITE_TRANSIENT,
                            SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind_null() {
  check(sqlite3_bind_null(statement_.get(), ++bound_));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  bound_ = 0;
  if (code != SQLITE_DONE) fail(connection_, path_);
  check(sqlite3_reset(statement_.get()));
  return false;
}

void Statement::run() {
  while (step()) {
  }
}

int Statement::columns() const { return sqlite3_column_count(statement_.get()); }

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

double Statement::real(int column) const {
  if (sqlite3_column_type(statement_.get(), column) == SQLITE_NULL)
    return std::numeric_limits<double>::quiet_NaN();
  return sqlite3_column_double(statement_.get(), column);
}

std::string Statement::text(int column) const {
  const auto* characters = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return characters == nullptr ? "" : std::string(characters, static_cast<std::size_t>(size));
}

void Statement::write_csv(int column, std::string& row) const {
  const auto out = std::back_inserter(row);
  switch (sqlite3_column_type(statement_.get(), column)) {
    case SQLITE_INTEGER: fmt::format_to(out, "{}", integer(column)); return;
    case SQLITE_FLOAT: fmt::format_to(out, "{:.17g}", real(column)); return;
    case SQLITE_NULL: row += "nan"; return;
    default: break;
  }
  append_csv(text(column), row);
}

void append_csv(const std::string& value, std::string& row) {
  if (value.find_first_of(",\"\n") == std::string::npos) {
    row += value;
    return;
  }
  row += '"';
  for (const char character : value) row.append(character == '"' ? 2 : 1, character);
  row += '"';
}

void Statement::write_bits(int column, std::string& row) const {
  const auto append = [&](char type, const auto& bits) {
    row += type;
    row.append(bits.begin(), bits.end());
  };
  switch (sqlite3_column_type(statement_.get(), column)) {
    case SQLITE_INTEGER: append('i', std::bit_cast<std::array<char, 8>>(integer(column))); return;
    case SQLITE_FLOAT: append('r', std::bit_cast<std::array<char, 8>>(real(column))); return;
    case SQLITE_NULL: row += 'n'; return;
    case SQLITE_BLOB: row += 'b'; break;
    default: row += 't'; break;
  }
  const std::string value = text(column);
  append('s', std::bit_cast<std::array<char, 8>>(static_cast<std::int64_t>(value.size())));
  row += value;
}

// Statements may outlive the connection, which is then closed with the last of them.
Database::Database(const std::string& path, const std::string& name)
    : path_(path), connection_(nullptr, &sqlite3_close_v2) {
  sqlite3* connection = nullptr;
  const int code = sqlite3_open(name.c_str(), &connection);
  connection_.reset(connection);
  if (code != SQLITE_OK) fail(connection, path);
}

// With a folder before it, no path is taken for anything else.
Database::Database(const std::string& path) : Database(path, path.starts_with('/') ? path : "./" + path) {}

Database::Database() : Database("a database in memory", ":memory:") {}

void Database::execute(const std::string& sql) {
  if (sqlite3_exec(connection_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    fail(connection_.get(), path_);
}

Statement Database::prepare(std::string_view sql) const { return {connection_.get(), path_, sql}; }

}  // namespace arcslip
