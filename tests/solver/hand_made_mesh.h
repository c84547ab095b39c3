#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "luxel/patch_mesh.h"

namespace luxel::testing {

/// A PatchMesh without the mesher: each face (three or four corners, [3] = -1 for a triangle) is one patch
/// and one polygon of the occluders.
inline PatchMesh hand_made_mesh(const std::vector<Vec3>& vertices,
                                const std::vector<std::array<int, 4>>& faces) {
  PatchMesh mesh;
  mesh.file = "hand-made";
  mesh.vertices = vertices;
  mesh.corners = faces;
  mesh.group_names = {"default"};
  mesh.material_names = {"default"};
  mesh.finish_table.resize(1);
  mesh.occluders.vertices = vertices;
  std::map<std::array<int, 4>, int> polygon_of;
  for (int i = 0; i < mesh.size(); ++i) {
    const auto& c = faces[i];
    const bool quad = c[3] >= 0;
    const Vec3 half = (vertices[c[1]] - vertices[c[0]]).cross(vertices[c[2]] - vertices[c[0]]) / 2;
    Vec3 other = Vec3::Zero();
    if (quad) other = (vertices[c[2]] - vertices[c[0]]).cross(vertices[c[3]] - vertices[c[0]]) / 2;
    const Vec3 middle = (vertices[c[0]] + vertices[c[1]] + vertices[c[2]]) / 3;
    Vec3 centroid = middle;
    if (quad) {
      const Vec3 other_middle = (vertices[c[0]] + vertices[c[2]] + vertices[c[3]]) / 3;
      centroid = (middle * half.norm() + other_middle * other.norm()) / (half.norm() + other.norm());
    }
    mesh.normals.push_back((half + other).normalized());
    mesh.areas.push_back((half + other).norm());
    mesh.centroids.push_back(centroid);
    mesh.faces.push_back(i);
    mesh.groups.push_back(0);
    mesh.materials.push_back(0);
    mesh.finishes.push_back(0);
    auto key = c;
    std::sort(key.begin(), key.end());
    const auto [known, is_new] = polygon_of.try_emplace(key, mesh.occluders.polygon_count);
    mesh.polygons.push_back(known->second);
    if (!is_new) continue;
    mesh.occluders.triangles.push_back({c[0], c[1], c[2]});
    mesh.occluders.polygons.push_back(known->second);
    if (quad) {
      mesh.occluders.triangles.push_back({c[0], c[2], c[3]});
      mesh.occluders.polygons.push_back(known->second);
    }
    ++mesh.occluders.polygon_count;
  }
  return mesh;
}

/// The corners and faces of boxes, which share nothing; a box's normals point inwards or outwards.
struct Boxes {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 4>> faces;

  Boxes& add(const Vec3& low, const Vec3& high, bool inwards) {
    const int first = static_cast<int>(vertices.size());
    for (int k = 0; k < 8; ++k) {
      vertices.push_back({k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]});
    }
    // outward, counter-clockwise: bottom, top, front, back, left, right
    const std::array<std::array<int, 4>, 6> outward{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (auto face : outward) {
      for (int& corner : face) corner += first;
      if (inwards) std::swap(face[1], face[3]);
      faces.push_back(face);
    }
    return *this;
  }

  /// The same boxes elsewhere and in another size.
  Boxes moved(double scale, const Vec3& offset) const {
    Boxes result = *this;
    for (Vec3& x : result.vertices) x = scale * x + offset;
    return result;
  }

  PatchMesh mesh() const { return hand_made_mesh(vertices, faces); }
};

}  // namespace luxel::testing
