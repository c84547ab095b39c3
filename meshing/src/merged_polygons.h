#pragma once

#include "flat_polygons.h"

namespace luxel {

/// Facets merged into flat polygons with holes, and those cut into triangles.
struct MergedPolygons {
  std::vector<Vec3> areas;  ///< of the facets: area vectors [m2]
  Regions regions;          ///< polygon p is region p
  FlatPolygons polygons;
  std::vector<std::vector<std::array<int, 3>>> triangles;  ///< for each polygon, over the facets' vertices
};

/// Merges facets across edges where may_join(facet, facet) allows it. A region whose border crosses itself
/// keeps its facets' triangles and all their vertices. `edges` are those of the facets. Cost: n log n.
MergedPolygons merge_facets(const Facets& facets, const EdgeTable& edges,
                            const std::function<bool(int, int)>& may_join);

}  // namespace luxel
