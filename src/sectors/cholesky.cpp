#include "sectors/cholesky.hpp"

#include <algorithm>

#include "sectors/dense_blocks.hpp"

namespace arcslip {
namespace {

/// Adds a column of a lower triangle to the rows of another one.
template <class Dense>
void scatter(const Dense& triangle, std::size_t column, const std::vector<int>& rows,
             const std::vector<int>& within, typename Dense::Scalar* target) {
  const typename Dense::Scalar* source = triangle.data() + column * rows.size();
  for (std::size_t i = column; i < rows.size(); ++i) target[within[subscript(rows[i])]] += source[i];
}

}  // namespace
template <class Scalar>
Cholesky<Scalar>::Cholesky(const Sparse& pattern) : elimination_(symmetric_pattern(pattern)) {
  std::size_t size = 0;
  for (const Front& front : elimination_.fronts()) {
    begin_.push_back(size);
    size += front.height() * subscript(front.width);
  }
  values_.resize(size);
}

/// The matrix' own entries of the front's columns. Sets `within` to where its rows are in the front.
template <class Scalar>
void Cholesky<Scalar>::assemble(const Sparse& matrix, const Front& front, Scalar* panel,
                                std::vector<int>& within) const {
  std::fill_n(panel, front.height() * subscript(front.width), Scalar(0));
  for (int j = 0; j < front.width; ++j) within[subscript(front.first + j)] = j;
  for (std::size_t i = 0; i < front.rows.size(); ++i)
    within[subscript(front.rows[i])] = front.width + static_cast<int>(i);
  for (int j = 0; j < front.width; ++j) {
    Scalar* column = panel + subscript(j) * front.height();
    for (typename Sparse::InnerIterator entry(matrix, elimination_.order()[subscript(front.first + j)]);
         entry; ++entry) {
      const int place = elimination_.place()[static_cast<std::size_t>(entry.row())];
      if (place >= front.first + j) column[within[subscript(place)]] += entry.value();
    }
  }
}

/// The columns of the factor and what is passed on.
template <class Scalar>
bool Cholesky<Scalar>::eliminate(const Front& front, Scalar* panel, Dense& update) {
  const int height = static_cast<int>(front.height());
  const int below = height - front.width;
  const int failed = dense::cholesky(front.width, panel, height);
  if (failed > 0) {
    indefinite_at_ = elimination_.order()[subscript(front.first + failed - 1)];
    return false;
  }
  if (below == 0) return true;
  Scalar* rows = panel + front.width;
  dense::divide_right(below, front.width, panel, height, rows, height);
  dense::subtract_square(below, front.width, rows, height, update.data(), below);
  return true;
}

template <class Scalar>
bool Cholesky<Scalar>::factor(const Sparse& matrix) {
  const std::vector<Front>& fronts = elimination_.fronts();
  std::vector<Dense> updates(fronts.size());  // lower triangles
  std::vector<std::vector<std::size_t>> children(fronts.size());
  std::vector<int> within(elimination_.order().size());
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    const Front& front = fronts[f];
    Scalar* panel = values_.data() + begin_[f];
    assemble(matrix, front, panel, within);
    Dense& update = updates[f];
    update.setZero(std::ssize(front.rows), std::ssize(front.rows));
    for (const std::size_t child : children[f]) {
      for (std::size_t j = 0; j < fronts[child].rows.size(); ++j) {
        const int column = within[subscript(fronts[child].rows[j])];
        Scalar* target = column < front.width
                             ? panel + subscript(column) * front.height()
                             : update.data() + (column - front.width) * update.rows() - front.width;
        scatter(updates[child], j, fronts[child].rows, within, target);
      }
      updates[child].resize(0, 0);
    }
    if (!eliminate(front, panel, update)) return false;
    if (front.parent != -1) children[subscript(front.parent)].push_back(f);
  }
  return true;
}

/// x <- L^{-1} x
template <class Scalar>
void Cholesky<Scalar>::forward(Dense& x) const {
  const int size = static_cast<int>(x.rows());
  const int count = static_cast<int>(x.cols());
  Dense below;
  for (std::size_t f = 0; f < begin_.size(); ++f) {
    const Front& front = elimination_.fronts()[f];
    const int height = static_cast<int>(front.height());
    const int rows = height - front.width;
    const Scalar* panel = values_.data() + begin_[f];
    Scalar* own = x.data() + front.first;
    dense::divide(front.width, count, panel, height, own, size);
    if (rows == 0) continue;
    below.setZero(rows, count);
    dense::subtract_product(rows, count, front.width, panel + front.width, height, own, size, below.data(),
                            rows);
    for (Index k = 0; k < count; ++k) {
      for (int i = 0; i < rows; ++i) x(front.rows[subscript(i)], k) += below(i, k);
    }
  }
}

/// x <- L^{-H} x
template <class Scalar>
void Cholesky<Scalar>::backward(Dense& x) const {
  const int size = static_cast<int>(x.rows());
  const int count = static_cast<int>(x.cols());
  Dense below;
  for (std::size_t f = begin_.size(); f-- > 0;) {
    const Front& front = elimination_.fronts()[f];
    const int height = static_cast<int>(front.height());
    const int rows = height - front.width;
    const Scalar* panel = values_.data() + begin_[f];
    Scalar* own = x.data() + front.first;
    if (rows > 0) {
      below.resize(rows, count);
      for (Index k = 0; k < count; ++k) {
        for (int i = 0; i < rows; ++i) below(i, k) = x(front.rows[subscript(i)], k);
      }
      dense::subtract_adjoint_product(front.width, count, rows, panel + front.width, height, below.data(),
                                      rows, own, size);
    }
    dense::divide_adjoint(front.width, count, panel, height, own, size);
  }
}

template <class Scalar>
void Cholesky<Scalar>::solve(Dense& columns) const {
  Dense ordered = columns(elimination_.order(), Eigen::all);
  forward(ordered);
  backward(ordered);
  columns(elimination_.order(), Eigen::all) = ordered;
}

template class Cholesky<double>;
template class Cholesky<Complex>;

}  // namespace arcslip
