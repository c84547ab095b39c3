#pragma once

#include <vector>

#include "form_factors/block_kernels.h"
#include "form_factors/cluster_tree.h"
#include "luxel/exchange_matrix.h"

namespace luxel {

/// Writes tiles of exchange areas, computed in tree order and working units, to their places in the matrix.
/// Negative values, which are rounding of grazing pairs, become 0. Different pairs may be written from
/// different threads.
class MatrixWriter {
 public:
  MatrixWriter(const ClusterTree& tree, ExchangeMatrix& matrix);

  /// One pair of patches in tree order.
  void write(int s, int t, double value) const;

  /// Rows [i0, i1) and columns [j0, j1) of a tile. Returns the sum of the values.
  double write(const Tile& tile, int i0, int i1, int j0, int j1) const;

 private:
  template <class Real>
  double write_tile(const Tile& tile, int i0, int i1, int j0, int j1) const;

  ExchangeMatrix& matrix_;
  double factor_;
  std::vector<int> patches_;  // tree order to mesh order
};

}  // namespace luxel
