#include "patch_locator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "solver/gather_scenes.h"

namespace luxel {
namespace {

using namespace luxel::testing;

/// A unit square of one polygon: a half left whole, a quarter in strips of 1/256, the rest in 64 x 64 cells.
PatchMesh patches_of_all_sizes() {
  PatchMesh mesh = cut_faces(Boxes().add({0, 0, 0}, {1, 1, 1}, true), 1);
  const PatchMesh room = mesh;
  mesh.vertices.clear();
  for (auto* numbers : {&mesh.faces, &mesh.groups, &mesh.materials, &mesh.finishes, &mesh.polygons})
    numbers->clear();
  mesh.corners.clear();
  mesh.normals.clear();
  mesh.centroids.clear();
  mesh.areas.clear();
  const auto add = [&](double x, double y, double width, double height) {
    const int first = static_cast<int>(mesh.vertices.size());
    for (const auto& [s, t] : {std::array{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) {
      mesh.vertices.push_back({x + s * width, y + t * height, 0});
    }
    mesh.corners.push_back({first, first + 1, first + 2, first + 3});
    mesh.normals.push_back(Vec3::UnitZ());
    mesh.centroids.push_back({x + width / 2, y + height / 2, 0});
    mesh.areas.push_back(width * height);
    mesh.polygons.push_back(room.polygons[0]);
    for (auto* numbers : {&mesh.faces, &mesh.groups, &mesh.materials, &mesh.finishes}) numbers->push_back(0);
  };
  add(0, 0, 0.5, 1);
  for (int k = 0; k < 128; ++k) add(0.5, k / 256.0, 0.5, 1 / 256.0);
  for (int k = 0; k < 64 * 64; ++k) add(0.5 + k % 64 / 128.0, 0.5 + k / 64 / 128.0, 1 / 128.0, 1 / 128.0);
  return mesh;
}

TEST(PatchLocator, FindsPatchesOfAllSizesInOnePolygon) {
  const PatchMesh mesh = patches_of_all_sizes();
  const PatchLocator locator(mesh);
  const bool front =
      mesh.normals[0].dot((mesh.occluders.vertices[mesh.occluders.triangles[0][1]] -
                           mesh.occluders.vertices[mesh.occluders.triangles[0][0]])
                              .cross(mesh.occluders.vertices[mesh.occluders.triangles[0][2]] -
                                     mesh.occluders.vertices[mesh.occluders.triangles[0][0]])) > 0;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<RayScene::Hit> hits;
  std::vector<Vec3> points;
  for (int k = 0; k < 5000; ++k) {
    hits.push_back({0, 1, front, 0, 0});
    points.push_back({unit(random), unit(random), 0});
  }
  hits.push_back({});
  points.push_back(Vec3::Zero());

  const std::vector<int> found = locator.patches_at(hits, points);

  for (int k = 0; k < 5000; ++k) {
    const double x = points[k][0], y = points[k][1];
    int expected = 0;
    if (x >= 0.5) {
      expected = y < 0.5 ? 1 + static_cast<int>(y * 256)
                         : 129 + static_cast<int>((y - 0.5) * 128) * 64 + static_cast<int>((x - 0.5) * 128);
    }
    ASSERT_EQ(found[k], expected) << x << ' ' << y;
    ASSERT_EQ(locator.patch_at(0, front, points[k]), expected);
  }
  EXPECT_EQ(found.back(), -1);
  EXPECT_EQ(locator.patch_at(0, !front, points[0]), -1);
}

}  // namespace
}  // namespace luxel
