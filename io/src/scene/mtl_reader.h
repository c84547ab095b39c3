#pragma once

#include <filesystem>
#include <string_view>

#include "luxel/read_scene.h"
#include "scene/surface_soup.h"

namespace luxel {

/// Appends the materials of an MTL file to soup.stated: `Kd` as reflectance, `Ke` as emission. Of materials
/// with one name the first counts, with a warning; so is told what the file says beyond that.
/// @throws InputError if `Kd` is not in [0, 1], `Ke` is negative, or a statement cannot be read.
void read_mtl(const std::filesystem::path& file, EmissionUnit emission_unit, SurfaceSoup& soup);

/// The number of the finish stated under this name; where there is none, an empty one is appended.
int stated_finish(SurfaceSoup& soup, std::string_view name);

}  // namespace luxel
