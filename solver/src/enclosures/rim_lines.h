#pragma once

#include <vector>

#include "enclosures/shells.h"
#include "enclosures/triangle_soup.h"
#include "enclosures/union_find.h"
#include "luxel/patch_mesh.h"
#include "luxel/ray_scene.h"
#include "patch_locator.h"

namespace luxel {

/// Looks through the openings that rims may leave, however small: lines through points beside each rim, a
/// hair and a third of its length off the sheet, in many directions. Two patches at the ends of a line see
/// each other and are joined in `sets`; a patch opposite nothing, or a back, is marked in the result (N
/// flags): its enclosure is not closed. Openings are found down to 8e-7 of the diagonal. Cost: 96 rays a rim.
std::vector<char> look_through_rims(const PatchMesh& mesh, const TriangleSoup& soup,
                                    const std::vector<Rim>& rims, const RayScene& scene,
                                    const PatchLocator& locator, UnionFind& sets);

}  // namespace luxel
