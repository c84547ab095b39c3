#pragma once

#include "luxel/patch_mesh.h"

namespace luxel {

/// The mesh in a box whose sides, cut into quads that face inwards, stand for the sky: they come after the
/// mesh's own patches, hide nothing and are a group of their own. What a patch exchanges with them is what of
/// its view the scene leaves free, up to rounding wherever the box is. They are some hundredth of the
/// patches.
PatchMesh in_sky_box(const PatchMesh& mesh);

/// How many quads that sky has for so many patches.
int sky_quads(int patches);

}  // namespace luxel
