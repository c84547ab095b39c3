#include "linear/factor/lu_factor.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "linear/factor/blas.h"
#include "linear/factor/single_threaded_blas.h"

namespace luxel {

namespace {

// Columns of a panel: the panel's own factorisation, which nobody else can share, is n panel_width / (4 n /
// 3) of the work, and the updates' inner length wants 128 or more.
constexpr int panel_width = 128;

// Rows of X that one task updates in a solve.
constexpr int tile_rows = 512;

template <class Body>
void for_row_tiles(int begin, int end, const Body& body) {
  tbb::parallel_for(0, (end - begin + tile_rows - 1) / tile_rows, [&](int tile) {
    const int first = begin + tile * tile_rows;
    body(first, std::min(tile_rows, end - first));
  });
}

}  // namespace

template <class Real>
LuFactor<Real>::LuFactor(int size) : size_(size), pivots_(size) {
  panels_.resize((size + panel_width - 1) / panel_width);
  for (int k = 0; k < panel_count(); ++k)
    panels_[k].reset(new Real[static_cast<std::size_t>(size) * width(k)]);
}

template <class Real>
int LuFactor<Real>::first(int panel) const {
  return std::min(panel * panel_width, size_);
}

template <class Real>
Real* LuFactor<Real>::column(int j) {
  return panels_[j / panel_width].get() + static_cast<std::size_t>(j % panel_width) * size_;
}

// Right-looking: factor a panel, then swap, solve and update every other one, which are independent of each
// other.
template <class Real>
bool LuFactor<Real>::factor() {
  const SingleThreadedBlas single_threaded;
  for (int k = 0; k < panel_count(); ++k) {
    const int w = width(k), top = first(k), below = first(k + 1);
    int* pivots = pivots_.data() + top;
    if (!blas::factor_lu(size_ - top, w, at(k, top), size_, pivots)) return false;
    tbb::parallel_for(0, panel_count(), [&](int j) {
      if (j == k) return;
      blas::swap_rows(width(j), at(j, top), size_, w, pivots);
      if (j < k) return;
      blas::solve_triangle(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasUnit, w, width(j),
                           at(k, top), size_, at(j, top), size_);
      blas::subtract_product(CblasColMajor, CblasNoTrans, size_ - below, width(j), w, at(k, below), size_,
                             at(j, top), size_, at(j, below), size_);
    });
  }
  return true;
}

template <class Real>
void LuFactor<Real>::solve(Block& x) const {
  const SingleThreadedBlas single_threaded;
  const int m = static_cast<int>(x.cols());
  const auto rows = [&](int i) { return x.data() + i; };
  for (int k = 0; k < panel_count(); ++k) {
    blas::swap_rows(m, rows(first(k)), size_, width(k), pivots_.data() + first(k));
  }
  for (int k = 0; k < panel_count(); ++k) {
    blas::solve_triangle(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasUnit, width(k), m,
                         at(k, first(k)), size_, rows(first(k)), size_);
    for_row_tiles(first(k + 1), size_, [&](int i, int count) {
      blas::subtract_product(CblasColMajor, CblasNoTrans, count, m, width(k), at(k, i), size_, rows(first(k)),
                             size_, rows(i), size_);
    });
  }
  for (int k = panel_count() - 1; k >= 0; --k) {
    blas::solve_triangle(CblasColMajor, CblasLeft, CblasUpper, CblasNoTrans, CblasNonUnit, width(k), m,
                         at(k, first(k)), size_, rows(first(k)), size_);
    for_row_tiles(0, first(k), [&](int i, int count) {
      blas::subtract_product(CblasColMajor, CblasNoTrans, count, m, width(k), at(k, i), size_, rows(first(k)),
                             size_, rows(i), size_);
    });
  }
}

template class LuFactor<float>;
template class LuFactor<double>;

}  // namespace luxel
