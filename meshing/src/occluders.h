#pragma once

#include <vector>

#include "edge_table.h"
#include "facets.h"
#include "luxel/patch_mesh.h"
#include "overlapping_polygons.h"
#include "regions.h"

namespace luxel {

/// What blocks light, and where each facet is in it.
struct FacetOccluders {
  Occluders occluders;
  std::vector<int> polygon_of_facet;
  Regions regions;  ///< coplanar facets, coincident ones each for themselves; none without overlaps
  std::vector<OverlappingPair> overlaps;  ///< regions that lie over each other
};

/// Coplanar facets merged into polygons, whatever their materials, and cut into triangles. The merged surface
/// has no gap that the facets did not have; polygons that coincide, from either side, stand once. `edges` are
/// those of the facets. Cost: n log n.
FacetOccluders make_occluders(const Facets& facets, const EdgeTable& edges);

}  // namespace luxel
