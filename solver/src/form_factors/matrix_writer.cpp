#include "form_factors/matrix_writer.h"

#include <algorithm>

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
  double sum = 0;
  for (int i = 0; i < height; ++i) {
    const double* values = tile.values + i * Tile::columns;
    const int row = rows[i];
    Real* below = matrix_.row<Real>(row);
    for (int j = 0; j < width; ++j) {
      const double value = std::max(values[j], 0.0) * factor_;
      const int column = columns[j];
      sum += value;
      Real* entry = column < row ? below + column : matrix_.row<Real>(column) + row;
      *entry = static_cast<Real>(value);
    }
  }
  return sum;
}

}  // namespace luxel
