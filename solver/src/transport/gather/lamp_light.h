#pragma once

#include "transport/gather/lamps.h"
#include "transport/gather/patch_frame.h"

namespace luxel {

/// Whether any point of the patch can face any of the lamp.
bool faces(const PatchFrame& patch, const Lamp& lamp);

/// Mean of a lamp's unoccluded form factor over a patch.
/// @param area  of the patch in the ray scene's coordinates
double unoccluded(const PatchFrame& patch, double area, const Lamp& lamp);

}  // namespace luxel
