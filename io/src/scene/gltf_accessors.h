#pragma once

#include <filesystem>
#include <vector>

#include "luxel/vector.h"
#include "scene/gltf_file.h"

namespace luxel {

/// The positions that an accessor of a model names, every number finite.
/// @throws InputError if there are none, they are not three floats each, or reach beyond their buffer.
std::vector<Vec3> gltf_positions(const tinygltf::Model& model, int accessor,
                                 const std::filesystem::path& file);

/// The indices that an accessor names, each below `limit`. @throws InputError likewise.
std::vector<int> gltf_indices(const tinygltf::Model& model, int accessor, std::size_t limit,
                              const std::filesystem::path& file);

}  // namespace luxel
