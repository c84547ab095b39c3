#include "transport/gather/hit_map.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "patch_locator.h"
#include "solver/gather_scenes.h"
#include "transport/gather/packets.h"

namespace luxel {
namespace {

using namespace luxel::testing;

TEST(HitMap, AgreesWithTheLocatorButForHalfATexel) {
  const PatchMesh mesh = cut_faces(room_with_a_box(), 7, true);
  const HitMap map(mesh);
  const PatchLocator locator(mesh);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  const int tries = 20000;
  int wrong = 0;

  for (int k = 0; k < tries; ++k) {
    const int t = static_cast<int>(random() % mesh.occluders.triangles.size());
    float u = uniform(random), v = uniform(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto& [a, b, c] = mesh.occluders.triangles[t];
    const auto& x = mesh.occluders.vertices;
    const Vec3 point = x[a] + u * (x[b] - x[a]) + v * (x[c] - x[a]);
    const int patch = map.at(t, true, u, v);
    ASSERT_GE(patch, 0);
    wrong += patch != locator.patch_at(t, true, point);
    // a texel is a quarter of a patch's root
    EXPECT_LT((mesh.centroids[patch] - point).norm(), 1.5 / 7);
  }

  // a boundary crosses 16 texels a patch on about three quarters, and is misplaced on a quarter of each
  EXPECT_LT(wrong, tries / 5);
  EXPECT_EQ(map.at(0, false, 0.3f, 0.3f), HitMap::off_patches);
}

TEST(HitMap, TellsTheSidesOfASheetApart) {
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const HitMap map(hand_made_mesh(corners, {{0, 1, 2, 3}, {0, 3, 2, 1}}));

  EXPECT_EQ(map.at(0, true, 0.2f, 0.2f), 0);
  EXPECT_EQ(map.at(0, false, 0.2f, 0.2f), 1);
}

TEST(HitMap, GivesPatchesTheirShareOfTheTexels) {
  // 7 x 7 rectangles, up to a tenth narrower and wider: edges at every place between two texels
  PatchMesh mesh = cut_faces(Boxes().add({0, 0, 0}, {1, 1, 1}, true), 7);
  for (Vec3& x : mesh.vertices) x = (0.9 * x.array() + 0.1 * x.array().square()).matrix();
  std::vector<double> areas;
  for (const auto& c : mesh.corners) {
    areas.push_back(
        (mesh.vertices[c[1]] - mesh.vertices[c[0]]).cross(mesh.vertices[c[3]] - mesh.vertices[c[0]]).norm());
  }
  const HitMap map(mesh, 23);

  std::vector<double> share(mesh.size(), 0.0);
  for (int k = 0; k < map.nothing(); ++k) share[map.texels()[k]] += 6.0 / map.nothing();

  double squares = 0;
  for (int i = 0; i < mesh.size(); ++i) squares += std::pow(share[i] / areas[i] - 1, 2) / mesh.size();
  // texels that take the patch at their centre are 4 or 5 a side: off by 0.15
  EXPECT_LT(std::sqrt(squares), 0.05);
}

TEST(HitMap, KnowsPatchesInRowsAndColumnsExactly) {
  PatchMesh mesh = cut_faces(room_with_a_box(), 9);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (auto* points : {&mesh.vertices, &mesh.centroids, &mesh.normals, &mesh.occluders.vertices}) {
    for (Vec3& x : *points) x = turn * x;
  }
  const HitMap map(mesh);
  const PatchLocator locator(mesh);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0, 1);
  int wrong = 0;

  for (int k = 0; k < 20000; ++k) {
    const int t = static_cast<int>(random() % mesh.occluders.triangles.size());
    float u = uniform(random), v = uniform(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto& [a, b, c] = mesh.occluders.triangles[t];
    const auto& x = mesh.occluders.vertices;
    const Vec3 point = x[a] + u * (x[b] - x[a]) + v * (x[c] - x[a]);
    const int patch = map.at(t, true, u, v);
    ASSERT_GE(patch, 0);
    wrong += patch != locator.patch_at(t, true, point);
  }

  // float puts one hit in 10^5 or so on the other side of a boundary; pictures of 16 texels a patch 1 in 10
  EXPECT_LE(wrong, 2);
  EXPECT_EQ(map.nothing(), mesh.size());
}

TEST(HitMap, AsksInTheHolesOfAGrid) {
  PatchMesh mesh = cut_faces(Boxes().add({0, 0, 0}, {1, 1, 1}, true), 4);
  const int hole = 5;  // inside the bottom
  for (auto* numbers : {&mesh.faces, &mesh.groups, &mesh.materials, &mesh.finishes, &mesh.polygons}) {
    numbers->erase(numbers->begin() + hole);
  }
  mesh.corners.erase(mesh.corners.begin() + hole);
  mesh.normals.erase(mesh.normals.begin() + hole);
  mesh.centroids.erase(mesh.centroids.begin() + hole);
  mesh.areas.erase(mesh.areas.begin() + hole);

  const HitMap map(mesh);

  EXPECT_EQ(std::count(map.texels().begin(), map.texels().end(), HitMap::ask), 1);
}

TEST(HitMap, AsksAlongTheFootOfABodyThatStandsOnAPolygon) {
  // a floor of four squares; on the edge between two of them stands a wall
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0},
                                  {1, 1, 0}, {2, 1, 0}, {1, 0, 1}, {1, 1, 1}};
  PatchMesh mesh = hand_made_mesh(corners, {{0, 1, 4, 3}, {1, 2, 5, 4}, {1, 4, 7, 6}});
  for (int t = 0; t < static_cast<int>(mesh.occluders.triangles.size()); ++t) {
    if (mesh.occluders.polygons[t] == 1) mesh.occluders.polygons[t] = 0;
  }
  mesh.polygons[1] = 0;
  const HitMap map(mesh);

  const PatchLocator locator(mesh);
  for (int t = 0; t < static_cast<int>(mesh.occluders.triangles.size()); ++t) {
    if (mesh.occluders.polygons[t] != 0) continue;
    const auto& [a, b, c] = mesh.occluders.triangles[t];
    for (const double u : {0.05, 0.3, 0.45, 0.6}) {
      for (const double v : {0.05, 0.2, 0.35}) {
        const Vec3 point = corners[a] + u * (corners[b] - corners[a]) + v * (corners[c] - corners[a]);
        const int patch = map.at(t, true, static_cast<float>(u), static_cast<float>(v));
        if (patch != HitMap::ask) {
          EXPECT_EQ(patch, locator.patch_at(t, true, point)) << point.transpose();
        }
      }
    }
  }
  EXPECT_GT(std::count(map.texels().begin(), map.texels().end(), HitMap::ask), 0);
}

TEST(PacketsOf, HoldEachPatchOnce) {
  for (const PatchMesh& mesh : {cut_faces(room_with_a_box(), 5), inward_sphere(7),
                                cut_faces(Boxes().add({0, 0, 0}, {1, 1, 1}, true), 2)}) {
    std::vector<int> seen(mesh.size(), 0);

    for (const auto& packet : packets_of(mesh)) {
      EXPECT_GT(used_lanes(packet), 0);
      for (int k = 0; k < used_lanes(packet); ++k) ++seen[packet[k]];
    }

    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), mesh.size());
  }
}

}  // namespace
}  // namespace luxel
