#include "scene/scene_assembly.h"

#include <cmath>
#include <limits>
#include <utility>

#include "scene/finish_rules.h"
#include "scene/input_location.h"
#include "scene/name_table.h"

namespace luxel {
namespace {

// Products of four lengths must not overflow; [m], far beyond anything that has a shape.
constexpr double longest_length = 1e60;

void transform_in_place(SurfaceSoup& soup, const Eigen::Affine3d& transform) {
  for (Vec3& vertex : soup.vertices) vertex = transform * vertex;
  if (transform.linear().determinant() > 0) return;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    std::reverse(soup.face_vertices.begin() + soup.face_offsets[f] + 1,
                 soup.face_vertices.begin() + soup.face_offsets[f + 1]);
  }
}

void append(SurfaceSoup& all, SurfaceSoup&& part, NameTable& groups, NameTable& materials) {
  const auto first_vertex = static_cast<int>(all.vertices.size());
  const int first_corner = all.face_offsets.back();
  const auto first_stated = static_cast<int>(all.stated.size());
  all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const int vertex : part.face_vertices) all.face_vertices.push_back(first_vertex + vertex);
  for (std::size_t f = 0; f < part.face_count(); ++f) {
    all.face_offsets.push_back(first_corner + part.face_offsets[f + 1]);
    all.face_groups.push_back(groups.number(part.groups[part.face_groups[f]]));
    all.face_materials.push_back(materials.number(part.materials[part.face_materials[f]]));
    all.face_stated.push_back(first_stated + part.face_stated[f]);
  }
  std::move(part.stated.begin(), part.stated.end(), std::back_inserter(all.stated));
  std::move(part.warnings.begin(), part.warnings.end(), std::back_inserter(all.warnings));
}

void check_lengths(const std::vector<Vec3>& vertices, const std::filesystem::path& file) {
  for (const Vec3& vertex : vertices) {
    if (!(vertex.cwiseAbs().maxCoeff() <= longest_length)) {
      refuse({file}, "a vertex further than 1e60 m from the origin; expected lengths that can be squared");
    }
  }
}

}  // namespace

SurfaceSoup merged(std::vector<SurfaceSoup> soups, const std::vector<MeshPlacement>& placements) {
  std::size_t corners = 0, vertices = 0;
  for (std::size_t i = 0; i < soups.size(); ++i) {
    if (!placements[i].transform.matrix().isIdentity(0))
      transform_in_place(soups[i], placements[i].transform);
    corners += soups[i].face_vertices.size();
    vertices += soups[i].vertices.size();
  }
  if (std::max(corners, vertices) > std::numeric_limits<int>::max()) {
    refuse({placements.back().file}, "more than 2^31 face corners in all meshes together");
  }
  if (soups.size() == 1) return std::move(soups.front());

  SurfaceSoup all;
  NameTable groups, materials;
  for (SurfaceSoup& soup : soups) append(all, std::move(soup), groups, materials);
  all.groups = groups.names();
  all.materials = materials.names();
  return all;
}

Scene assembled(SurfaceSoup soup, const SceneDescription& description) {
  Scene scene;
  scene.file = description.file.string();
  scene.camera = description.camera;
  if (description.unit != 1) {
    for (Vec3& vertex : soup.vertices) vertex *= description.unit;
    if (scene.camera) {
      scene.camera->eye *= description.unit;
      scene.camera->target *= description.unit;
    }
  }
  check_lengths(soup.vertices, description.file);
  Finishes finishes = resolved_finishes(soup, description);
  scene.vertices = std::move(soup.vertices);
  scene.face_offsets = std::move(soup.face_offsets);
  scene.face_vertices = std::move(soup.face_vertices);
  scene.face_groups = std::move(soup.face_groups);
  scene.face_materials = std::move(soup.face_materials);
  scene.groups = std::move(soup.groups);
  scene.materials = std::move(soup.materials);
  scene.face_finishes = std::move(finishes.of_face);
  scene.finishes = std::move(finishes.table);
  scene.warnings = std::move(soup.warnings);
  std::move(finishes.warnings.begin(), finishes.warnings.end(), std::back_inserter(scene.warnings));
  return scene;
}

}  // namespace luxel
