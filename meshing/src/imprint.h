#pragma once

#include <array>
#include <vector>

#include "merged_polygons.h"

namespace luxel {

/// For each polygon the edges of other polygons that lie inside it: where a block or a wall stands on it.
/// Edges that cross the polygon's border, or one another, are left out. Cost: n log n, and quadratic in the
/// edges found in one polygon.
std::vector<std::vector<std::array<int, 2>>> find_contact_edges(const std::vector<Vec3>& vertices,
                                                                const MergedPolygons& merged,
                                                                const std::vector<char>& wanted);

}  // namespace luxel
