#pragma once

#include <optional>

#include "edge_table.h"
#include "facets.h"
#include "luxel/patch_mesh.h"

namespace luxel {

/// Facets with every vertex that lies on another facet's edge made a corner there too.
struct RepairedFacets {
  Facets facets;
  int repaired = 0;  ///< corners that were added
};

/// Nothing where no vertex lies on an edge. `edges` are those of the facets.
std::optional<RepairedFacets> repair_t_junctions(const Facets& facets, const EdgeTable& edges);

/// Vertices of the mesh strictly inside an edge that only one patch has: gaps between neighbours.
int count_t_vertices(const PatchMesh& mesh);

}  // namespace luxel
