#pragma once

#include <span>
#include <vector>

#include "transport/hierarchical/patch_hierarchy.h"

namespace luxel {

/// A patch in the axes of its group, and what its area's moments are.
struct FlatPatch {
  int patch = 0;
  double s = 0, t = 0;                    ///< of the centroid
  double area = 0;                        ///< working units
  double ss = 0, st = 0, tt = 0;          ///< second moments about the centroid over the area
  double s0 = 0, s1 = 0, t0 = 0, t1 = 0;  ///< least and most of the corners
};

FlatPatch flat_patch(const PatchMesh& mesh, int patch, const WorkingFrame& frame, const FlatGroup& group);

/// Axes and weights of one or more patches' nodes, and their box and sphere; children are not set.
/// The weights of more than one follow the patches' centroids, as interpolation to these does.
PatchCluster flat_cluster(std::span<const FlatPatch> patches, const FlatGroup& group);

/// Adds clusters to others; numbers of parents and children count from the first cluster of either.
void append(std::vector<PatchCluster>& clusters, const std::vector<PatchCluster>& more);

/// The tree over the patches of one group, at least two; children's numbers count from the first cluster of
/// the result, and single patches are -2 - k for patches[k]. Permutes the patches into the tree's order.
std::vector<PatchCluster> flat_tree(std::span<FlatPatch> patches, const FlatGroup& group);

}  // namespace luxel
