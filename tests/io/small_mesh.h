#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "luxel/gouraud.h"
#include "luxel/patch_mesh.h"
#include "luxel/solve.h"

namespace luxel::testing {

/// Appends a flat patch with normal, centroid and area of its corners (a quad must be a parallelogram).
inline void append_patch(PatchMesh& mesh, const std::array<int, 4>& corners, int finish = 0) {
  const Vec3 a = mesh.vertices[corners[0]], b = mesh.vertices[corners[1]], c = mesh.vertices[corners[2]];
  const bool quad = corners[3] >= 0;
  const Vec3 cross = (b - a).cross(c - a);
  mesh.corners.push_back(corners);
  mesh.normals.push_back(cross.normalized());
  mesh.centroids.push_back(quad ? Vec3((a + c) / 2) : Vec3((a + b + c) / 3));
  mesh.areas.push_back(cross.norm() * (quad ? 1 : 0.5));
  mesh.faces.push_back(mesh.size() - 1);
  mesh.groups.push_back(0);
  mesh.materials.push_back(finish);
  mesh.finishes.push_back(finish);
  mesh.polygons.push_back(mesh.size() - 1);
}

/// The unit square in z = 0, seen from above: a quad of half of it and two triangles of the other half.
inline PatchMesh half_quad_half_triangles() {
  PatchMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 1, 0}, {0, 1, 0}};
  mesh.group_names = {"floor"};
  mesh.material_names = {"white", "lamp, \"hot\""};
  Finish lamp;
  lamp.reflectance = Rgb(0.1, 0.2, 0.3);
  lamp.emission = Rgb(1, 2, 3);
  mesh.finish_table = {Finish(), lamp};
  append_patch(mesh, {0, 1, 4, 5});
  append_patch(mesh, {1, 2, 3, -1}, 1);
  append_patch(mesh, {1, 3, 4, -1});
  return mesh;
}

/// The cube [-1, 1]^3 with its faces turned inwards, n x n quads a face; group f = face -x, +x, -y, +y, -z,
/// +z.
inline PatchMesh inward_cube(int n) {
  PatchMesh mesh;
  mesh.group_names = {"-x", "+x", "-y", "+y", "-z", "+z"};
  mesh.material_names = {"default"};
  mesh.finish_table = {Finish()};
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double side = face % 2 == 0 ? -1 : 1;
    // u x v points along +axis; on the far side the two are swapped, so that the front looks inwards
    const int u = (axis + (side < 0 ? 1 : 2)) % 3, v = (axis + (side < 0 ? 2 : 1)) % 3;
    const int first = static_cast<int>(mesh.vertices.size());
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        Vec3 point;
        point[axis] = side;
        point[u] = 2.0 * i / n - 1;
        point[v] = 2.0 * j / n - 1;
        mesh.vertices.push_back(point);
      }
    }
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const int a = first + j * (n + 1) + i;
        append_patch(mesh, {a, a + 1, a + n + 2, a + n + 1});
        mesh.groups.back() = face;
      }
    }
  }
  return mesh;
}

/// Gouraud vertices that are the mesh's own: right where vertices are not shared over creases.
inline GouraudMesh own_vertices(const PatchMesh& mesh) {
  GouraudMesh gouraud;
  gouraud.vertices = mesh.vertices;
  gouraud.normals.resize(mesh.vertices.size(), Vec3::UnitZ());
  gouraud.corners = mesh.corners;
  for (int i = 0; i < mesh.size(); ++i) {
    for (int k = 0; k < mesh.corner_count(i); ++k) gouraud.normals[mesh.corners[i][k]] = mesh.normals[i];
  }
  return gouraud;
}

/// A solution with given radiosity and irradiance, that nothing solved.
inline RadiositySolution solution(PatchField radiosity, PatchField irradiance) {
  RadiositySolution result;
  result.radiosity = std::move(radiosity);
  result.irradiance = std::move(irradiance);
  return result;
}

}  // namespace luxel::testing
