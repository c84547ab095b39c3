#pragma once

#include <vector>

#include "facets.h"
#include "luxel/patch_mesh.h"

namespace luxel {

/// What blocks light, and where each facet is in it.
struct FacetOccluders {
  Occluders occluders;
  std::vector<int> polygon_of_facet;
};

/// The facets as occluders.
FacetOccluders make_occluders(const Facets& facets);

}  // namespace luxel
