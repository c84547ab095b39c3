#pragma once

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "solver/hand_made_mesh.h"

namespace luxel::testing {

/// Flat quads (corners counter-clockwise) cut into k x k patches each, which are all of one polygon of the
/// occluders: coincident quads, from either side, stand there once.
inline PatchMesh cut_faces(const Boxes& boxes, int k, bool triangles = false) {
  PatchMesh mesh;
  mesh.file = "hand-made";
  mesh.group_names = {"default"};
  mesh.material_names = {"default"};
  mesh.finish_table.resize(1);
  mesh.occluders.vertices = boxes.vertices;
  std::map<std::array<int, 4>, int> polygon_of;
  int face_number = 0;
  for (const auto& face : boxes.faces) {
    auto key = face;
    std::sort(key.begin(), key.end());
    const auto [known, fresh] = polygon_of.try_emplace(key, mesh.occluders.polygon_count);
    if (fresh) {
      mesh.occluders.triangles.push_back({face[0], face[1], face[2]});
      mesh.occluders.triangles.push_back({face[0], face[2], face[3]});
      mesh.occluders.polygons.insert(mesh.occluders.polygons.end(), 2, mesh.occluders.polygon_count++);
    }
    const int first = static_cast<int>(mesh.vertices.size());
    const auto corner = [&](int c) { return boxes.vertices[face[c]]; };
    for (int j = 0; j <= k; ++j) {
      for (int i = 0; i <= k; ++i) {
        const double s = double(i) / k, t = double(j) / k;
        mesh.vertices.push_back((1 - s) * (1 - t) * corner(0) + s * (1 - t) * corner(1) + s * t * corner(2) +
                                (1 - s) * t * corner(3));
      }
    }
    const auto add = [&](std::array<int, 4> c) {
      for (int& v : c) v = v < 0 ? -1 : v + first;
      const Vec3 &a = mesh.vertices[c[0]], &b = mesh.vertices[c[1]], &d = mesh.vertices[c[2]];
      const Vec3 half = (b - a).cross(d - a) / 2;
      const bool quad = c[3] >= 0;
      mesh.corners.push_back(c);
      mesh.normals.push_back(half.normalized());
      mesh.areas.push_back((quad ? 2 : 1) * half.norm());  // parallelograms
      mesh.centroids.push_back(quad ? Vec3((a + d) / 2) : Vec3((a + b + d) / 3));
      mesh.faces.push_back(face_number);
      mesh.groups.push_back(0);
      mesh.materials.push_back(0);
      mesh.finishes.push_back(0);
      mesh.polygons.push_back(known->second);
    };
    for (int j = 0; j < k; ++j) {
      for (int i = 0; i < k; ++i) {
        const int v = j * (k + 1) + i;
        const std::array<int, 4> q{v, v + 1, v + k + 2, v + k + 1};
        if (triangles) {
          add({q[0], q[1], q[2], -1});
          add({q[0], q[2], q[3], -1});
        } else {
          add(q);
        }
      }
    }
    ++face_number;
  }
  return mesh;
}

/// A unit room with a box floating in it.
inline Boxes room_with_a_box() {
  return Boxes().add({0, 0, 0}, {1, 1, 1}, true).add({0.31, 0.27, 0.22}, {0.63, 0.58, 0.71}, false);
}

/// A floor square and an upright one with an edge in common, patches 0 and 1, cut by screens into so many
/// cells: of these each sees only its own part of the other square.
inline PatchMesh squares_cut_by_screens(int cells) {
  std::vector<Vec3> vertices{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0),
                             Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(0, 1, 1)};
  std::vector<std::array<int, 4>> faces{{0, 1, 2, 3}, {4, 5, 6, 7}};
  for (int k = 1; k < cells; ++k) {
    const double x = static_cast<double>(k) / cells;
    const int first = static_cast<int>(vertices.size());
    vertices.insert(vertices.end(), {Vec3(x, -1, -1), Vec3(x, 2, -1), Vec3(x, 2, 2), Vec3(x, -1, 2)});
    faces.push_back({first, first + 1, first + 2, first + 3});
  }
  return hand_made_mesh(vertices, faces);
}

/// Form factor from a rectangle 1 x w to one 1 x h at a right angle, the unit edges in common.
/// Source: Howell, A Catalog of Radiation Heat Transfer Configuration Factors, C-14.
inline double around_a_corner(double w, double h) {
  const double ww = w * w, hh = h * h, both = ww + hh, r = std::sqrt(both);
  const double logs = std::log((1 + ww) * (1 + hh) / (1 + both)) +
                      ww * std::log(ww * (1 + both) / ((1 + ww) * both)) +
                      hh * std::log(hh * (1 + both) / ((1 + hh) * both));
  return (w * std::atan(1 / w) + h * std::atan(1 / h) - r * std::atan(1 / r) + logs / 4) /
         (std::numbers::pi * w);
}

/// A sphere of radius 1 seen from inside: rings x 2 rings quads, triangles at the poles, each a polygon.
inline PatchMesh inward_sphere(int rings) {
  std::vector<Vec3> vertices{{0, 0, 1}};
  const int around = 2 * rings;
  for (int r = 1; r < rings; ++r) {
    const double polar = std::numbers::pi * r / rings;
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      vertices.push_back(
          {std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), std::cos(polar)});
    }
  }
  vertices.push_back({0, 0, -1});
  const int last = static_cast<int>(vertices.size()) - 1;
  const auto at = [&](int ring, int k) { return 1 + (ring - 1) * around + k % around; };
  std::vector<std::array<int, 4>> faces;
  for (int k = 0; k < around; ++k) {
    faces.push_back({0, at(1, k + 1), at(1, k), -1});
    faces.push_back({last, at(rings - 1, k), at(rings - 1, k + 1), -1});
    for (int r = 1; r + 1 < rings; ++r) {
      faces.push_back({at(r, k), at(r, k + 1), at(r + 1, k + 1), -1});
      faces.push_back({at(r, k), at(r + 1, k + 1), at(r + 1, k), -1});
    }
  }
  return hand_made_mesh(vertices, faces);
}

/// Emission of one channel: `value` on the patches of these faces.
inline PatchField glow(const PatchMesh& mesh, std::initializer_list<int> faces, double value = 1) {
  PatchField emission = PatchField::Zero(mesh.size(), 1);
  for (int i = 0; i < mesh.size(); ++i) {
    for (int face : faces) {
      if (mesh.faces[i] == face) emission(i, 0) = value;
    }
  }
  return emission;
}

/// Area-weighted relative RMS difference.
inline double relative_rms(const PatchMesh& mesh, const PatchField& x, const PatchField& expected) {
  double error = 0, norm = 0;
  for (int i = 0; i < mesh.size(); ++i) {
    error += mesh.areas[i] * (x.row(i) - expected.row(i)).squaredNorm();
    norm += mesh.areas[i] * expected.row(i).squaredNorm();
  }
  return std::sqrt(error / norm);
}

}  // namespace luxel::testing
