#include "sectors/complex_factors.hpp"

#include <umfpack.h>

#include <new>
#include <stdexcept>

namespace arcslip {
namespace {

static_assert(UMFPACK_CONTROL == 20);

const double* numbers_of(const Complex* values) { return reinterpret_cast<const double*>(values); }
double* numbers_of(Complex* values) { return reinterpret_cast<double*>(values); }

void check_memory(int status) {
  if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
  if (status < 0) throw std::length_error("sector: more entries than indices can count");
}

}  // namespace

ComplexFactors::ComplexFactors(const ComplexSparseMatrix& pattern) : right_(pattern.rows()) {
  umfpack_zi_defaults(control_.data());
  control_[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
  control_[UMFPACK_IRSTEP] = 0;
  const int size = static_cast<int>(pattern.rows());
  check_memory(umfpack_zi_symbolic(size, size, pattern.outerIndexPtr(), pattern.innerIndexPtr(), nullptr,
                                   nullptr, &symbolic_, control_.data(), nullptr));
}

ComplexFactors::~ComplexFactors() {
  umfpack_zi_free_numeric(&numeric_);
  umfpack_zi_free_symbolic(&symbolic_);
}

bool ComplexFactors::factor(const ComplexSparseMatrix& matrix) {
  ++factorisations_;
  release();
  std::array<double, UMFPACK_INFO> info{};
  const int status =
      umfpack_zi_numeric(matrix.outerIndexPtr(), matrix.innerIndexPtr(), numbers_of(matrix.valuePtr()),
                         nullptr, symbolic_, &numeric_, control_.data(), info.data());
  check_memory(status);
  pivot_ratio_ = info[UMFPACK_RCOND];
  return status == UMFPACK_OK && pivot_ratio_ > 0;
}

void ComplexFactors::release() { umfpack_zi_free_numeric(&numeric_); }

void ComplexFactors::solve(int system, ComplexMatrix& columns) {
  for (Index column = 0; column < columns.cols(); ++column) {
    right_ = columns.col(column);
    check_memory(umfpack_zi_solve(system, nullptr, nullptr, nullptr, nullptr,
                                  numbers_of(columns.col(column).data()), nullptr, numbers_of(right_.data()),
                                  nullptr, numeric_, control_.data(), nullptr));
  }
}

void ComplexFactors::solve(ComplexMatrix& columns) { solve(UMFPACK_A, columns); }

void ComplexFactors::solve_transposed(ComplexMatrix& columns) { solve(UMFPACK_Aat, columns); }

}  // namespace arcslip
