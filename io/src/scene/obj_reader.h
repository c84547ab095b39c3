#pragma once

#include <filesystem>

#include "luxel/read_scene.h"
#include "scene/surface_soup.h"

namespace luxel {

/// A Wavefront OBJ file with the material libraries that it names. Polygons are kept as they are.
/// Group: the current `g` name, else `o`; material: the `usemtl` name, whether or not a library defines it.
/// A library that is missing is a warning. Cost: one pass over the text.
/// @throws InputError on the first statement that cannot be read, with its line.
SurfaceSoup read_obj(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace luxel
