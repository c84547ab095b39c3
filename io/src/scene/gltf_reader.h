#pragma once

#include <filesystem>

#include "luxel/read_scene.h"
#include "scene/surface_soup.h"

namespace luxel {

/// The default scene of a glTF 2.0 file, `.gltf` or `.glb`: its triangles, each node with its transform.
/// Group: the node's name, else its mesh's. Material: base colour factor as reflectance, emissive factor
/// times KHR_materials_emissive_strength as emission, `doubleSided` as two-sided. Textures are not used.
/// @throws InputError if it cannot be read, asks for an extension that is not known, or has numbers out of
/// range.
SurfaceSoup read_gltf(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace luxel
