#pragma once

#include <cstddef>
#include <vector>

#include "form_factors/cluster_tree.h"
#include "luxel/exchange_matrix.h"
#include "luxel/patch_mesh.h"

namespace luxel {

/// Exchange areas between whole groups with nothing between, in working units, but at least a given factor
/// times the smaller group's area. Cost: one pass over the matrix, and groups^2 numbers.
class GroupExchange {
 public:
  GroupExchange() = default;
  GroupExchange(const PatchMesh& mesh, const ClusterTree& tree, const ExchangeMatrix& unhidden,
                double least_factor);

  bool empty() const { return sums_.empty(); }

  /// Between the groups of two patches in tree order.
  double at(int s, int t) const {
    return sums_[static_cast<std::size_t>(group_[s]) * count_ + static_cast<std::size_t>(group_[t])];
  }

 private:
  std::vector<int> group_;  // of each patch in tree order
  std::size_t count_ = 0;
  std::vector<double> sums_;
};

}  // namespace luxel
