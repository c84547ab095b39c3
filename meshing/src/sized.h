#pragma once

#include "edge_table.h"
#include "facets.h"
#include "luxel/mesh_scene.h"

namespace luxel {

/// Fills the facets' flat polygons and curved parts with patches of the size that the options ask for, and
/// fills the report's figures about it. `facets` are repaired: a vertex that lies on an edge is a corner
/// there; `edges` are theirs. Front patches of a polygon come before its back patches; polygons stand in the
/// order of their first face.
void append_sized(PatchMesh& mesh, const Scene& scene, const Facets& facets, const EdgeTable& edges,
                  const std::vector<int>& polygon_of_facet, const MeshingOptions& options,
                  const Progress& progress);

}  // namespace luxel
