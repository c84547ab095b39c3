#pragma once

#include <vector>

#include "flat_polygons.h"

namespace luxel {

/// Polygons that may lie in one plane, whichever way they look: group g has members[offsets[g] ..
/// offsets[g + 1]), ascending, two or more. Polygons of one plane share at least one group, and may share
/// several.
struct PlaneGroups {
  std::vector<int> offsets{0};
  std::vector<int> members;

  int size() const { return static_cast<int>(offsets.size()) - 1; }
};

/// Sorts planes into cells of direction and distance. Cost: linear but for what shares a cell.
PlaneGroups group_by_plane(const std::vector<Frame>& frames, const Vec3& centre, double size);

}  // namespace luxel
