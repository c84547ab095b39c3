#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "transport/hierarchical/active_tree.h"
#include "transport/hierarchical/block_list.h"

namespace luxel {

/// Irradiance at the unknowns of a tree from the radiosity there, by its blocks: light is summed up the tree,
/// exchanged between the ends of the blocks, and interpolated down. Immutable and safe from many threads.
class BlockProduct {
 public:
  /// Takes the lists, whose ends are numbers of the hierarchy.
  /// @param areas  of the unknowns, working units
  BlockProduct(ActiveTree tree, std::vector<BlockList> lists, std::vector<double> areas);

  /// y = H from x = B, unknowns x columns, row-major. Sums have a fixed order: the same bits for any number
  /// of threads. Symmetric: areas() times H is G B with G = G^T.
  void apply(const double* x, double* y, int columns) const;

  /// Of each unknown, working units.
  const std::vector<double>& areas() const { return areas_; }
  const ActiveTree& tree() const { return tree_; }
  std::size_t bytes() const;

 private:
  template <int columns>
  void apply_columns(const double* x, double* y, int stride) const;

  ActiveTree tree_;
  std::vector<BlockList> lists_;    // ends are numbers of the tree's nodes
  std::vector<std::size_t> parts_;  // begins of runs of lists, and the end: each run has sums of its own
  std::vector<double> areas_;
};

}  // namespace luxel
