#include "form_factors/matrix_writer.h"

#include <algorithm>
#include <numeric>

namespace luxel {

MatrixWriter::MatrixWriter(const ClusterTree& tree, ExchangeMatrix& matrix)
    : matrix_(matrix), factor_(1 / (tree.scale * tree.scale)) {
  patches_.reserve(tree.patches.size());
  for (const WorkPatch& patch : tree.patches) patches_.push_back(patch.patch);
}

void MatrixWriter::write(int s, int t, double value) const {
  matrix_.set(patches_[s], patches_[t], std::max(value, 0.0) * factor_);
}

double MatrixWriter::write(const Tile& tile, int i0, int i1, int j0, int j1) const {
  return matrix_.precision() == Precision::float32 ? write_tile<float>(tile, i0, i1, j0, j1)
                                                   : write_tile<double>(tile, i0, i1, j0, j1);
}

template <class Real>
double MatrixWriter::write_tile(const Tile& tile, int i0, int i1, int j0, int j1) const {
  const int* rows = patches_.data() + i0;
  const int* columns = patches_.data() + j0;
  const int height = i1 - i0, width = j1 - j0;
  const auto [first_row, last_row] = std::minmax_element(rows, rows + height);
  const auto [first_column, last_column] = std::minmax_element(columns, columns + width);
  Real areas[Tile::rows][Tile::columns];
  // As many sums as a vector has lanes: no chain of dependent additions.
  constexpr int lanes = 8;
  double sums[lanes] = {};
  for (int i = 0; i < height; ++i) {
    const double* values = tile.values + i * Tile::columns;
    int j = 0;
    for (; j + lanes <= width; j += lanes) {
      for (int l = 0; l < lanes; ++l) {
        const double area = (values[j + l] > 0 ? values[j + l] : 0) * factor_;
        sums[l] += area;
        areas[i][j + l] = static_cast<Real>(area);
      }
    }
    for (; j < width; ++j) {
      const double area = (values[j] > 0 ? values[j] : 0) * factor_;
      sums[0] += area;
      areas[i][j] = static_cast<Real>(area);
    }
  }
  if (*first_row > *last_column) {
    for (int i = 0; i < height; ++i) {
      Real* row = matrix_.row<Real>(rows[i]);
      for (int j = 0; j < width; ++j) row[columns[j]] = areas[i][j];
    }
  } else if (*last_row < *first_column) {
    for (int j = 0; j < width; ++j) {
      Real* row = matrix_.row<Real>(columns[j]);
      for (int i = 0; i < height; ++i) row[rows[i]] = areas[i][j];
    }
  } else {
    for (int i = 0; i < height; ++i) {
      for (int j = 0; j < width; ++j) {
        const auto [low, high] = std::minmax(rows[i], columns[j]);
        matrix_.row<Real>(high)[low] = areas[i][j];
      }
    }
  }
  return std::accumulate(sums, sums + lanes, 0.0);
}

}  // namespace luxel
