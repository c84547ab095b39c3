#pragma once

#include <filesystem>

#include "luxel/read_scene.h"
#include "scene/surface_soup.h"

namespace luxel {

/// A Stanford PLY file, text or binary of either byte order. Properties of faces named `reflectance` or
/// `reflectance_r`, `_g`, `_b`, and likewise `emission`, are read as Luxel's own: exitance [W/m2] whatever
/// the option says. Colours are for display and not used.
/// @throws InputError on the first line or element that cannot be read.
SurfaceSoup read_ply(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace luxel
