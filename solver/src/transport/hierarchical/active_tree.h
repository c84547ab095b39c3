#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "transport/hierarchical/block_list.h"
#include "transport/hierarchical/patch_hierarchy.h"

namespace luxel {

/// A cluster or single patch that some block, or a block of a cluster inside, reaches, or that completes its
/// parent.
struct ActiveNode {
  int cluster = 0;  ///< number in the hierarchy
  int parent = -1;
  int first_child = 0, child_count = 0;  ///< in ActiveTree::nodes; none: the light of this node is an unknown
  int unknown = -1;  ///< of a node without children: its first row; four rows, or one where single
  bool single = false;
};

/// The part of the hierarchy that light goes through, level by level: parents before children, children of
/// one node together.
struct ActiveTree {
  std::vector<ActiveNode> nodes;
  std::vector<int> levels;                      ///< begin of each level in `nodes`, and the end
  std::vector<std::array<float, 16>> transfer;  ///< [4 z + a]: the parent's function a at node z; of a single
                                                ///< patch at its centroid, in the first four
  std::vector<int> number;  ///< of hierarchy clusters and single patches: their place in `nodes`, or -1
  int unknowns = 0;
};

/// The smallest tree over all blocks whose ends without children have one finish and one enclosure.
ActiveTree active_tree(const PatchHierarchy& hierarchy, const std::vector<BlockList>& blocks);

}  // namespace luxel
