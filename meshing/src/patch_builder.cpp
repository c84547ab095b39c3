#include "patch_builder.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "corner_positions.h"
#include "polygon.h"

namespace luxel {

namespace {

// Patches that a thread takes at a time, at least.
constexpr int patches_per_task = 2048;

}  // namespace

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
  std::ranges::copy(corners, row.begin());
  mesh.corners.push_back(row);
  mesh.faces.push_back(face);
  mesh.groups.push_back(scene.face_groups[face]);
  mesh.materials.push_back(scene.face_materials[face]);
  mesh.finishes.push_back(scene.face_finishes[face]);
  mesh.polygons.push_back(polygon);
}

void measure_patches(PatchMesh& mesh) {
  mesh.normals.resize(mesh.size());
  mesh.centroids.resize(mesh.size());
  mesh.areas.resize(mesh.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, mesh.size(), patches_per_task), [&](const auto& range) {
    CornerPositions positions(mesh.vertices);
    for (int i = range.begin(); i < range.end(); ++i) {
      const std::span<const Vec3> points = positions(std::span(mesh.corners[i]).first(mesh.corner_count(i)));
      const Vec3 area = area_vector(points);
      mesh.normals[i] = area.normalized();
      mesh.centroids[i] = area_centroid(points, area);
      mesh.areas[i] = area.norm();
    }
  });
}

void reserve_patches(PatchMesh& mesh, std::size_t count) {
  mesh.corners.reserve(count);
  mesh.faces.reserve(count);
  mesh.groups.reserve(count);
  mesh.materials.reserve(count);
  mesh.finishes.reserve(count);
  mesh.polygons.reserve(count);
}

}  // namespace luxel
