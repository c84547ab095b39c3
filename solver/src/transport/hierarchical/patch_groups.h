#pragma once

#include <vector>

#include "transport/hierarchical/patch_hierarchy.h"

namespace luxel {

/// Fills order, group and groups: patches of one polygon, side, finish and enclosure together, in the order
/// of their first patches. Cost: O(N).
void gather_flat_groups(PatchHierarchy& hierarchy, const Enclosures& enclosures);

}  // namespace luxel
