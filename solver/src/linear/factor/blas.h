#pragma once

#include <cblas.h>
#include <lapack.h>

namespace luxel::blas {

// The BLAS calls that the factorisations need, for float and double, each one call of a single-threaded
// kernel: see SingleThreadedBlas. `layout` says how all matrices of a call are stored.

/// C <- C - A op(B), C m x n, A m x k, op(B) k x n.
inline void subtract_product(CBLAS_LAYOUT layout, CBLAS_TRANSPOSE b_op, int m, int n, int k, const float* a,
                             int lda, const float* b, int ldb, float* c, int ldc) {
  cblas_sgemm(layout, CblasNoTrans, b_op, m, n, k, -1, a, lda, b, ldb, 1, c, ldc);
}
inline void subtract_product(CBLAS_LAYOUT layout, CBLAS_TRANSPOSE b_op, int m, int n, int k, const double* a,
                             int lda, const double* b, int ldb, double* c, int ldc) {
  cblas_dgemm(layout, CblasNoTrans, b_op, m, n, k, -1, a, lda, b, ldb, 1, c, ldc);
}

/// C <- A^T B, row-major, C m x n, A k x m, B k x n.
inline void transposed_product(int m, int n, int k, const float* a, int lda, const float* b, int ldb,
                               float* c, int ldc) {
  cblas_sgemm(CblasRowMajor, CblasTrans, CblasNoTrans, m, n, k, 1, a, lda, b, ldb, 0, c, ldc);
}
inline void transposed_product(int m, int n, int k, const double* a, int lda, const double* b, int ldb,
                               double* c, int ldc) {
  cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, m, n, k, 1, a, lda, b, ldb, 0, c, ldc);
}

/// Lower triangle of C <- C - A A^T, row-major, C n x n, A n x k.
inline void subtract_square(int n, int k, const float* a, int lda, float* c, int ldc) {
  cblas_ssyrk(CblasRowMajor, CblasLower, CblasNoTrans, n, k, -1, a, lda, 1, c, ldc);
}
inline void subtract_square(int n, int k, const double* a, int lda, double* c, int ldc) {
  cblas_dsyrk(CblasRowMajor, CblasLower, CblasNoTrans, n, k, -1, a, lda, 1, c, ldc);
}

/// X <- op(T)^-1 X or X op(T)^-1, T triangular, X m x n.
inline void solve_triangle(CBLAS_LAYOUT layout, CBLAS_SIDE side, CBLAS_UPLO uplo, CBLAS_TRANSPOSE op,
                           CBLAS_DIAG diagonal, int m, int n, const float* t, int ldt, float* x, int ldx) {
  cblas_strsm(layout, side, uplo, op, diagonal, m, n, 1, t, ldt, x, ldx);
}
inline void solve_triangle(CBLAS_LAYOUT layout, CBLAS_SIDE side, CBLAS_UPLO uplo, CBLAS_TRANSPOSE op,
                           CBLAS_DIAG diagonal, int m, int n, const double* t, int ldt, double* x, int ldx) {
  cblas_dtrsm(layout, side, uplo, op, diagonal, m, n, 1, t, ldt, x, ldx);
}

/// Cholesky factor of a row-major lower triangle in place; false where it is not positive definite. LAPACK is
/// column-major and sees the upper triangle.
inline bool factor_cholesky(int n, float* a, int lda) {
  int info = 0;
  LAPACK_spotrf("U", &n, a, &lda, &info);
  return info == 0;
}
inline bool factor_cholesky(int n, double* a, int lda) {
  int info = 0;
  LAPACK_dpotrf("U", &n, a, &lda, &info);
  return info == 0;
}

/// P L U of a column-major m x n panel in place, with partial pivoting: row i was swapped with row pivots[i]
/// - 1, in order. False where a pivot is exactly 0.
inline bool factor_lu(int m, int n, float* a, int lda, int* pivots) {
  int info = 0;
  LAPACK_sgetrf(&m, &n, a, &lda, pivots, &info);
  return info == 0;
}
inline bool factor_lu(int m, int n, double* a, int lda, int* pivots) {
  int info = 0;
  LAPACK_dgetrf(&m, &n, a, &lda, pivots, &info);
  return info == 0;
}

/// Swaps the rows of n column-major columns as the first `count` pivots say.
inline void swap_rows(int n, float* a, int lda, int count, const int* pivots) {
  const int first = 1, step = 1;
  LAPACK_slaswp(&n, a, &lda, &first, &count, pivots, &step);
}
inline void swap_rows(int n, double* a, int lda, int count, const int* pivots) {
  const int first = 1, step = 1;
  LAPACK_dlaswp(&n, a, &lda, &first, &count, pivots, &step);
}

}  // namespace luxel::blas
