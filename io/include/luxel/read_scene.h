#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "luxel/scene.h"

namespace luxel {

/// What the emission numbers of a mesh file (MTL `Ke`, glTF emissive) mean.
enum class EmissionUnit {
  Radiance,  ///< radiance L [W/(m2 sr)]: E = pi L
  Exitance,  ///< exitance E [W/m2]
};

struct ReadOptions {
  EmissionUnit emission_unit = EmissionUnit::Radiance;  ///< of mesh files; a scene file always states its own
};

/// The scene in `file`, a mesh or a scene file, by its extension (see scene_extensions()). Every number of
/// the result is finite, every index in range, every reflectance in [0, 1], every length in metres; what the
/// file says and Luxel does not use is counted in Scene::warnings. Emission of a mesh file is read in
/// options.emission_unit. The format of scene files: docs/scenes.md.
/// Cost: about 0.2 CPU seconds for an OBJ file of a million triangles.
/// @throws InputError if the file or one that it names cannot be read; one line that names file, line and
/// item.
Scene read_scene(const std::filesystem::path& file, const ReadOptions& options = {});

/// The extensions that read_scene() knows, with their dot, in lower case (capitals are read as well).
std::vector<std::string> scene_extensions();

}  // namespace luxel
