#pragma once

#include <vector>

#include "merged_polygons.h"

namespace luxel {

/// Two flat polygons that lie in one plane and have a part of it in common.
struct OverlappingPair {
  int first, second;  ///< first <= second; equal: a polygon that lies over itself
  bool opposed;       ///< whether their fronts look in opposite directions
};

/// Every pair of polygons that overlap, by first and second. Parts in common that are narrower than the
/// distance within which a vertex lies on an edge do not count. Polygons that only touch are dismissed by
/// their planes and boxes. Cost: linear, n log n in what lies in one plane; about 30 ns a polygon.
std::vector<OverlappingPair> find_overlapping(const std::vector<Vec3>& vertices,
                                              const MergedPolygons& merged);

}  // namespace luxel
