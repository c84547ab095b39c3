#pragma once

#include "transport/hierarchical/patch_hierarchy.h"

namespace luxel {

/// Cluster and what it needs in addition for patches order[begin] .. order[end - 1] that need not lie in one
/// plane; children are not set. Cost: O(end - begin).
PatchCluster curved_cluster(const PatchHierarchy& hierarchy, int begin, int end, CurvedCluster& curved);

}  // namespace luxel
