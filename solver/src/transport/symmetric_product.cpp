#include "transport/symmetric_product.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/symmetric_product.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace luxel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::ScalableTag<double>;

HWY_ATTR inline hn::Vec<Doubles> load(Doubles d, const double* from) {
  return hn::LoadU(d, from);
}
HWY_ATTR inline hn::Vec<Doubles> load(Doubles d, const float* from) {
  return hn::PromoteTo(d, hn::LoadU(hn::Rebind<float, Doubles>(), from));
}

/// `Rows` rows from `row` on against the columns [0, width), width a multiple of 8: adds G x to y at the rows
/// and G^T x to y at the columns. x and y hold Columns arrays, `stride` apart.
template <class Real, int Rows, int Columns>
HWY_ATTR void panel(const ExchangeMatrix& matrix, int row, int width, const double* HWY_RESTRICT x,
                    double* HWY_RESTRICT y, std::size_t stride) {
  const Doubles d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const Real* g[Rows];
  hn::Vec<Doubles> sum[Rows][Columns];
  hn::Vec<Doubles> own[Rows][Columns];
  for (int r = 0; r < Rows; ++r) {
    g[r] = matrix.row<Real>(row + r);
    for (int c = 0; c < Columns; ++c) {
      sum[r][c] = hn::Zero(d);
      own[r][c] = hn::Set(d, x[c * stride + row + r]);
    }
  }
  for (int j = 0; j < width; j += lanes) {
    hn::Vec<Doubles> entries[Rows];
    for (int r = 0; r < Rows; ++r) entries[r] = load(d, g[r] + j);
    for (int c = 0; c < Columns; ++c) {
      const auto other = hn::LoadU(d, x + c * stride + j);
      auto back = hn::LoadU(d, y + c * stride + j);
      for (int r = 0; r < Rows; ++r) {
        sum[r][c] = hn::MulAdd(entries[r], other, sum[r][c]);
        back = hn::MulAdd(entries[r], own[r][c], back);
      }
      hn::StoreU(back, d, y + c * stride + j);
    }
  }
  for (int r = 0; r < Rows; ++r) {
    for (int c = 0; c < Columns; ++c) y[c * stride + row + r] += hn::GetLane(hn::SumOfLanes(d, sum[r][c]));
  }
}

/// The entries of rows [begin, end) right of column `from`: what the panels leave along the diagonal.
template <class Real, int Columns>
void corner(const ExchangeMatrix& matrix, int begin, int end, int from, const double* x, double* y,
            std::size_t stride) {
  for (int i = begin; i < end; ++i) {
    const Real* g = matrix.row<Real>(i);
    for (int j = from; j < i; ++j) {
      const double entry = g[j];
      for (int c = 0; c < Columns; ++c) {
        y[c * stride + i] += entry * x[c * stride + j];
        y[c * stride + j] += entry * x[c * stride + i];
      }
    }
  }
}

template <class Real, int Columns>
void rows(const ExchangeMatrix& matrix, RowBlock block, const double* x, double* y, std::size_t stride) {
  // as many rows at once as the registers hold sums, own values and entries for
  constexpr bool many_registers = HWY_MAX_BYTES >= 64;
  constexpr int together = Columns == 1 ? (many_registers ? 8 : 4) : (many_registers ? 4 : 2);
  for (int band = block.begin; band < block.end; band += 8) {
    const int end = std::min(band + 8, block.end);
    int row = band;
    for (; row + together <= end; row += together) {
      panel<Real, together, Columns>(matrix, row, band, x, y, stride);
    }
    for (; row < end; ++row) panel<Real, 1, Columns>(matrix, row, band, x, y, stride);
    corner<Real, Columns>(matrix, band, end, band, x, y, stride);
  }
}

template <class Real>
void any_columns(const ExchangeMatrix& matrix, RowBlock block, const double* x, double* y, std::size_t stride,
                 int columns) {
  if (columns == 1) rows<Real, 1>(matrix, block, x, y, stride);
  if (columns == 2) rows<Real, 2>(matrix, block, x, y, stride);
  if (columns == 3) rows<Real, 3>(matrix, block, x, y, stride);
}

/// Adds one block's part of G X to y, which holds `columns` (at most 3) arrays `stride` apart.
void add_rows(const ExchangeMatrix& matrix, RowBlock block, const double* x, double* y, std::size_t stride,
              int columns) {
  if (matrix.precision() == Precision::float32) {
    any_columns<float>(matrix, block, x, y, stride, columns);
  } else {
    any_columns<double>(matrix, block, x, y, stride, columns);
  }
}

}  // namespace luxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace luxel {

HWY_EXPORT(add_rows);

namespace {

// Right-hand sides that share one pass: more would not fit the registers.
constexpr int columns_a_pass = 3;

// Rows a block on average: fewer make the partial sums weigh, more leave cores idle.
constexpr int rows_a_block = 512;
constexpr int most_blocks = 64;

/// One pass over G for at most columns_a_pass columns, which start at `first`.
void one_pass(const ExchangeMatrix& matrix, const std::vector<RowBlock>& blocks, const double* x, double* y,
              int columns, int first, int count) {
  const std::size_t size = matrix.size();
  std::vector<double> planar(size * count);
  for (std::size_t i = 0; i < size; ++i) {
    for (int c = 0; c < count; ++c) planar[c * size + i] = x[i * columns + first + c];
  }
  std::vector<std::vector<double>> partial(blocks.size());
  tbb::parallel_for(
      std::size_t{0}, blocks.size(),
      [&](std::size_t b) {
        partial[b].assign(size * count, 0.0);
        HWY_DYNAMIC_DISPATCH(add_rows)(matrix, blocks[b], planar.data(), partial[b].data(), size, count);
      },
      tbb::simple_partitioner());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, size, 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      for (int c = 0; c < count; ++c) {
        double sum = 0;
        for (std::size_t b = 0; b < blocks.size(); ++b) {
          if (static_cast<std::size_t>(blocks[b].end) > i) sum += partial[b][c * size + i];
        }
        y[i * columns + first + c] = sum;
      }
    }
  });
}

}  // namespace

std::vector<RowBlock> row_blocks(int size) {
  const int count = std::clamp(size / rows_a_block, 1, most_blocks);
  std::vector<RowBlock> blocks;
  int begin = 0;
  for (int b = 1; b <= count; ++b) {
    // entries up to row r: r^2 / 2
    const int bound = static_cast<int>(size * std::sqrt(static_cast<double>(b) / count));
    const int end = b == count ? size : bound / 8 * 8;
    if (end > begin) blocks.push_back({begin, end});
    begin = end;
  }
  return blocks;
}

void symmetric_product(const ExchangeMatrix& matrix, const double* x, double* y, int columns) {
  const std::vector<RowBlock> blocks = row_blocks(matrix.size());
  for (int first = 0; first < columns; first += columns_a_pass) {
    one_pass(matrix, blocks, x, y, columns, first, std::min(columns_a_pass, columns - first));
  }
}

}  // namespace luxel
#endif
