#pragma once

// Checksums of what a study has stored, by which damage is told from results: one of its input, in `study`,
// and one of each design, in `designs`, over the rows that all tables have of it.

#include <cstdint>
#include <string>
#include <vector>

#include "results/database.hpp"

namespace arcslip {

/// 64 bits that change with every bit of the text: Fowler, Noll & Vo's hash 1a.
std::int64_t checksum(const std::string& bits);

/// Of `study`: version, input and number of designs.
std::int64_t input_checksum(const Database& database);
/// Whether it is as it was stored.
bool has_whole_input(const Database& database);

/// Of one design after the other, in all tables but `study` and `runs`.
class DesignChecksums {
 public:
  explicit DesignChecksums(const Database& database);

  std::int64_t of(std::int64_t curve);
  /// Writes it into the row of the design.
  void store(std::int64_t curve);

 private:
  std::vector<Statement> rows_;
  Statement update_;
};

/// What is wrong with a database, which should have the tables of `model` and designs 0 to `count` - 1, in
/// half a sentence; empty where its pages hold together and each design is as it was stored.
std::string damage(const Database& database, const Database& model, std::int64_t count);

}  // namespace arcslip
