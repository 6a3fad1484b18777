#include "complex_factors.hpp"

#include <new>
#include <stdexcept>

namespace arcslip {
namespace {

constexpr double worst_growth = 1e-3;  // of the pivots' growth when they were chosen

double* numbers_of(Complex* values) { return reinterpret_cast<double*>(values); }
double* numbers_of(ComplexSparseMatrix& matrix) { return numbers_of(matrix.valuePtr()); }

}  // namespace

ComplexFactors::ComplexFactors(ComplexSparseMatrix& pattern) {
  klu_defaults(&common_);
  common_.btf = 0;  // a sector is one block, whose diagonal must stay where it is
  symbolic_ = klu_analyze(static_cast<int>(pattern.rows()), pattern.outerIndexPtr(), pattern.innerIndexPtr(),
                          &common_);
  check_memory();
}

ComplexFactors::~ComplexFactors() {
  klu_z_free_numeric(&numeric_, &common_);
  klu_free_symbolic(&symbolic_, &common_);
}

void ComplexFactors::check_memory() const {
  if (common_.status == KLU_OUT_OF_MEMORY) throw std::bad_alloc();
  if (common_.status < 0) throw std::length_error("sector: more entries than indices can count");
}

bool ComplexFactors::factor(ComplexSparseMatrix& matrix) {
  return factor_with_old_pivots(matrix) || factor_with_new_pivots(matrix);
}

bool ComplexFactors::factor_with_old_pivots(ComplexSparseMatrix& matrix) {
  if (numeric_ == nullptr) return false;
  ++quick_;
  const int done = klu_z_refactor(matrix.outerIndexPtr(), matrix.innerIndexPtr(), numbers_of(matrix),
                                  symbolic_, numeric_, &common_);
  return done != 0 && common_.status == KLU_OK && regular() &&
         growth(matrix) >= worst_growth * chosen_growth_;
}

bool ComplexFactors::factor_with_new_pivots(ComplexSparseMatrix& matrix) {
  ++full_;
  klu_z_free_numeric(&numeric_, &common_);
  numeric_ =
      klu_z_factor(matrix.outerIndexPtr(), matrix.innerIndexPtr(), numbers_of(matrix), symbolic_, &common_);
  check_memory();
  if (numeric_ == nullptr || common_.status != KLU_OK || !regular()) return false;
  chosen_growth_ = growth(matrix);
  return true;
}

bool ComplexFactors::regular() {
  klu_z_rcond(symbolic_, numeric_, &common_);
  return common_.status == KLU_OK && common_.rcond > 0;
}

/// Reciprocal growth of the entries in the elimination: small where the pivots are bad.
double ComplexFactors::growth(ComplexSparseMatrix& matrix) {
  klu_z_rgrowth(matrix.outerIndexPtr(), matrix.innerIndexPtr(), numbers_of(matrix), symbolic_, numeric_,
                &common_);
  return common_.rgrowth;
}

void ComplexFactors::solve(ComplexMatrix& columns) {
  klu_z_solve(symbolic_, numeric_, static_cast<int>(columns.rows()), static_cast<int>(columns.cols()),
              numbers_of(columns.data()), &common_);
}

void ComplexFactors::solve_transposed(ComplexMatrix& columns) {
  constexpr int conjugate = 0;
  klu_z_tsolve(symbolic_, numeric_, static_cast<int>(columns.rows()), static_cast<int>(columns.cols()),
               numbers_of(columns.data()), conjugate, &common_);
}

}  // namespace arcslip
