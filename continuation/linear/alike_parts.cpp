#include "alike_parts.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "arcslip/continuation/linear/front_plan.hpp"

namespace arcslip::continuation {
namespace {

constexpr std::size_t least_blocks = 8;
constexpr std::size_t most_rows = 32;  // of one: more are fronts of their own

std::size_t slot(int i) { return static_cast<std::size_t>(i); }

/// Groups of rows with the same columns, all of them `outer`, but those that stay.
std::vector<AlikeBlock> rows_by_columns(const SparseMatrix& pattern, Index borders,
                                        std::vector<int>& staying) {
  std::vector<std::vector<int>> columns(static_cast<std::size_t>(pattern.rows()));
  for (int j = 0; j < pattern.cols(); ++j) {
    for (SparseMatrix::InnerIterator entry(pattern, j); entry; ++entry)
      columns[static_cast<std::size_t>(entry.row())].push_back(j);
  }
  const Index most = most_of_a_row(pattern);
  std::map<std::vector<int>, std::vector<int>> rows;
  for (int i = 0; i < pattern.rows(); ++i) {
    const bool stays = i >= pattern.rows() - borders || std::ssize(columns[slot(i)]) > most;
    (stays ? staying : rows[columns[slot(i)]]).push_back(i);
  }
  std::vector<AlikeBlock> groups;
  for (auto& [outer, own] : rows) groups.push_back({std::move(own), {}, outer});
  return groups;
}

/// Makes one of each two groups in a row that no others share a column with.
std::vector<AlikeBlock> in_pairs(const std::vector<AlikeBlock>& groups, std::vector<int>& uses) {
  std::vector<AlikeBlock> all;
  for (std::size_t k = 0; k < groups.size(); ++k) {
    all.push_back(groups[k]);
    if (k + 1 == groups.size()) break;
    AlikeBlock& one = all.back();
    const AlikeBlock& next = groups[k + 1];
    std::vector<int> common;
    std::set_intersection(one.outer.begin(), one.outer.end(), next.outer.begin(), next.outer.end(),
                          std::back_inserter(common));
    const auto is_theirs = [&](int column) { return uses[slot(column)] == 2; };
    if (std::none_of(common.begin(), common.end(), is_theirs)) continue;
    for (const int column : common) --uses[slot(column)];
    one.rows.insert(one.rows.end(), next.rows.begin(), next.rows.end());
    one.outer.clear();
    std::set_union(groups[k].outer.begin(), groups[k].outer.end(), next.outer.begin(), next.outer.end(),
                   std::back_inserter(one.outer));
    ++k;
  }
  return all;
}

}  // namespace

AlikeParts find_alike_parts(const SparseMatrix& pattern, Index borders, bool pairs) {
  AlikeParts parts;
  std::vector<AlikeBlock> groups = rows_by_columns(pattern, borders, parts.staying);
  std::vector<int> uses(static_cast<std::size_t>(pattern.cols()), 0);
  for (const AlikeBlock& group : groups) {
    for (const int column : group.outer) ++uses[slot(column)];
  }
  if (pairs) groups = in_pairs(groups, uses);
  using Size = std::vector<std::size_t>;
  std::map<Size, std::vector<AlikeBlock>> by_size;
  for (const AlikeBlock& group : groups) {
    AlikeBlock block{group.rows, {}, {}};
    for (const int column : group.outer)
      (uses[slot(column)] == 1 ? block.inner : block.outer).push_back(column);
    const bool follow = block.rows.back() - block.rows.front() + 1 == std::ssize(block.rows);
    const bool serves = follow && !block.inner.empty() && block.inner.size() < block.rows.size() &&
                        block.rows.size() <= most_rows;
    if (serves) by_size[{block.rows.size(), block.inner.size(), block.outer.size()}].push_back(block);
  }
  for (auto& [size, blocks] : by_size) {
    if (blocks.size() >= least_blocks && blocks.size() > parts.blocks.size())
      parts.blocks = std::move(blocks);
  }
  std::vector<char> is_row_left(static_cast<std::size_t>(pattern.rows()), 1);
  std::vector<char> is_column_left(static_cast<std::size_t>(pattern.cols()), 1);
  for (const int row : parts.staying) is_row_left[slot(row)] = 0;
  for (const AlikeBlock& block : parts.blocks) {
    for (const int row : block.rows) is_row_left[slot(row)] = 0;
    for (const int column : block.inner) is_column_left[slot(column)] = 0;
  }
  for (int i = 0; i < pattern.rows(); ++i) {
    if (is_row_left[slot(i)] != 0) parts.others.push_back(i);
    if (is_column_left[slot(i)] != 0) parts.columns.push_back(i);
  }
  return parts;
}

SparseMatrix with_full_blocks(const SparseMatrix& pattern, const std::vector<AlikeBlock>& blocks) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < pattern.cols(); ++j) {
    for (SparseMatrix::InnerIterator entry(pattern, j); entry; ++entry)
      entries.emplace_back(static_cast<int>(entry.row()), j, 0);
  }
  for (const AlikeBlock& block : blocks) {
    for (const int row : block.rows) {
      for (const int column : block.inner) entries.emplace_back(row, column, 0);
      for (const int column : block.outer) entries.emplace_back(row, column, 0);
    }
  }
  SparseMatrix full(pattern.rows(), pattern.cols());
  full.setFromTriplets(entries.begin(), entries.end());
  return full;
}

}  // namespace arcslip::continuation
