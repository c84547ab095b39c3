#pragma once

#include <vector>

#include "form_factors/polygon.h"

namespace luxel {

/// Patches of one plane, in ascending order, and the plane: the area-weighted fit of their corners.
struct CoplanarGroup {
  Plane plane;
  std::vector<int> members;
};

/// Gathers patches that lie in one plane and face the same side. Each group grows around its largest patch:
/// a patch belongs when all its corners lie within `tolerance` times the lever arm of that patch's plane, so
/// that nothing depends on where the borders of bins fall, and groups do not drift. Order: by largest area.
/// Cost: O(N log N) on meshes whose planes are spread, O(N x planes within the tolerance) at worst.
std::vector<CoplanarGroup> coplanar_groups(const std::vector<WorkPatch>& patches, double tolerance);

}  // namespace luxel
