#include "factors/factor_bands.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace luxel {

namespace {

// Rows together: their pieces of the other half are then 256 bytes or more, whole cache lines.
constexpr int rows_a_band = 64;

template <class Real>
void fill(const DenseOperator& transport, FactorBand& band) {
  const ExchangeMatrix& matrix = *transport.entries();
  const std::size_t columns = band.columns;
  const int end = band.first + band.rows;
  std::fill(band.values.begin(), band.values.end(), 0.0);
  for (int i = band.first; i < end; ++i) {
    const Real* row = matrix.row<Real>(i);
    double* to = &band.values[(i - band.first) * columns];
    std::copy(row, row + i, to);
    to[i] = transport.diagonal()[i];
    for (int j = band.first; j < i; ++j) band.values[(j - band.first) * columns + i] = row[j];
  }
  tbb::parallel_for(tbb::blocked_range<int>(end, band.columns, 256),
                    [&](const tbb::blocked_range<int>& range) {
                      for (int j = range.begin(); j < range.end(); ++j) {
                        const Real* row = matrix.row<Real>(j) + band.first;
                        for (int k = 0; k < band.rows; ++k) band.values[k * columns + j] = row[k];
                      }
                    });
  for (int k = 0; k < band.rows; ++k) {
    const double area = transport.areas()[band.first + k];
    for (std::size_t j = 0; j < columns; ++j) band.values[k * columns + j] /= area;
  }
}

}  // namespace

void for_each_band(const DenseOperator& transport, const std::function<void(const FactorBand&)>& visit) {
  FactorBand band;
  band.columns = transport.size();
  for (band.first = 0; band.first < transport.size(); band.first += rows_a_band) {
    band.rows = std::min(rows_a_band, transport.size() - band.first);
    band.values.resize(static_cast<std::size_t>(band.rows) * band.columns);
    if (transport.entries()->precision() == Precision::float32) {
      fill<float>(transport, band);
    } else {
      fill<double>(transport, band);
    }
    visit(band);
  }
}

std::vector<std::int64_t> entries_by_row(const DenseOperator& transport) {
  std::vector<std::int64_t> counts(transport.size(), 0);
  for_each_band(transport, [&](const FactorBand& band) {
    for (int k = 0; k < band.rows; ++k) {
      const auto row = band.row(k);
      counts[band.first + k] = std::count_if(row.begin(), row.end(), [](double f) { return f != 0; });
    }
  });
  return counts;
}

}  // namespace luxel
