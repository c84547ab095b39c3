#pragma once

#include <vector>

#include "luxel/scene.h"
#include "scene/scene_description.h"
#include "scene/surface_soup.h"

namespace luxel {

/// One soup of all of them, in their order, each moved by the transform of its placement; groups and
/// materials of one name become one. A transform that mirrors turns the faces' order round, so that their
/// fronts stay fronts.
SurfaceSoup merged(std::vector<SurfaceSoup> soups, const std::vector<MeshPlacement>& placements);

/// The scene: lengths in metres, and for each face the finish that follows from "surfaces" before "materials"
/// before the mesh file, key by key; what nobody states is reflectance 0.5, no emission, one side.
/// @throws InputError for a rule whose name the mesh does not have, or that spreads power over no area.
Scene assembled(SurfaceSoup soup, const SceneDescription& description);

}  // namespace luxel
