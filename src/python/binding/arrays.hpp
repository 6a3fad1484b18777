#pragma once

// Vectors and matrices between Eigen and numpy. What is lent is read-only and keeps its owner alive; what is
// taken is copied, so that no view outlives the call that it was made for.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "arcslip/types.hpp"

namespace arcslip::python {

namespace py = pybind11;

/// The columns of a matrix as the rows of an array (columns x rows), one column as an array, a vector:
/// without a copy, for as long as `owner` holds them.
py::array lend(const Matrix& columns, const py::handle& owner);
py::array lend_column(const Matrix& columns, Index which, const py::handle& owner);
py::array lend(const Vector& vector, const py::handle& owner);

/// The same as arrays that own what they hold.
py::array give(Matrix columns);
py::array give(const Vector& vector);
py::array give(const ComplexVector& vector);

/// What a user's function returned, or gave as an argument, as real numbers of this shape (rows, or rows x
/// columns of a matrix). One number will do where one is expected. Throws py::value_error that begins with
/// `what` and says which shape or type it got.
void take(const py::handle& given, const std::string& what, Vector& out);
void take(const py::handle& given, const std::string& what, Matrix& out);
/// A sparse one: what has `tocsc`, as scipy's have, or (data, indices, indptr) of compressed columns. Its
/// pattern has to be that of `out`, unless that is empty.
void take(const py::handle& given, const std::string& what, Index n, SparseMatrix& out);
/// The same of complex numbers.
void take(const py::handle& given, const std::string& what, ComplexVector& out);

/// As many numbers as there are.
Vector take_all(const py::handle& given, const std::string& what);
ComplexVector take_all_complex(const py::handle& given, const std::string& what);

}  // namespace arcslip::python
