#include "coplanar_sheets.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "luxel/dense_operator.h"
#include "luxel/enclosures.h"
#include "luxel/form_factors.h"
#include "luxel/mesh_scene.h"
#include "luxel/ray_scene.h"
#include "meshing/scenes.h"
#include "patch_locator.h"
#include "transport/gather/hit_map.h"

namespace luxel {
namespace {

/// A room with a block on its floor, turned so that no edges coincide, and a second one that runs through it.
Scene room_with_pierced_block() {
  SceneMaker maker;
  maker.room({0, 0, 0}, {2, 2, 1});
  const std::size_t first = maker.scene().vertices.size();
  maker.block({0.5, 0.5, 0}, {1, 1, 0.4});
  const std::size_t last = maker.scene().vertices.size();
  maker.block({0.8, 0.8, 0.1}, {1.4, 1.2, 0.3});
  Scene scene = maker.scene();
  const Vec3 centre(0.75, 0.75, 0);
  const Eigen::AngleAxisd turn(0.3, Vec3::UnitZ());
  for (std::size_t v = first; v < last; ++v) scene.vertices[v] = centre + turn * (scene.vertices[v] - centre);
  return scene;
}

TEST(CoplanarSheets, LeaveNoSideOfWhichTheMapIsSureThatNothingIsThere) {
  const PatchMesh mesh = mesh_scene(room_with_pierced_block(), {.patches = 400});
  const HitMap map(mesh);
  std::vector<char> doubled(mesh.occluders.polygon_count, 0);
  for (const auto& [p, q] : mesh.occluders.coplanar) doubled[p] = doubled[q] = 1;

  int sure = 0;
  for (std::size_t t = 0; t < mesh.occluders.triangles.size(); ++t) {
    for (const bool front : {true, false}) {
      const bool off = map.at(static_cast<int>(t), front, 0.3F, 0.3F) == HitMap::off_patches;
      EXPECT_FALSE(off && doubled[mesh.occluders.polygons[t]]);
      sure += off;
    }
  }
  EXPECT_GT(sure, 0);
}

TEST(CoplanarSheets, AnswerForEachOtherWhereTheyOverlap) {
  const PatchMesh mesh = mesh_scene(room_with_pierced_block(), {.patches = 400});
  const PatchLocator locator(mesh);
  const Vec3 under_the_block(0.75, 0.75, 0);
  int sheets = 0;

  for (std::size_t t = 0; t < mesh.occluders.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.occluders.triangles[t];
    const auto& x = mesh.occluders.vertices;
    const Vec3 normal = (x[b] - x[a]).cross(x[c] - x[a]);
    if (std::abs(normal.normalized().z()) < 0.999 || x[a].z() != 0 || x[b].z() != 0 || x[c].z() != 0)
      continue;
    ++sheets;
    const int above = locator.patch_at(static_cast<int>(t), normal.z() > 0, under_the_block);
    const int below = locator.patch_at(static_cast<int>(t), normal.z() < 0, under_the_block);

    ASSERT_GE(above, 0);
    ASSERT_GE(below, 0);
    EXPECT_GT(mesh.normals[above].z(), 0.999);
    EXPECT_LT(mesh.normals[below].z(), -0.999);
  }
  EXPECT_EQ(sheets, 4);
}

TEST(CoplanarSheets, LeaveBacksWhereNoneOverlaps) {
  const PatchMesh mesh = mesh_scene(room_with_pierced_block(), {.patches = 400});
  const PatchLocator locator(mesh);
  const Vec3 beside_the_block(1.7, 1.7, 0);

  for (std::size_t t = 0; t < mesh.occluders.triangles.size(); ++t) {
    const int polygon = mesh.occluders.polygons[t];
    for (int i = 0; i < mesh.size(); ++i) {
      if (mesh.polygons[i] != polygon || mesh.normals[i].z() < 0.999 || mesh.centroids[i].z() > 1e-9)
        continue;
      EXPECT_GE(locator.patch_at(static_cast<int>(t), true, beside_the_block), 0);
      EXPECT_EQ(locator.patch_at(static_cast<int>(t), false, beside_the_block), -1);
      break;
    }
  }
}

TEST(CoplanarSheets, AreFoundAmongManyOnOnePolygon) {
  SceneMaker maker;
  const int across = 9;
  maker.face({{0, 0, 0}, {across, 0, 0}, {across, across, 0}, {0, across, 0}});
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < across; ++j) maker.block({i + 0.3, j + 0.2, 0}, {i + 0.7, j + 0.9, 0.5});
  }
  const PatchMesh mesh = mesh_scene(maker.scene(), {.as_is = true});
  const PatchLocator locator(mesh);
  ASSERT_EQ(mesh.occluders.coplanar.size(), 81u);

  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < across; ++j) {
      // from below the floor's back is met, and the base of a block lies there
      const int base = locator.patch_at(0, false, {i + 0.5, j + 0.5, 0});
      ASSERT_GE(base, 0);
      EXPECT_NEAR(mesh.centroids[base].x(), i + 0.5, 1e-9);
      EXPECT_NEAR(mesh.centroids[base].y(), j + 0.55, 1e-9);
      EXPECT_EQ(locator.patch_at(0, false, {i + 0.1, j + 0.5, 0}), -1);
    }
  }
}

// Row + open + back = 1: what exact form factors see and what rays meet is the same.
TEST(CoplanarSheets, LetRowsAndRaysAgreeInsideOfAPiercedBlock) {
  const PatchMesh mesh = mesh_scene(room_with_pierced_block(), {.patches = 500});
  const RayScene occluders(mesh.occluders);
  constexpr int rays = 4096;
  const Enclosures enclosures = find_enclosures(mesh, occluders, rays);
  const FormFactors factors = form_factors(mesh);
  const std::vector<double> rows = row_sums(factors.exchange_areas, mesh.areas);

  for (int i = 0; i < mesh.size(); ++i) {
    const double sum = rows[i] + enclosures.open_share[i] + enclosures.back_share[i];
    // chance may do 4 sigma of independent rays, sqrt(1/4 / 4096) = 0.008; a floor called a back does 0.1 and
    // more
    EXPECT_NEAR(sum, 1, 0.032) << i;
  }
}

}  // namespace
}  // namespace luxel
