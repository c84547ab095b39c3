#pragma once

#include <filesystem>

#include "luxel/read_scene.h"
#include "scene/surface_soup.h"

namespace luxel {

/// A stereolithography file, text or binary; the group is the name of its solid. The front of a triangle
/// follows from the order of its corners; the normals of the file are not used.
/// @throws InputError if it is cut off or has a coordinate that is not a finite number.
SurfaceSoup read_stl(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace luxel
