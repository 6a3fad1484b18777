#include "arcslip/continuation/linear/front_plan.hpp"

#include <algorithm>
#include <utility>

namespace arcslip::continuation {
namespace {

std::size_t number(int i) { return static_cast<std::size_t>(i); }

/// Where rows begin, and how many entries they have.
struct Rows {
  explicit Rows(const SparseMatrix& pattern)
      : first(static_cast<std::size_t>(pattern.rows()), static_cast<int>(pattern.cols())),
        count(static_cast<std::size_t>(pattern.rows()), 0) {
    for (int j = 0; j < pattern.cols(); ++j) {
      for (SparseMatrix::InnerIterator entry(pattern, j); entry; ++entry) {
        const auto row = static_cast<std::size_t>(entry.row());
        first[row] = std::min(first[row], j);
        ++count[row];
      }
    }
  }
  std::vector<int> first;
  std::vector<int> count;
};

class Planner {
 public:
  Planner(const SparseMatrix& pattern, Index borders)
      : pattern_(pattern), size_(static_cast<int>(pattern.rows())) {
    const Rows rows(pattern);
    const Index most = most_of_a_row(pattern);
    for (int i = 0; i < size_; ++i) {
      const bool stays = i >= size_ - borders || rows.count[number(i)] > most;
      (stays ? staying_ : plan_.row_order).push_back(i);
    }
    std::stable_sort(plan_.row_order.begin(), plan_.row_order.end(),
                     [&](int a, int b) { return rows.first[number(a)] < rows.first[number(b)]; });
    entering_ = static_cast<int>(plan_.row_order.size());
    plan_.row_order.insert(plan_.row_order.end(), staying_.begin(), staying_.end());
    find_times();
  }

  FrontPlan run(double most) {
    std::vector<int> live;  // columns of the front
    int pivots = 0;
    int carried = 0;
    int from = 0;  // rows
    while (from < entering_) {
      std::vector<int> now = live;
      int to = from;
      int ready = 0;
      while (to < entering_ && ready < std::max(8, static_cast<int>(now.size()) / 8)) {
        for (const int column : new_columns_[number(to)]) now.push_back(column);
        ready += ends_[number(to)];
        ++to;
      }
      if (to == entering_) break;  // the last front
      const int rows = carried + to - from;
      if (ready > rows) return {};
      add_front(live, now, pivots, rows, ready, to);
      from = to;
      pivots += ready;
      carried = rows - ready;
      if (plan_.multiplications > most) return {};
    }
    std::vector<int> rest = live;
    std::vector<char> is_in(number(size_), 0);
    for (const int column : live) is_in[number(column)] = 1;
    for (int j = 0; j < size_; ++j) {
      if (!is_in[number(j)] && (last_[number(j)] < 0 || enters_[number(j)] >= from)) rest.push_back(j);
    }
    add_front(live, rest, pivots, size_ - pivots, size_ - pivots, entering_);
    if (plan_.multiplications > most) return {};
    fill_entries();
    return std::move(plan_);
  }

 private:
  /// When a column comes with its first row, and when its last one is there.
  void find_times() {
    time_.assign(number(size_), -1);
    for (int i = 0; i < entering_; ++i) time_[number(plan_.row_order[number(i)])] = i;
    enters_.assign(number(size_), entering_);
    last_.assign(number(size_), -1);
    new_columns_.resize(number(entering_));
    ends_.assign(number(entering_), 0);
    for (int j = 0; j < size_; ++j) {
      for (SparseMatrix::InnerIterator entry(pattern_, j); entry; ++entry) {
        const int time = time_[number(static_cast<int>(entry.row()))];
        if (time < 0) continue;
        enters_[number(j)] = std::min(enters_[number(j)], time);
        last_[number(j)] = std::max(last_[number(j)], time);
      }
      if (last_[number(j)] < 0) continue;
      new_columns_[number(enters_[number(j)])].push_back(j);
      ++ends_[number(last_[number(j)])];
    }
  }

  /// Columns that no row from `to` on has are its pivots; `live` becomes the others.
  void add_front(std::vector<int>& live, const std::vector<int>& now, int first, int rows, int pivots,
                 int to) {
    const bool is_last = first + pivots == size_;
    Front front;
    front.first = first;
    front.rows = rows;
    front.height = is_last ? rows : rows + static_cast<int>(staying_.size());
    front.stride = (front.height + 3) / 4 * 4;
    front.pivots = pivots;
    front.columns = static_cast<int>(now.size());
    std::vector<int> order;
    std::vector<int> kept;
    for (const int column : now) (is_last || last_[number(column)] < to ? order : kept).push_back(column);
    plan_.column_order.insert(plan_.column_order.end(), order.begin(), order.end());
    order.insert(order.end(), kept.begin(), kept.end());
    front_columns_.push_back(order);
    front_rows_to_.push_back(to);
    std::vector<int> place(number(size_), -1);
    for (std::size_t k = 0; k < order.size(); ++k) place[number(order[k])] = static_cast<int>(k);
    for (const int column : live) front.carried.push_back(place[number(column)]);
    plan_.multiplications += static_cast<double>(front.pivots) * front.height * front.columns;
    plan_.fronts.push_back(std::move(front));
    live = std::move(kept);
  }

  void fill_entries() {
    std::vector<int> position(number(size_));
    for (int k = 0; k < size_; ++k) position[number(plan_.column_order[number(k)])] = k;
    std::vector<int> line(number(size_));  // of a row in the order of all
    for (int k = 0; k < size_; ++k) line[number(plan_.row_order[number(k)])] = k;
    std::vector<char> has_entered(number(size_), 0);
    std::ptrdiff_t values = 0;
    int rows_from = 0;
    for (std::size_t f = 0; f < plan_.fronts.size(); ++f) {
      Front& front = plan_.fronts[f];
      const bool is_last = f + 1 == plan_.fronts.size();
      front.values = values;
      front.exchanged.resize(number(front.pivots));
      values += static_cast<std::ptrdiff_t>(front.stride) * front.columns;
      const std::vector<int>& columns = front_columns_[f];
      for (std::size_t c = 0; c < columns.size(); ++c) {
        if (c >= number(front.pivots)) front.kept.push_back(position[number(columns[c])]);
        const int* begin = pattern_.outerIndexPtr();
        for (int k = begin[columns[c]]; k < begin[columns[c] + 1]; ++k) {
          const int row = pattern_.innerIndexPtr()[k];
          const int own = line[number(row)];
          const bool stays = own >= entering_;
          const bool enters =
              stays ? has_entered[number(columns[c])] == 0 : own >= rows_from && own < front_rows_to_[f];
          if (!enters) continue;
          const int place = stays && !is_last ? front.rows + own - entering_ : own - front.first;
          front.entries.push_back(k);
          front.places.push_back(static_cast<int>(c) * front.stride + place);
        }
        has_entered[number(columns[c])] = 1;
      }
      rows_from = front_rows_to_[f];
    }
  }

  const SparseMatrix& pattern_;
  int size_;
  int entering_ = 0;          // rows that enter one by one
  std::vector<int> staying_;  // the others
  std::vector<int> time_;     // of each row
  std::vector<int> enters_;   // of each column, and
  std::vector<int> last_;
  std::vector<std::vector<int>> new_columns_;  // with each row
  std::vector<int> ends_;                      // how many columns end with it
  std::vector<std::vector<int>> front_columns_;
  std::vector<int> front_rows_to_;
  FrontPlan plan_;
};

}  // namespace

Index most_of_a_row(const SparseMatrix& matrix) {
  return std::max<Index>(32, 4 * matrix.nonZeros() / std::max<Index>(matrix.rows(), 1));
}

FrontPlan plan_fronts(const SparseMatrix& pattern, Index borders, double most) {
  return Planner(pattern, borders).run(most);
}

}  // namespace arcslip::continuation
