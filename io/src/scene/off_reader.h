#pragma once

#include <filesystem>

#include "luxel/read_scene.h"
#include "scene/surface_soup.h"

namespace luxel {

/// A text file of the Object File Format (OFF, COFF, NOFF, CNOFF). A face's colour, r g b as fractions or of
/// 255, is its reflectance; colours and normals of vertices are not used.
/// @throws InputError on the first line that cannot be read.
SurfaceSoup read_off(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace luxel
