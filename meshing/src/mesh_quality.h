#pragma once

#include "facets.h"
#include "luxel/patch_mesh.h"

namespace luxel {

/// Fills what the report says about angles, aspect and area: measured on the patches and on the facets that
/// they were made from, less what was cut away of them [m2].
void measure_quality(PatchMesh& mesh, const Facets& facets, double cut_area);

}  // namespace luxel
