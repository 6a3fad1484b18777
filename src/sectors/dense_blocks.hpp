#pragma once

// The operations of BLAS and LAPACK on blocks of dense matrices, of real and of complex numbers, that a
// factorisation by fronts consists of. Matrices are in column order, each with the distance of its columns.

#include <string>

#include "arcslip/types.hpp"

extern "C" {
void dpotrf_(const char*, const int*, double*, const int*, int*);
void zpotrf_(const char*, const int*, arcslip::Complex*, const int*, int*);
void dtrsm_(const char*, const char*, const char*, const char*, const int*, const int*, const double*,
            const double*, const int*, double*, const int*);
void ztrsm_(const char*, const char*, const char*, const char*, const int*, const int*,
            const arcslip::Complex*, const arcslip::Complex*, const int*, arcslip::Complex*, const int*);
void dsyrk_(const char*, const char*, const int*, const int*, const double*, const double*, const int*,
            const double*, double*, const int*);
void zherk_(const char*, const char*, const int*, const int*, const double*, const arcslip::Complex*,
            const int*, const double*, arcslip::Complex*, const int*);
void dgemm_(const char*, const char*, const int*, const int*, const int*, const double*, const double*,
            const int*, const double*, const int*, const double*, double*, const int*);
void zgemm_(const char*, const char*, const int*, const int*, const int*, const arcslip::Complex*,
            const arcslip::Complex*, const int*, const arcslip::Complex*, const int*, const arcslip::Complex*,
            arcslip::Complex*, const int*);
}

namespace arcslip::dense {

/// The file of the library that does them, found anew by each process.
std::string library();

template <class Scalar>
struct Blocks;

template <>
struct Blocks<double> {
  static constexpr auto potrf = dpotrf_;
  static constexpr auto trsm = dtrsm_;
  static constexpr auto herk = dsyrk_;
  static constexpr auto gemm = dgemm_;
};

template <>
struct Blocks<Complex> {
  static constexpr auto potrf = zpotrf_;
  static constexpr auto trsm = ztrsm_;
  static constexpr auto herk = zherk_;
  static constexpr auto gemm = zgemm_;
};

/// L of A = L L^H in the lower triangle of A, n x n; 0, or the row from 1 on at which A is not positive
/// definite.
template <class Scalar>
int cholesky(int n, Scalar* a, int distance) {
  int failed = 0;
  Blocks<Scalar>::potrf("L", &n, a, &distance, &failed);
  return failed;
}

/// B <- B L^{-H}, m x n.
template <class Scalar>
void divide_right(int m, int n, const Scalar* l, int l_distance, Scalar* b, int b_distance) {
  const Scalar one = 1;
  Blocks<Scalar>::trsm("R", "L", "C", "N", &m, &n, &one, l, &l_distance, b, &b_distance);
}

/// B <- L^{-1} B, m x n.
template <class Scalar>
void divide(int m, int n, const Scalar* l, int l_distance, Scalar* b, int b_distance) {
  const Scalar one = 1;
  Blocks<Scalar>::trsm("L", "L", "N", "N", &m, &n, &one, l, &l_distance, b, &b_distance);
}

/// B <- L^{-H} B, m x n.
template <class Scalar>
void divide_adjoint(int m, int n, const Scalar* l, int l_distance, Scalar* b, int b_distance) {
  const Scalar one = 1;
  Blocks<Scalar>::trsm("L", "L", "C", "N", &m, &n, &one, l, &l_distance, b, &b_distance);
}

/// The lower triangle of C <- C - A A^H, n x n, of A that is n x k.
template <class Scalar>
void subtract_square(int n, int k, const Scalar* a, int a_distance, Scalar* c, int c_distance) {
  const double minus = -1;
  const double one = 1;
  Blocks<Scalar>::herk("L", "N", &n, &k, &minus, a, &a_distance, &one, c, &c_distance);
}

/// C <- C - A B, m x n, of A that is m x k.
template <class Scalar>
void subtract_product(int m, int n, int k, const Scalar* a, int a_distance, const Scalar* b, int b_distance,
                      Scalar* c, int c_distance) {
  const Scalar minus = -1;
  const Scalar one = 1;
  Blocks<Scalar>::gemm("N", "N", &m, &n, &k, &minus, a, &a_distance, b, &b_distance, &one, c, &c_distance);
}

/// C <- C - A^H B, m x n, of A that is k x m.
template <class Scalar>
void subtract_adjoint_product(int m, int n, int k, const Scalar* a, int a_distance, const Scalar* b,
                              int b_distance, Scalar* c, int c_distance) {
  const Scalar minus = -1;
  const Scalar one = 1;
  Blocks<Scalar>::gemm("C", "N", &m, &n, &k, &minus, a, &a_distance, b, &b_distance, &one, c, &c_distance);
}

}  // namespace arcslip::dense
