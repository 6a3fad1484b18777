#pragma once

// SQLite: one connection and its statements. Errors are OutputErrors that name the file.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

#include "results/output.hpp"

namespace arcslip {

/// Another connection keeps the database from being changed.
class DatabaseInUse : public OutputError {
 public:
  using OutputError::OutputError;
};

/// The file holds no database, or one without the tables asked for.
class NoDatabase : public OutputError {
 public:
  using OutputError::OutputError;
};

/// A prepared statement: parameters are bound from the left, columns read by number.
class Statement {
 public:
  /// The next parameter; nan is stored as NULL.
  Statement& bind(double value);
  Statement& bind(std::int64_t value);
  Statement& bind(std::string_view value);
  Statement& bind_null();

  /// Goes to the next row; false, and ready to be bound anew, where there is none.
  bool step();
  /// For statements without rows.
  void run();

  int columns() const;
  std::int64_t integer(int column) const;
  double real(int column) const;  ///< NULL is nan
  std::string text(int column) const;
  /// Appends the value as it stands in a CSV file: numbers with 17 significant digits, NULL as nan.
  void write_csv(int column, std::string& row) const;
  /// Appends the value's type and its bits, of which no two values have the same.
  void write_bits(int column, std::string& row) const;

 private:
  friend class Database;
  Statement(sqlite3* connection, std::string path, std::string_view sql);
  void check(int code) const;

  sqlite3* connection_;
  std::string path_;
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement_;
  int bound_ = 0;
};

class Database {
 public:
  /// Opens the file, or makes it where there is none.
  explicit Database(const std::string& path);
  /// One in memory.
  Database();

  void execute(const std::string& sql);
  Statement prepare(std::string_view sql) const;
  const std::string& path() const { return path_; }

 private:
  Database(const std::string& path, const std::string& name);

  std::string path_;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> connection_;
};

/// Appends a text as it stands in a CSV file, in quotes where it needs them.
void append_csv(const std::string& value, std::string& row);

}  // namespace arcslip
