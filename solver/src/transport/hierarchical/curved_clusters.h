#pragma once

#include "transport/hierarchical/patch_hierarchy.h"

namespace luxel {

/// Cluster and what it needs in addition for the patches order[begin] .. order[end - 1] of the groups
/// [first_group, last_group), which need not lie in one plane; children are not set. Cost: O(groups), and
/// O(end - begin) where the patches look about the same way.
PatchCluster curved_cluster(const PatchHierarchy& hierarchy, int begin, int end, int first_group,
                            int last_group, CurvedCluster& curved);

}  // namespace luxel
