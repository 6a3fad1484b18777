#include "sectors/complex_factors.hpp"

#include <slu_zdefs.h>

#include <new>
#include <vector>

#include "sectors/elimination.hpp"

namespace arcslip {

/// What SuperLU keeps, of the matrix with its rows divided by the sums of their entries' magnitudes.
struct ComplexFactors::Parts {
  explicit Parts(const ComplexSparseMatrix& pattern)
      : scaled(pattern), row_scale(pattern.rows()), columns(static_cast<std::size_t>(pattern.rows())) {
    constexpr double least_diagonal = 1e-3;  // of a column's largest entry, to be the pivot
    scaled.makeCompressed();
    rows = etree = columns;
    const std::vector<int> order = least_fill_order(symmetric_pattern(scaled));
    const int size = static_cast<int>(scaled.rows());
    for (int i = 0; i < size; ++i) columns[subscript(order[subscript(i)])] = i;

    set_default_options(&options);
    options.ColPerm = MY_PERMC;
    options.SymmetricMode = YES;
    options.DiagPivotThresh = least_diagonal;
    StatInit(&statistics);
    zCreate_CompCol_Matrix(&matrix, size, size, static_cast<int>(scaled.nonZeros()),
                           reinterpret_cast<doublecomplex*>(scaled.valuePtr()), scaled.innerIndexPtr(),
                           scaled.outerIndexPtr(), SLU_NC, SLU_Z, SLU_GE);
    sp_preorder(&options, &matrix, columns.data(), etree.data(), &ordered);
  }

  ~Parts() {
    release();
    Destroy_CompCol_Permuted(&ordered);
    Destroy_SuperMatrix_Store(&matrix);
    StatFree(&statistics);
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  void release() {
    if (lower.Store != nullptr) Destroy_SuperNode_Matrix(&lower);
    if (upper.Store != nullptr) Destroy_CompCol_Matrix(&upper);
    lower.Store = upper.Store = nullptr;
  }

  void take(const ComplexSparseMatrix& values) {
    row_scale.setZero();
    for (Index j = 0; j < values.cols(); ++j)
      for (ComplexSparseMatrix::InnerIterator entry(values, j); entry; ++entry)
        row_scale(entry.row()) += std::abs(entry.value());
    for (double& scale : row_scale) scale = scale > 0 ? 1 / scale : 1;
    const Complex* from = values.valuePtr();
    for (Index i = 0; i < scaled.nonZeros(); ++i)
      scaled.valuePtr()[i] = from[i] * row_scale(scaled.innerIndexPtr()[i]);
  }

  bool factor() {
    release();
    int info = 0;
    zgstrf(&options, &ordered, sp_ienv(2), sp_ienv(1), etree.data(), nullptr, 0, columns.data(), rows.data(),
           &lower, &upper, &sharing, &statistics, &info);
    if (info > scaled.cols()) throw std::bad_alloc();
    return info == 0;
  }

  void solve(trans_t form, ComplexMatrix& right) {
    SuperMatrix b;
    const int size = static_cast<int>(right.rows());
    zCreate_Dense_Matrix(&b, size, static_cast<int>(right.cols()),
                         reinterpret_cast<doublecomplex*>(right.data()), size, SLU_DN, SLU_Z, SLU_GE);
    int info = 0;
    zgstrs(form, &lower, &upper, columns.data(), rows.data(), &b, &statistics, &info);
    Destroy_SuperMatrix_Store(&b);
  }

  ComplexSparseMatrix scaled;
  Vector row_scale;
  std::vector<int> columns, rows, etree;
  superlu_options_t options{};
  SuperLUStat_t statistics{};
  SuperMatrix matrix{}, ordered{}, lower{}, upper{};
  GlobalLU_t sharing{};
};

ComplexFactors::ComplexFactors(const ComplexSparseMatrix& pattern)
    : parts_(std::make_unique<Parts>(pattern)) {}

ComplexFactors::~ComplexFactors() = default;

bool ComplexFactors::factor(const ComplexSparseMatrix& matrix) {
  ++factorisations_;
  parts_->take(matrix);
  return parts_->factor();
}

void ComplexFactors::release() { parts_->release(); }

void ComplexFactors::solve(ComplexMatrix& columns) {
  columns.array().colwise() *= parts_->row_scale.array().cast<Complex>();
  parts_->solve(NOTRANS, columns);
}

void ComplexFactors::solve_transposed(ComplexMatrix& columns) {
  parts_->solve(TRANS, columns);
  columns.array().colwise() *= parts_->row_scale.array().cast<Complex>();
}

}  // namespace arcslip
