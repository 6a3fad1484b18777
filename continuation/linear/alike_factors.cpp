#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "alike_parts.hpp"
#include "arcslip/continuation/linear/blocks_side_by_side.hpp"
#include "arcslip/continuation/linear/bordered_solver.hpp"
#include "arcslip/continuation/linear/front_plan.hpp"
#include "arcslip/continuation/linear/sparse_factors.hpp"

namespace arcslip::continuation {
namespace {

constexpr Index lanes = BlocksSideBySide::lanes;

/// The largest size of these entries.
double largest_of(const double* values, const std::vector<int>& entries) {
  double largest = 0;
  for (const int entry : entries) largest = std::max(largest, std::abs(values[entry]));
  return largest;
}

/// Where an entry is among the values; -1 where the pattern lacks it.
int place_in(const SparseMatrix& pattern, Index row, Index column) {
  const int* const rows = pattern.innerIndexPtr();
  const int* const end = rows + pattern.outerIndexPtr()[column + 1];
  const int* const found =
      std::lower_bound(rows + pattern.outerIndexPtr()[column], end, static_cast<int>(row));
  return found != end && *found == row ? static_cast<int>(found - rows) : -1;
}

/// Where numbers below `size` are in a list of such; -1 where it lacks them.
Eigen::VectorX<int> places_of(const Eigen::VectorX<int>& list, Index size) {
  Eigen::VectorX<int> places = Eigen::VectorX<int>::Constant(size, -1);
  for (Index k = 0; k < list.size(); ++k) places(list(k)) = static_cast<int>(k);
  return places;
}

/// The same numbers of all blocks, those of `lanes` side by side: of the last one again where there are
/// fewer.
class Table {
 public:
  Table(Index blocks, Index count) : entries_(count * lanes, (blocks + lanes - 1) / lanes) {}

  void set(Index block, Index k, int value) {
    for (Index lane = block % lanes; lane < lanes; ++lane) entries_(k * lanes + lane, block / lanes) = value;
  }
  auto of(Index batch) const { return entries_.col(batch); }

 private:
  Eigen::MatrixX<int> entries_;
};

/// As many entries from each of these places on.
inline void put_side_by_side(const double* values, const int* firsts, Index count, double* __restrict out) {
  for (Index l = 0; l < lanes; ++l) {
    const double* const from = values + firsts[l];
    for (Index i = 0; i < count; ++i) out[i * lanes + l] = from[i];
  }
}

class AlikeFactors final : public SparseFactors {
 public:
  AlikeFactors(const SparseMatrix& pattern, const AlikeParts& parts)
      : blocks_(std::ssize(parts.blocks)),
        pivots_(std::ssize(parts.blocks.front().inner)),
        left_rows_(std::ssize(parts.blocks.front().rows) - pivots_),
        outer_(std::ssize(parts.blocks.front().outer)),
        staying_(std::ssize(parts.staying)),
        height_(pivots_ + left_rows_ + staying_),
        first_rows_(blocks_, 1),
        inner_columns_(blocks_, pivots_),
        outer_columns_(blocks_, outer_),
        sources_(blocks_, pivots_ + outer_),
        staying_sources_(blocks_, staying_ * pivots_),
        targets_(blocks_, outer_),
        staying_targets_(blocks_, staying_ * outer_),
        batches_(static_cast<std::size_t>((blocks_ + lanes - 1) / lanes),
                 BlocksSideBySide(height_, pivots_ + outer_, pivots_, staying_)),
        row_scales_((height_ - staying_) * lanes, std::ssize(batches_)),
        vectors_(height_ * lanes, std::ssize(batches_)),
        left_{batches_, blocks_, left_rows_, pivots_, Eigen::MatrixX<int>(outer_, blocks_)},
        behind_(outer_ * lanes),
        rest_vector_(std::ssize(parts.columns)) {
    set_orders(parts);
    build_rest(pattern, parts);
    make_rest_factors();
    find_kept(pattern);
    fill_tables(pattern, parts);
  }

  bool is_made() const { return rest_factors_ != nullptr; }

  double factor(const SparseMatrix& matrix) override {
    const double* const values = matrix.valuePtr();
    double* const rest = rest_.valuePtr();
    rest_.coeffs().setZero();
    for (const auto& [from, to] : kept_) rest[to] = values[from];
    double sign = orders_sign_;
    const double staying = staying_ > 0 ? largest_of(values, staying_entries_) : 1;
    growth_ = 0;
    for (Index b = 0; b < std::ssize(batches_); ++b) {
      BlocksSideBySide& batch = batches_[static_cast<std::size_t>(b)];
      take(values, batch, b);
      if (!batch.scale_rows(row_scales_.col(b).data())) return 0;
      batch.eliminate();
      growth_ = std::max({growth_, batch.largest(), batch.largest_multiple() / staying});
      for (Index lane = 0; lane < lanes_of(b); ++lane) sign *= batch.sign(lane);
      leave(batch, b);
    }
    return sign * rest_factors_->factor(rest_);
  }

  void multiply_determinant(LogProduct& product) const override {
    for (Index b = 0; b < std::ssize(batches_); ++b) {
      for (Index k = 0; k < pivots_; ++k) {
        const double* const pivots = batches_[static_cast<std::size_t>(b)].at(k, k);
        for (Index lane = 0; lane < lanes_of(b); ++lane) product *= pivots[lane];
      }
      const double* scale = row_scales_.col(b).data();
      for (Index i = 0; i < pivots_ + left_rows_; ++i, scale += lanes) {
        for (Index lane = 0; lane < lanes_of(b); ++lane) product /= scale[lane];
      }
    }
    rest_factors_->multiply_determinant(product);
  }

  double growth() const override { return std::max(growth_, rest_factors_->growth()); }

  const RowsLeft* rows_left() const override { return &left_; }

  void solve(Vector& x) override {
    for (Index i = 0; i < other_rows_.size(); ++i) rest_vector_(i) = x(other_rows_(i));
    auto staying = rest_vector_.tail(staying_);
    for (Index i = 0; i < staying_; ++i) staying(i) = x(staying_rows_(i));
    for (Index b = 0; b < std::ssize(batches_); ++b) {
      auto y = vectors_.col(b);
      put_side_by_side(x.data(), first_rows_.of(b).data(), height_ - staying_, y.data());
      y.head(row_scales_.rows()).array() *= row_scales_.col(b).array();
      y.tail(staying_ * lanes).setZero();
      batches_[static_cast<std::size_t>(b)].forward(y.data());
      for (Index lane = 0; lane < lanes_of(b); ++lane) {
        for (Index i = 0; i < left_rows_; ++i)
          rest_vector_(first_left(b * lanes + lane) + i) = y((pivots_ + i) * lanes + lane);
        for (Index i = 0; i < staying_; ++i) staying(i) += y((pivots_ + left_rows_ + i) * lanes + lane);
      }
    }
    rest_factors_->solve(rest_vector_);
    for (Index i = 0; i < columns_.size(); ++i) x(columns_(i)) = rest_vector_(i);
    for (Index b = 0; b < std::ssize(batches_); ++b) {
      auto y = vectors_.col(b);
      const auto outer = outer_columns_.of(b);
      for (Index k = 0; k < outer.size(); ++k) behind_(k) = rest_vector_(outer(k));
      batches_[static_cast<std::size_t>(b)].back(y.data(), behind_.data());
      const auto inner = inner_columns_.of(b);
      for (Index k = 0; k < inner.size(); ++k) x(inner(k)) = y(k);
    }
  }

  void solve_transposed(Vector& x) override {
    for (Index i = 0; i < columns_.size(); ++i) rest_vector_(i) = x(columns_(i));
    for (Index b = 0; b < std::ssize(batches_); ++b) {
      auto y = vectors_.col(b);
      const auto inner = inner_columns_.of(b);
      for (Index k = 0; k < inner.size(); ++k) y(k) = x(inner(k));
      behind_.setZero();
      batches_[static_cast<std::size_t>(b)].forward_transposed(y.data(), behind_.data());
      const auto outer = outer_columns_.of(b);
      for (Index k = 0; k < outer_; ++k) {
        for (Index lane = 0; lane < lanes_of(b); ++lane)
          rest_vector_(outer(k * lanes + lane)) += behind_(k * lanes + lane);
      }
    }
    rest_factors_->solve_transposed(rest_vector_);
    for (Index i = 0; i < other_rows_.size(); ++i) x(other_rows_(i)) = rest_vector_(i);
    const auto staying = rest_vector_.tail(staying_);
    for (Index i = 0; i < staying_; ++i) x(staying_rows_(i)) = staying(i);
    for (Index b = 0; b < std::ssize(batches_); ++b) {
      auto y = vectors_.col(b);
      for (Index lane = 0; lane < lanes; ++lane) {
        const Index first = first_left(std::min(b * lanes + lane, blocks_ - 1));
        for (Index i = 0; i < left_rows_; ++i) y((pivots_ + i) * lanes + lane) = rest_vector_(first + i);
        for (Index i = 0; i < staying_; ++i) y((pivots_ + left_rows_ + i) * lanes + lane) = staying(i);
      }
      batches_[static_cast<std::size_t>(b)].back_transposed(y.data());
      y.head(row_scales_.rows()).array() *= row_scales_.col(b).array();
      for (Index lane = 0; lane < lanes; ++lane) {
        const int first = first_rows_.of(b)(lane);
        for (Index i = 0; i < height_ - staying_; ++i) x(first + i) = y(i * lanes + lane);
      }
    }
  }

 private:
  Index lanes_of(Index batch) const { return std::min(lanes, blocks_ - batch * lanes); }
  /// Of the rows that are left of a block, among the rest's: behind the others, before those that stay.
  Index first_left(Index block) const { return other_rows_.size() + block * left_rows_; }

  void set_orders(const AlikeParts& parts) {
    const auto copy = [](const std::vector<int>& from) {
      return Eigen::VectorX<int>(Eigen::Map<const Eigen::VectorX<int>>(from.data(), std::ssize(from)));
    };
    other_rows_ = copy(parts.others);
    staying_rows_ = copy(parts.staying);
    columns_ = copy(parts.columns);
    std::vector<int> row_order;
    std::vector<int> column_order;
    for (const AlikeBlock& block : parts.blocks) {
      row_order.insert(row_order.end(), block.rows.begin(), block.rows.begin() + pivots_);
      column_order.insert(column_order.end(), block.inner.begin(), block.inner.end());
    }
    row_order.insert(row_order.end(), parts.others.begin(), parts.others.end());
    for (const AlikeBlock& block : parts.blocks)
      row_order.insert(row_order.end(), block.rows.begin() + pivots_, block.rows.end());
    row_order.insert(row_order.end(), parts.staying.begin(), parts.staying.end());
    column_order.insert(column_order.end(), parts.columns.begin(), parts.columns.end());
    std::vector<char> seen(row_order.size());
    orders_sign_ = permutation_sign(row_order.data(), seen) * permutation_sign(column_order.data(), seen);
  }

  /// What is left: of other rows what they have, of blocks all outer columns, and full rows that stay.
  void build_rest(const SparseMatrix& pattern, const AlikeParts& parts) {
    const Index size = columns_.size();
    const Eigen::VectorX<int> row_of = places_of(other_rows_, pattern.rows());
    const Eigen::VectorX<int> column_of = places_of(columns_, pattern.cols());
    std::vector<std::vector<int>> rows(static_cast<std::size_t>(size));
    for (Index k = 0; k < size; ++k) {
      for (SparseMatrix::InnerIterator entry(pattern, columns_(k)); entry; ++entry) {
        if (row_of(entry.row()) >= 0) rows[static_cast<std::size_t>(k)].push_back(row_of(entry.row()));
      }
    }
    for (Index b = 0; b < blocks_; ++b) {
      for (const int column : parts.blocks[static_cast<std::size_t>(b)].outer) {
        for (Index i = 0; i < left_rows_; ++i)
          rows[static_cast<std::size_t>(column_of(column))].push_back(static_cast<int>(first_left(b) + i));
      }
    }
    rest_.resize(size, size);
    for (Index k = 0; k < size; ++k) {
      std::vector<int>& own = rows[static_cast<std::size_t>(k)];
      for (Index i = size - staying_; i < size; ++i) own.push_back(static_cast<int>(i));
      std::sort(own.begin(), own.end());
      rest_.startVec(k);
      for (const int row : own) rest_.insertBack(row, k) = 0;
    }
    rest_.finalize();
  }

  void make_rest_factors() {
    if (const AlikeParts pairs = find_alike_parts(rest_, staying_, true); !pairs.blocks.empty()) {
      rest_ = with_full_blocks(rest_, pairs.blocks);
      auto factors = std::make_unique<AlikeFactors>(rest_, pairs);
      if (factors->is_made()) rest_factors_ = std::move(factors);
    }
    if (rest_factors_ == nullptr)
      rest_factors_ = make_frontal_factors(rest_, staying_, std::numeric_limits<double>::infinity());
  }

  /// Entries of other rows, and of those that stay in columns that are left; and which are of those that
  /// stay.
  void find_kept(const SparseMatrix& pattern) {
    for (Index column = 0; column < pattern.cols(); ++column) {
      for (const int row : staying_rows_) {
        if (const int entry = place_in(pattern, row, column); entry >= 0) staying_entries_.push_back(entry);
      }
    }
    Eigen::VectorX<int> row_of = places_of(other_rows_, pattern.rows());
    for (Index k = 0; k < staying_; ++k)
      row_of(staying_rows_(k)) = static_cast<int>(columns_.size() - staying_ + k);
    for (Index k = 0; k < columns_.size(); ++k) {
      const int end = pattern.outerIndexPtr()[columns_(k) + 1];
      for (int from = pattern.outerIndexPtr()[columns_(k)]; from < end; ++from) {
        const int row = row_of(pattern.innerIndexPtr()[from]);
        if (row >= 0) kept_.emplace_back(from, place_in(rest_, row, k));
      }
    }
  }

  void fill_tables(const SparseMatrix& pattern, const AlikeParts& parts) {
    const Eigen::VectorX<int> column_of = places_of(columns_, pattern.cols());
    for (Index b = 0; b < blocks_; ++b) {
      const AlikeBlock& block = parts.blocks[static_cast<std::size_t>(b)];
      first_rows_.set(b, 0, block.rows.front());
      std::vector<int> columns = block.inner;
      columns.insert(columns.end(), block.outer.begin(), block.outer.end());
      for (Index j = 0; j < std::ssize(columns); ++j) {
        const int column = columns[static_cast<std::size_t>(j)];
        if (j < pivots_) {
          inner_columns_.set(b, j, column);
        } else {
          outer_columns_.set(b, j - pivots_, column_of(column));
          left_.columns(j - pivots_, b) = column;
        }
        sources_.set(b, j, place_in(pattern, block.rows.front(), column));
        for (Index i = 0; i < staying_ && j < pivots_; ++i)
          staying_sources_.set(b, j * staying_ + i, place_in(pattern, staying_rows_(i), column));
        if (j < pivots_) continue;
        targets_.set(b, j - pivots_, place_in(rest_, first_left(b), column_of(column)));
        for (Index i = 0; i < staying_; ++i)
          staying_targets_.set(b, (j - pivots_) * staying_ + i,
                               place_in(rest_, columns_.size() - staying_ + i, column_of(column)));
      }
    }
  }

  /// Rows that stay have their entries of outer columns in the rest.
  void take(const double* __restrict values, BlocksSideBySide& batch, Index b) {
    const int* sources = sources_.of(b).data();
    const int* staying = staying_sources_.of(b).data();
    for (Index j = 0; j < pivots_ + outer_; ++j, sources += lanes) {
      put_side_by_side(values, sources, height_ - staying_, batch.at(0, j));
      double* const last = batch.at(height_ - staying_, j);
      for (Index k = 0; k < staying_ * lanes; ++k) {
        const int source = j < pivots_ ? *staying++ : -1;
        last[k] = source < 0 ? 0 : values[source];
      }
    }
  }

  /// What is left of blocks goes into the rest.
  void leave(const BlocksSideBySide& batch, Index b) {
    double* const rest = rest_.valuePtr();
    const int* targets = targets_.of(b).data();
    const int* staying = staying_targets_.of(b).data();
    for (Index j = 0; j < outer_; ++j, targets += lanes) {
      const double* const column = batch.at(pivots_, pivots_ + j);
      for (Index lane = 0; lane < lanes_of(b); ++lane) {
        double* const to = rest + targets[lane];
        for (Index i = 0; i < left_rows_; ++i) to[i] = column[i * lanes + lane];
      }
      const double* last = column + left_rows_ * lanes;
      for (Index i = 0; i < staying_; ++i, last += lanes, staying += lanes) {
        for (Index lane = 0; lane < lanes_of(b); ++lane) rest[staying[lane]] += last[lane];
      }
    }
  }

  Index blocks_;
  Index pivots_;
  Index left_rows_;  // of each block
  Index outer_;      // columns
  Index staying_;    // rows
  Index height_;     // of a block with these
  Eigen::VectorX<int> other_rows_;
  Eigen::VectorX<int> staying_rows_;
  Eigen::VectorX<int> columns_;            // of the rest
  std::vector<std::pair<int, int>> kept_;  // entries of the matrix, and where they are among the rest's
  Table first_rows_;                       // of blocks
  Table inner_columns_;
  Table outer_columns_;  // among the rest's
  Table sources_;        // of each column's first entry
  Table staying_sources_;
  Table targets_;  // of what is left, of each column's first entry
  Table staying_targets_;
  std::vector<BlocksSideBySide> batches_;
  Matrix row_scales_;  // of those that do not stay
  Matrix vectors_;     // of all their rows
  RowsLeft left_;
  Vector behind_;
  Vector rest_vector_;
  SparseMatrix rest_;
  std::unique_ptr<SparseFactors> rest_factors_;
  double orders_sign_ = 1;
  std::vector<int> staying_entries_;
  double growth_ = 0;
};

}  // namespace

std::unique_ptr<SparseFactors> make_alike_factors(const SparseMatrix& pattern, Index borders) {
  const AlikeParts parts = find_alike_parts(pattern, borders, false);
  if (parts.blocks.empty()) return nullptr;
  auto factors = std::make_unique<AlikeFactors>(pattern, parts);
  if (!factors->is_made()) return nullptr;
  return factors;
}

}  // namespace arcslip::continuation
