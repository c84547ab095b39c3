#include "form_factors/sky_box.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace luxel {

namespace {

// The box keeps this share of the scene's diagonal off it: near, so that shafts are narrow, and far enough
// for no side to be an edge away from a patch.
constexpr double margin = 0.2;

// Sides are cut into so many quads each way, such that one quad comes to some hundred patches: large quads
// have many occluders before them, small ones are many.
constexpr int least_cells = 4, most_cells = 16;
constexpr double patches_a_quad = 60;

int cells_for(int patches) {
  const double quads = patches / patches_a_quad;
  return std::clamp(static_cast<int>(std::lround(std::sqrt(quads / 6))), least_cells, most_cells);
}

Eigen::AlignedBox3d box_around(const PatchMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (int i = 0; i < mesh.size(); ++i) {
    for (int k = 0; k < mesh.corner_count(i); ++k) box.extend(mesh.vertices[mesh.corners[i][k]]);
  }
  const Vec3 wider = Vec3::Constant(margin * box.diagonal().norm());
  return {box.min() - wider, box.max() + wider};
}

// Adds a side of the box, a parallelogram, as cells x cells quads that face along `normal`.
void add_side(const Vec3& corner, const Vec3& u, const Vec3& v, int cells, PatchMesh& mesh) {
  const Vec3 normal = u.cross(v).normalized();
  const int first = static_cast<int>(mesh.vertices.size());
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      mesh.vertices.push_back(corner + static_cast<double>(i) / cells * u +
                              static_cast<double>(j) / cells * v);
    }
  }
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const int at = first + i * (cells + 1) + j;
      mesh.corners.push_back({at, at + cells + 1, at + cells + 2, at + 1});
      mesh.normals.push_back(normal);
      mesh.centroids.push_back(corner + (i + 0.5) / cells * u + (j + 0.5) / cells * v);
      mesh.areas.push_back(u.cross(v).norm() / (cells * cells));
      mesh.faces.push_back(-1);
      mesh.groups.push_back(static_cast<int>(mesh.group_names.size()) - 1);
      mesh.materials.push_back(0);
      mesh.finishes.push_back(0);
      mesh.polygons.push_back(mesh.occluders.polygon_count);
    }
  }
  ++mesh.occluders.polygon_count;
}

}  // namespace

int sky_quads(int patches) {
  const int cells = cells_for(patches);
  return 6 * cells * cells;
}

PatchMesh in_sky_box(const PatchMesh& mesh) {
  PatchMesh boxed = mesh;
  if (mesh.size() == 0) return boxed;
  const Eigen::AlignedBox3d box = box_around(mesh);
  const int cells = cells_for(mesh.size());
  boxed.group_names.emplace_back("sky");
  const Vec3 size = box.sizes();
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 u = size[(axis + 1) % 3] * Vec3::Unit((axis + 1) % 3);
    const Vec3 v = size[(axis + 2) % 3] * Vec3::Unit((axis + 2) % 3);
    add_side(box.min(), u, v, cells, boxed);
    add_side(box.min() + size[axis] * Vec3::Unit(axis), v, u, cells, boxed);
  }
  return boxed;
}

}  // namespace luxel
