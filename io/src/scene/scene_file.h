#pragma once

#include <filesystem>

#include "scene/scene_description.h"

namespace luxel {

/// A scene file (docs/scenes.md). Its meshes are named, not read; their paths are relative to it.
/// @throws InputError with file and line for an unknown key, naming the nearest, and for every value that is
/// of the wrong kind or out of range.
SceneDescription read_scene_file(const std::filesystem::path& file);

}  // namespace luxel
