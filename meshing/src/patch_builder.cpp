#include "patch_builder.h"

#include "polygon.h"

namespace luxel {

PatchMesh empty_mesh(const Scene& scene) {
  PatchMesh mesh;
  mesh.file = scene.file;
  mesh.group_names = scene.groups;
  mesh.material_names = scene.materials;
  mesh.finish_table = scene.finishes;
  mesh.camera = scene.camera;
  mesh.warnings = scene.warnings;
  return mesh;
}

void append_patch(PatchMesh& mesh, const Scene& scene, std::span<const int> corners, int face, int polygon) {
  std::array<int, 4> row = {-1, -1, -1, -1};
  std::array<Vec3, 4> storage;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    row[k] = corners[k];
    storage[k] = mesh.vertices[corners[k]];
  }
  const std::span<const Vec3> points = std::span(storage).first(corners.size());
  const Vec3 area = area_vector(points);
  mesh.corners.push_back(row);
  mesh.normals.push_back(area.normalized());
  mesh.centroids.push_back(area_centroid(points, area));
  mesh.areas.push_back(area.norm());
  mesh.faces.push_back(face);
  mesh.groups.push_back(scene.face_groups[face]);
  mesh.materials.push_back(scene.face_materials[face]);
  mesh.finishes.push_back(scene.face_finishes[face]);
  mesh.polygons.push_back(polygon);
}

void reserve_patches(PatchMesh& mesh, std::size_t count) {
  mesh.corners.reserve(count);
  mesh.normals.reserve(count);
  mesh.centroids.reserve(count);
  mesh.areas.reserve(count);
  mesh.faces.reserve(count);
  mesh.groups.reserve(count);
  mesh.materials.reserve(count);
  mesh.finishes.reserve(count);
  mesh.polygons.reserve(count);
}

}  // namespace luxel
