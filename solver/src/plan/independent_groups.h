#pragma once

#include <vector>

#include "luxel/enclosures.h"
#include "luxel/patch_mesh.h"

namespace luxel {

/// Sets of patches between which no light can go.
struct PatchGroups {
  std::vector<std::vector<int>> patches;  ///< of each group, rising; groups by their first patch
  std::vector<char> closed;               ///< the group is one closed enclosure
};

/// Closed enclosures are groups by themselves. Between open ones rays may have missed what little they see of
/// each other, so that these are joined unless their patches provably turn away from each other: what stands
/// between them is not looked at. Cost: linear; where there is more than one open enclosure, pairs of
/// clusters that may face.
PatchGroups independent_groups(const PatchMesh& mesh, const Enclosures& enclosures);

}  // namespace luxel
