#pragma once

#include "facets.h"
#include "luxel/patch_mesh.h"

namespace luxel {

/// One patch per facet and radiating side, in the order of the faces: all front pieces of a face, then all
/// back pieces. Facets that are no triangle or convex quad are cut into triangles.
void append_facets(PatchMesh& mesh, const Scene& scene, const Facets& facets,
                   const std::vector<int>& polygon_of_facet);

/// How many patches append_facets() would make at most, without making them.
std::size_t count_patches(const Facets& facets);

}  // namespace luxel
