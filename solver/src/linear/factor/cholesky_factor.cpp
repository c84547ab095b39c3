#include "linear/factor/cholesky_factor.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "linear/factor/blas.h"
#include "linear/factor/single_threaded_blas.h"

namespace luxel {

namespace {

// Columns of a panel: the inner length of the updates, 256 of which keep the kernels within a few percent of
// their peak while the factorisation of the diagonal tile, which nobody else can share, stays below 1 % of
// the work.
constexpr int panel_width = 256;

// Rows of a tile: enough to pay for packing, few enough to balance the threads.
constexpr int tile_rows = 512;

int tile_count(int rows) {
  return (rows + tile_rows - 1) / tile_rows;
}

}  // namespace

template <class Real>
int CholeskyFactor<Real>::first(int panel) const {
  return std::min(panel * panel_width, size_);
}

template <class Real>
Real* CholeskyFactor<Real>::row(int panel, int i) const {
  return panels_[panel].get() + static_cast<std::size_t>(i - first(panel)) * width(panel);
}

template <class Real>
CholeskyFactor<Real>::CholeskyFactor(int size, const std::function<void(int, Real*)>& fill_row)
    : size_(size) {
  panels_.resize((size + panel_width - 1) / panel_width);
  for (int k = 0; k < panel_count(); ++k) {
    panels_[k].reset(new Real[static_cast<std::size_t>(size - first(k)) * width(k)]);
  }
  tbb::parallel_for(0, tile_count(size), [&](int tile) {
    std::vector<Real> values(size);
    for (int i = tile * tile_rows; i < std::min(size, (tile + 1) * tile_rows); ++i) {
      fill_row(i, values.data());
      for (int k = 0; first(k) <= i && k < panel_count(); ++k) {
        std::copy_n(values.data() + first(k), std::min(width(k), i + 1 - first(k)), row(k, i));
      }
    }
  });
}

// Right-looking: for each panel its diagonal tile, then the tiles below, then every tile to the right of
// them. Each tile meets the same updates in the same order whoever does them.
template <class Real>
bool CholeskyFactor<Real>::factor() {
  const SingleThreadedBlas single_threaded;
  for (int k = 0; k < panel_count(); ++k) {
    const int w = width(k);
    if (!blas::factor_cholesky(w, row(k, first(k)), w)) return false;
    const int below = first(k + 1);
    const int tiles = tile_count(size_ - below);
    const auto begin = [&](int tile) { return below + tile * tile_rows; };
    const auto rows = [&](int tile) { return std::min(tile_rows, size_ - begin(tile)); };
    tbb::parallel_for(0, tiles, [&](int tile) {
      blas::solve_triangle(CblasRowMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, rows(tile), w,
                           row(k, first(k)), w, row(k, begin(tile)), w);
    });

    struct Tile {
      int panel, begin, rows;
    };
    std::vector<Tile> updates;
    for (int j = k + 1; j < panel_count(); ++j) {
      updates.push_back({j, first(j), width(j)});
      for (int i = first(j + 1); i < size_; i += tile_rows)
        updates.push_back({j, i, std::min(tile_rows, size_ - i)});
    }
    tbb::parallel_for(std::size_t(0), updates.size(), [&](std::size_t u) {
      const auto [j, i, count] = updates[u];
      if (i == first(j)) {
        blas::subtract_square(width(j), w, row(k, i), w, row(j, i), width(j));
      } else {
        blas::subtract_product(CblasRowMajor, CblasTrans, count, width(j), w, row(k, i), w, row(k, first(j)),
                               w, row(j, i), width(j));
      }
    });
  }
  return true;
}

template <class Real>
void CholeskyFactor<Real>::solve(Block& x) const {
  const SingleThreadedBlas single_threaded;
  const int m = static_cast<int>(x.cols());
  const auto at = [&](int i) { return x.data() + static_cast<std::size_t>(i) * m; };
  for (int k = 0; k < panel_count(); ++k) {
    const int w = width(k), below = first(k + 1);
    blas::solve_triangle(CblasRowMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, w, m,
                         row(k, first(k)), w, at(first(k)), m);
    tbb::parallel_for(0, tile_count(size_ - below), [&](int tile) {
      const int i = below + tile * tile_rows;
      blas::subtract_product(CblasRowMajor, CblasNoTrans, std::min(tile_rows, size_ - i), m, w, row(k, i), w,
                             at(first(k)), m, at(i), m);
    });
  }
  for (int k = panel_count() - 1; k >= 0; --k) {
    const int w = width(k), below = first(k + 1);
    std::vector<Block> parts(tile_count(size_ - below), Block(w, m));
    tbb::parallel_for(0, static_cast<int>(parts.size()), [&](int tile) {
      const int i = below + tile * tile_rows;
      blas::transposed_product(w, m, std::min(tile_rows, size_ - i), row(k, i), w, at(i), m,
                               parts[tile].data(), m);
    });
    auto rows = x.middleRows(first(k), w);
    for (const Block& part : parts) rows -= part;
    blas::solve_triangle(CblasRowMajor, CblasLeft, CblasLower, CblasTrans, CblasNonUnit, w, m,
                         row(k, first(k)), w, at(first(k)), m);
  }
}

template class CholeskyFactor<float>;
template class CholeskyFactor<double>;

}  // namespace luxel
