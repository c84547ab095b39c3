#pragma once

#include "facets.h"
#include "luxel/patch_mesh.h"

namespace luxel {

/// The facets with every vertex that lies on another facet's edge made a corner there too.
struct RepairedFacets {
  Facets facets;
  int repaired = 0;  ///< corners that were added
};

RepairedFacets repair_t_junctions(const Facets& facets);

/// Vertices of the mesh strictly inside an edge that only one patch has: gaps between neighbours.
int count_t_vertices(const PatchMesh& mesh);

/// Distance within which a vertex lies on an edge [m].
double touching_distance(const std::vector<Vec3>& vertices);

}  // namespace luxel
