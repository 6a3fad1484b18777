#include "results/branch_file.hpp"

#include <cstdlib>
#include <fstream>
#include <utility>

#include "results/output.hpp"

namespace arcslip {

BranchFile::BranchFile(const std::string& path, BranchTable::Detail detail)
    : detail_(detail), file_(std::make_unique<AtomicFile>(path)) {}

BranchFile::Rows BranchFile::rows(std::size_t number, const TracedBranch& traced) const {
  Rows rows{table_, "", traced.branch.points.size()};
  rows.table.widen(traced);
  rows.text = rows.table.rows(number, traced, detail_);
  return rows;
}

void BranchFile::add(Rows rows) {
  if (widths_.empty()) file_->write(rows.table.header());
  if (widths_.empty() || rows.table != table_) widths_.emplace_back(rows_, rows.table);
  file_->write(rows.text);
  rows_ += rows.count;
  table_ = std::move(rows.table);
}

std::size_t BranchFile::take_over(std::size_t branches, const std::string& header) {
  std::ifstream before(file_->path(), std::ios::binary);
  std::string line;
  std::getline(before, line);
  try {
    const BranchTable wide(line);
    table_ = BranchTable(header);
    widths_.emplace_back(0, table_);
    file_->write(table_.header());
    while (std::getline(before, line) && std::strtoul(line.c_str(), nullptr, 10) < branches) {
      file_->write(wide.narrowed(line, table_) + "\n");
      ++rows_;
    }
  } catch (const std::invalid_argument&) {
    throw OutputError(file_->path() + ": the rows of the interrupted run are not there any more");
  }
  return rows_;
}

/// Branches with more harmonics have more columns: the rows before them get these as well.
void BranchFile::widen_rows() {
  if (widths_.size() < 2) return;
  auto wide = std::make_unique<AtomicFile>(file_->path());
  wide->write(table_.header());
  std::size_t row = 0;
  bool is_header = true;
  auto width = widths_.begin();
  file_->for_each_line([&](std::string_view line) {
    if (std::exchange(is_header, false)) return;
    while (std::next(width) != widths_.end() && std::next(width)->first <= row) ++width;
    wide->write(table_.widened(line, width->second) + "\n");
    ++row;
  });
  file_ = std::move(wide);
}

void BranchFile::finish() {
  if (widths_.empty()) file_->write(table_.header());
  widen_rows();
  file_->sync();
}

}  // namespace arcslip
