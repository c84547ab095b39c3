#pragma once

#include <vector>

#include "convex_clip.h"

namespace luxel {

/// Gives corners that clipping made the vertices that they coincide with, within `distance` [m]: of those
/// known, else of earlier corners; new ones are added to `vertices`. Cost: n log n in corners and known
/// vertices.
void place_corners(const std::vector<ClipCorner*>& corners, const std::vector<int>& known, double distance,
                   std::vector<Vec3>& vertices);

}  // namespace luxel
