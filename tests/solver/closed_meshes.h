#pragma once

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include "luxel/patch_mesh.h"

// Closed meshes with their normals inward, made in the tests.
namespace luxel::testing {

/// A mesh of flat patches with the fields that form factors need; corners counter-clockwise from the front.
inline PatchMesh patch_mesh(std::vector<Vec3> vertices, std::vector<std::array<int, 4>> corners) {
  PatchMesh mesh;
  mesh.vertices = std::move(vertices);
  mesh.corners = std::move(corners);
  for (int p = 0; p < mesh.size(); ++p) {
    auto corner = [&](int k) { return mesh.vertices[mesh.corners[p][k]]; };
    Vec3 area = Vec3::Zero(), moment = Vec3::Zero();
    for (int k = 1; k + 1 < mesh.corner_count(p); ++k) {
      const Vec3 part = 0.5 * (corner(k) - corner(0)).cross(corner(k + 1) - corner(0));
      area += part;
      moment += part.norm() * (corner(0) + corner(k) + corner(k + 1)) / 3;
    }
    mesh.areas.push_back(area.norm());
    mesh.normals.push_back(area.normalized());
    mesh.centroids.push_back(moment / area.norm());
    mesh.faces.push_back(p);
    mesh.groups.push_back(0);
    mesh.materials.push_back(0);
    mesh.finishes.push_back(0);
    mesh.polygons.push_back(p);
  }
  return mesh;
}

/// The box [0, x] x [0, y] x [0, z] seen from inside, k x k quads or twice as many triangles a side.
inline PatchMesh box(int k, bool triangles, const Vec3& size = Vec3::Ones()) {
  std::map<std::array<int, 3>, int> known;
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 4>> corners;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      for (int i = 0; i < k; ++i) {
        for (int j = 0; j < k; ++j) {
          auto vertex = [&](int di, int dj) {
            std::array<int, 3> at{};
            at[axis] = side * k;
            at[(axis + 1) % 3] = i + di;
            at[(axis + 2) % 3] = j + dj;
            const auto [it, fresh] = known.try_emplace(at, static_cast<int>(vertices.size()));
            if (fresh) vertices.emplace_back(size[0] * at[0] / k, size[1] * at[1] / k, size[2] * at[2] / k);
            return it->second;
          };
          std::array<int, 4> quad{vertex(0, 0), vertex(1, 0), vertex(1, 1), vertex(0, 1)};
          if (side == 1) std::swap(quad[1], quad[3]);
          if (triangles) {
            corners.push_back({quad[0], quad[1], quad[2], -1});
            corners.push_back({quad[0], quad[2], quad[3], -1});
          } else {
            corners.push_back(quad);
          }
        }
      }
    }
  }
  return patch_mesh(std::move(vertices), std::move(corners));
}

/// x -> scale * rotation * x + offset.
inline PatchMesh moved(const PatchMesh& mesh, const Eigen::Matrix3d& rotation, double scale,
                       const Vec3& offset) {
  std::vector<Vec3> vertices;
  for (const Vec3& x : mesh.vertices) vertices.push_back(scale * (rotation * x) + offset);
  return patch_mesh(std::move(vertices), mesh.corners);
}

/// A rotation along no axis.
inline Eigen::Matrix3d odd_rotation() {
  return Eigen::AngleAxisd(0.83, Vec3(0.2, -0.7, 0.5).normalized()).toRotationMatrix();
}

/// The patches in another order: patch k of the result is patch order[k] of `mesh`.
inline PatchMesh renumbered(const PatchMesh& mesh, const std::vector<int>& order) {
  std::vector<std::array<int, 4>> corners;
  for (int p : order) corners.push_back(mesh.corners[p]);
  return patch_mesh(mesh.vertices, corners);
}

}  // namespace luxel::testing
