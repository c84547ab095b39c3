#include "luxel/read_scene.h"

#include <algorithm>
#include <utility>

#include "scene/mesh_formats.h"
#include "scene/scene_assembly.h"
#include "scene/scene_file.h"

namespace luxel {
namespace {

constexpr std::string_view scene_file_extension = ".json";

SceneDescription description_of(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  if (extension == scene_file_extension) return read_scene_file(file);
  const std::vector<std::string> known = scene_extensions();
  if (std::find(known.begin(), known.end(), extension) == known.end()) refuse_extension(file, known);
  SceneDescription description;
  description.file = file;
  description.meshes.push_back({.file = file});
  return description;
}

}  // namespace

Scene read_scene(const std::filesystem::path& file, const ReadOptions& options) {
  const SceneDescription description = description_of(file);
  std::vector<SurfaceSoup> soups;
  for (const MeshPlacement& mesh : description.meshes) soups.push_back(read_mesh(mesh.file, options));
  return assembled(merged(std::move(soups), description.meshes), description);
}

std::vector<std::string> scene_extensions() {
  std::vector<std::string> extensions{std::string(scene_file_extension)};
  for (const MeshFormat& format : mesh_formats()) extensions.emplace_back(format.extension);
  return extensions;
}

}  // namespace luxel
