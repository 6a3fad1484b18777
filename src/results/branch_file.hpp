#pragma once

// A table of branches on the disk, to which branches are added as they come.

#include <memory>

#include "arcslip/results/results.hpp"
#include "results/atomic_file.hpp"

namespace arcslip {

class BranchFile {
 public:
  /// Throws OutputError, as all that follows.
  BranchFile(const std::string& path, BranchTable::Detail detail);

  /// What is to be added of the next branch.
  struct Rows {
    BranchTable table;
    std::string text;
    std::size_t count = 0;
  };
  Rows rows(std::size_t number, const TracedBranch& traced) const;

  void add(Rows rows);

  /// Adds the rows of the first so many branches from the file that stands there, whose table had the columns
  /// of `header` when it had no others; gives their number. Throws OutputError where they are not there.
  std::size_t take_over(std::size_t branches, const std::string& header);

  std::string header() const { return table_.header(); }

  /// Gives all rows the same columns and brings them to the disk.
  void finish();
  void commit() { file_->commit(); }

 private:
  void widen_rows();

  BranchTable::Detail detail_;
  BranchTable table_;
  std::vector<std::pair<std::size_t, BranchTable>> widths_;  ///< from which row on rows have which columns
  std::size_t rows_ = 0;
  std::unique_ptr<AtomicFile> file_;
};

}  // namespace arcslip
