#include "python/binding/arrays.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <span>

namespace arcslip::python {
namespace {

/// A view that cannot be written through.
py::array view(std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides, const double* data,
               const py::handle& owner) {
  py::array array(py::dtype::of<double>(), std::move(shape), std::move(strides), data, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

std::string shape_of(const py::array& array) { return py::str(array.attr("shape")).cast<std::string>(); }

[[noreturn]] void refuse(const std::string& what, const std::string& got, const std::string& expected) {
  throw py::value_error(fmt::format("{}: expected {}, got {}", what, expected, got));
}

std::string type_of(const py::handle& given) {
  return py::str(py::type::handle_of(given).attr("__name__")).cast<std::string>();
}

/// Any nested sequence of numbers as an array; what numpy makes an array of objects of is refused.
py::array as_array(const py::handle& given, const std::string& what) {
  if (py::isinstance<py::array>(given)) return py::reinterpret_borrow<py::array>(given);
  if (given.is_none()) refuse(what, "None", "numbers");
  py::array array = py::array::ensure(given);
  if (!array) refuse(what, "a " + type_of(given), "numbers");
  return array;
}

/// As real or complex numbers in the order of memory that Eigen has.
template <class Number, int layout>
py::array_t<Number, layout | py::array::forcecast> converted(const py::array& array,
                                                             const std::string& what) {
  const char kind = array.dtype().kind();
  const bool is_complex = kind == 'c';
  if (is_complex && !std::is_same_v<Number, Complex>) refuse(what, "complex numbers", "real numbers");
  if (kind != 'f' && kind != 'i' && kind != 'u' && kind != 'b' && !is_complex)
    refuse(what, fmt::format("an array of {}", py::str(array.dtype()).cast<std::string>()), "numbers");
  return py::array_t<Number, layout | py::array::forcecast>(array);
}

template <class Number, class Out>
void take_vector(const py::handle& given, const std::string& what, Out& out) {
  const py::array array = as_array(given, what);
  const bool is_one = out.size() == 1 && array.ndim() == 0;
  if (!is_one && (array.ndim() != 1 || array.shape(0) != out.size()))
    refuse(what, "an array of shape " + shape_of(array), fmt::format("shape ({},)", out.size()));
  const auto numbers = converted<Number, py::array::c_style>(array, what);
  std::copy_n(numbers.data(), out.size(), out.data());
}

}  // namespace

py::array lend(const Matrix& columns, const py::handle& owner) {
  constexpr auto each = static_cast<py::ssize_t>(sizeof(double));
  return view({columns.cols(), columns.rows()}, {each * columns.rows(), each}, columns.data(), owner);
}

py::array lend_column(const Matrix& columns, Index which, const py::handle& owner) {
  return view({columns.rows()}, {sizeof(double)}, columns.col(which).data(), owner);
}

py::array lend(const Vector& vector, const py::handle& owner) {
  return view({vector.size()}, {sizeof(double)}, vector.data(), owner);
}

py::array give(Matrix columns) {
  auto kept = std::make_unique<Matrix>(std::move(columns));
  const Matrix& matrix = *kept;
  const py::capsule owner(kept.release(), [](void* pointer) { delete static_cast<Matrix*>(pointer); });
  return lend(matrix, owner);
}

py::array give(const Vector& vector) { return py::array_t<double>(vector.size(), vector.data()); }

py::array give(const ComplexVector& vector) { return py::array_t<Complex>(vector.size(), vector.data()); }

void take(const py::handle& given, const std::string& what, Vector& out) {
  take_vector<double, Vector>(given, what, out);
}

void take(const py::handle& given, const std::string& what, ComplexVector& out) {
  take_vector<Complex, ComplexVector>(given, what, out);
}

void take(const py::handle& given, const std::string& what, Matrix& out) {
  const py::array array = as_array(given, what);
  const bool is_one = out.size() == 1 && array.ndim() == 0;
  const bool is_column = out.cols() == 1 && array.ndim() == 1 && array.shape(0) == out.rows();
  if (!is_one && !is_column &&
      (array.ndim() != 2 || array.shape(0) != out.rows() || array.shape(1) != out.cols()))
    refuse(what, "an array of shape " + shape_of(array),
           fmt::format("shape ({}, {})", out.rows(), out.cols()));
  using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto numbers = converted<double, py::array::c_style>(array, what);
  out = Eigen::Map<const ByRows>(numbers.data(), out.rows(), out.cols());
}

namespace {

/// data, indices and indptr of what is given as a sparse matrix.
py::tuple compressed_columns(const py::handle& given, const std::string& what, Index n) {
  auto parts = py::reinterpret_borrow<py::object>(given);
  if (py::hasattr(given, "tocsc")) {
    const py::object columns = given.attr("tocsc")();
    if (!columns.attr("has_canonical_format").cast<bool>()) columns.attr("sum_duplicates")();
    if (columns.attr("shape").cast<std::pair<Index, Index>>() != std::pair(n, n))
      refuse(what, "shape " + py::str(columns.attr("shape")).cast<std::string>(),
             fmt::format("shape ({}, {})", n, n));
    parts = py::make_tuple(columns.attr("data"), columns.attr("indices"), columns.attr("indptr"));
  }
  if (!py::isinstance<py::tuple>(parts) || py::len(parts) != 3)
    refuse(what, "a " + type_of(given), "a sparse matrix, or data, indices and indptr of compressed columns");
  return parts;
}

/// Refuses what are no compressed columns of n x n.
void check_columns(std::span<const int> rows, std::span<const int> starts, Index count,
                   const std::string& what, Index n) {
  const auto is_row = [n](int row) { return row >= 0 && row < n; };
  const bool fits = std::ssize(starts) == n + 1 && std::ssize(rows) == count && starts.front() == 0 &&
                    starts.back() == count && std::is_sorted(starts.begin(), starts.end()) &&
                    std::all_of(rows.begin(), rows.end(), is_row);
  if (!fits)
    refuse(what, "others", fmt::format("indices of the compressed columns of a {} x {} matrix", n, n));
  for (Index j = 0; j < n; ++j) {
    const auto column = rows.begin() + starts[static_cast<std::size_t>(j)];
    const auto end = rows.begin() + starts[static_cast<std::size_t>(j) + 1];
    if (std::adjacent_find(column, end, std::greater_equal<>()) != end)
      refuse(what, fmt::format("column {} otherwise", j), "ascending indices in each column, each once");
  }
}

}  // namespace

void take(const py::handle& given, const std::string& what, Index n, SparseMatrix& out) {
  const py::tuple parts = compressed_columns(given, what, n);
  using Integers = py::array_t<int, py::array::c_style | py::array::forcecast>;
  const auto values = converted<double, py::array::c_style>(as_array(parts[0], what), what);
  const auto given_rows = parts[1].cast<Integers>();
  const auto given_starts = parts[2].cast<Integers>();
  const std::span<const int> rows(given_rows.data(), static_cast<std::size_t>(given_rows.size()));
  const std::span<const int> starts(given_starts.data(), static_cast<std::size_t>(given_starts.size()));
  const bool known = out.nonZeros() > 0;
  const bool same =
      known && values.size() == out.nonZeros() &&
      std::ranges::equal(rows, std::span(out.innerIndexPtr(), static_cast<std::size_t>(out.nonZeros()))) &&
      std::ranges::equal(starts, std::span(out.outerIndexPtr(), static_cast<std::size_t>(n) + 1));
  if (same) {
    std::copy_n(values.data(), values.size(), out.valuePtr());
    return;
  }
  check_columns(rows, starts, values.size(), what, n);
  if (known)
    throw py::value_error(what + ": its pattern is not what it was; keep zeros that may become others");
  out = Eigen::Map<const SparseMatrix>(n, n, values.size(), starts.data(), rows.data(), values.data());
}

Vector take_all(const py::handle& given, const std::string& what) {
  const py::array array = as_array(given, what);
  if (array.ndim() > 1) refuse(what, "an array of shape " + shape_of(array), "one row of numbers");
  Vector all(array.size());
  take(array, what, all);
  return all;
}

ComplexVector take_all_complex(const py::handle& given, const std::string& what) {
  const py::array array = as_array(given, what);
  if (array.ndim() > 1) refuse(what, "an array of shape " + shape_of(array), "one row of numbers");
  ComplexVector all(array.size());
  take(array, what, all);
  return all;
}

}  // namespace arcslip::python
