#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "form_factors/occluder_scene.h"
#include "form_factors/occluder_set.h"
#include "solver/hierarchical_scenes.h"
#include "transport/hierarchical/block_rays.h"
#include "transport/hierarchical/corner_error.h"
#include "transport/hierarchical/near_occluders.h"
#include "transport/hierarchical/patch_hierarchy.h"
#include "transport/hierarchical/store_block.h"

namespace luxel {
namespace {

using namespace luxel::testing;

Enclosures one_enclosure(const PatchMesh& mesh) {
  Enclosures enclosures;
  enclosures.count = 1;
  enclosures.enclosure.assign(mesh.size(), 0);
  enclosures.enclosure_closed = {0};
  return enclosures;
}

/// The largest flat cluster whose normal is this.
BlockEnd largest_end(const PatchHierarchy& hierarchy, const Vec3& normal, bool with_shaft = false) {
  int largest = -1;
  for (int c = 0; c < hierarchy.cluster_count(); ++c) {
    const PatchCluster& cluster = hierarchy.clusters[c];
    if (cluster.flat_group < 0 || hierarchy.groups[cluster.flat_group].normal.dot(normal) < 0.999) continue;
    if (largest < 0 || cluster.area > hierarchy.clusters[largest].area) largest = c;
  }
  return block_end(hierarchy, largest, with_shaft);
}

/// Two sheets that face each other, k x k patches each.
PatchMesh facing_sheets(int k) {
  SceneBuilder scene;
  scene.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, k);
  scene.quad({0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}, k);
  return scene.take();
}

TEST(StoreBlock, TakesTheSlopeOfVisibilityOutToTheNodes) {
  const PatchMesh mesh = facing_sheets(4);
  const PatchHierarchy hierarchy = patch_hierarchy(mesh, one_enclosure(mesh));
  const BlockEnd r = largest_end(hierarchy, Vec3::UnitZ()), s = largest_end(hierarchy, -Vec3::UnitZ());
  BlockKernel kernel;
  kernel.values.fill(1);
  // visibility rises along one axis of r from 0 to 1: a quarter and three quarters over its halves
  RayCount rays;
  for (int k = 0; k < 16; ++k) {
    rays.cast[k] = 4;
    rays.arrived[k] = (k >> 2) & 1 ? 3 : 1;
    rays.all += 4;
    rays.visible += rays.arrived[k];
  }
  BlockList list;

  store_block(r, s, kernel, rays, {1e-9, 1, 1}, list);

  // the nodes lie 1 / sqrt(12) from the middle, where the share is 1/2 -+ 1 / sqrt(12)
  ASSERT_EQ(list.linears.size(), 1);
  EXPECT_EQ(list.linears[0].r, r.cluster);
  for (int a = 0; a < 4; ++a) {
    const double expected = 0.5 + ((a & 1) ? 1 : -1) / std::sqrt(12.0);
    EXPECT_NEAR(list.linears[0].values[a], expected, 1e-6);  // float
  }
}

// The parts of a triangle that lie nearest to its nodes have other areas than the nodes have weights.
TEST(StoreBlock, KeepsTheShareThatRaysFoundBetweenPatchesThatFillNoRectangle) {
  const PatchMesh mesh = hand_made_mesh(
      {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.2, 0.9, 0), Vec3(0, 0, 2), Vec3(0.2, 0.9, 2), Vec3(1, 0, 2)},
      {{0, 1, 2, -1}, {3, 4, 5, -1}});
  const PatchHierarchy hierarchy = patch_hierarchy(mesh, one_enclosure(mesh));
  const BlockEnd r = block_end(hierarchy, hierarchy.cluster_count(), false),
                 s = block_end(hierarchy, hierarchy.cluster_count() + 1, false);
  BlockKernel kernel;
  kernel.values.fill(1);
  // twice as many rays start near the first node as near each other one, and these alone arrive
  RayCount rays;
  for (int k = 0; k < 16; ++k) {
    rays.cast[k] = k < 4 ? 8 : 4;
    rays.arrived[k] = k < 4 ? 8 : 0;
    rays.all += rays.cast[k];
    rays.visible += rays.arrived[k];
  }
  BlockList list;

  store_block(r, s, kernel, rays, {1e-9, 1, 1}, list);

  ASSERT_EQ(list.scalars.size(), 1);
  EXPECT_NEAR(list.scalars[0].value, 32.0 / 80, 1e-6);  // float
}

TEST(CornerError, IsTheKernelOfACornerThatAloneSeesOverTheHorizon) {
  // the plane of a small patch, 3 x + 3 y = 5.6, leaves the corner (1, 1, 0) of the floor and none of its
  // nodes
  SceneBuilder scene;
  scene.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, 4);
  const Vec3 normal = Vec3(1, 1, 0).normalized(), along = Vec3(-1, 1, 0).normalized();
  const Vec3 middle(2.8 / 3, 2.8 / 3, 1);
  const double half = 1e-3;
  scene.quad(middle - half * along - half * Vec3::UnitZ(), middle + half * along - half * Vec3::UnitZ(),
             middle + half * along + half * Vec3::UnitZ(), middle - half * along + half * Vec3::UnitZ(), 2);
  const PatchMesh mesh = scene.take();
  const PatchHierarchy hierarchy = patch_hierarchy(mesh, one_enclosure(mesh));
  const BlockEnd floor = largest_end(hierarchy, Vec3::UnitZ()), small = largest_end(hierarchy, normal);
  const BlockKernel kernel = block_kernel(floor, small);

  const double error = corner_error(floor, small, kernel.values);

  const Vec3 sight = middle - Vec3(1, 1, 0);
  const double expected = sight.z() * -sight.dot(normal) /
                          (std::numbers::pi * std::pow(sight.squaredNorm(), 2)) /
                          std::pow(hierarchy.frame.scale, 2);
  EXPECT_EQ(kernel.largest, 0);
  EXPECT_NEAR(error, expected, 1e-2 * expected);  // the patch is a thousandth of the distance wide
}

TEST(OccluderStandsOn, TellsALegOnTheFloorFromABodyAboveIt) {
  for (const double height : {0.0, 0.2}) {
    SceneBuilder scene;
    scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), 4, true);
    scene.box({0.4, 0.4, height}, {0.42, 0.42, 0.6}, Eigen::Matrix3d::Identity(), 1, false);
    const PatchMesh mesh = scene.take();
    const PatchHierarchy hierarchy = patch_hierarchy(mesh, one_enclosure(mesh));
    const OccluderSet occluders = occluder_set(mesh, hierarchy.frame);
    const HidingCandidates candidates{all_candidates(occluders)};
    const BlockEnd floor = largest_end(hierarchy, Vec3::UnitZ());

    EXPECT_EQ(occluder_stands_on(occluders, candidates, floor, 0.1), height == 0);
    EXPECT_TRUE(occluder_near(occluders, candidates, floor, 1));
  }
}

TEST(BlockRays, FindTheStripAtTheEndsThatAFewRaysMiss) {
  // a plate hides the last two hundredths of the floor from all of the ceiling
  SceneBuilder scene;
  scene.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, 64);
  scene.quad({0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}, 64);
  scene.quad({0.98, 0, 1e-4}, {1, 0, 1e-4}, {1, 1, 1e-4}, {0.98, 1, 1e-4}, 1, 2);
  const PatchMesh mesh = scene.take();
  const PatchHierarchy hierarchy = patch_hierarchy(mesh, one_enclosure(mesh));
  const OccluderSet occluders = occluder_set(mesh, hierarchy.frame);
  const OccluderScene rays_scene(occluders);
  const BlockEnd floor = largest_end(hierarchy, Vec3::UnitZ()),
                 ceiling = largest_end(hierarchy, -Vec3::UnitZ());
  int unanimous = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const BlockRays rays(hierarchy, rays_scene.scene(), seed);
    RayCount count;

    rays.cast(floor, ceiling, 16, count);
    rays.cast_between_corners(floor, ceiling, count);

    unanimous += count.unanimous();
    EXPECT_FALSE(count.unanimous() && count.borne_out());
    EXPECT_EQ(count.corners, 16);
    EXPECT_EQ(count.corners_visible, 8);  // those from x = 0
  }
  EXPECT_GT(unanimous, 0);  // 0.98^16 = 0.72 of them, if points were independent
}

TEST(BlockRays, StartOnThePatchesOfWhatIsNoRectangle) {
  // floor and ceiling of a prism; a wall just outside its slanted side hides nothing from any of their points
  SceneBuilder scene;
  const int k = 8;
  const double size = 1.0 / k;
  const int floor_polygon = scene.polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const int ceiling_polygon = scene.polygon({{0, 0, 1}, {0, 1, 1}, {1, 0, 1}});
  for (int i = 0; i < k; ++i) {
    for (int j = 0; i + j < k; ++j) {
      for (const bool upper : {false, true}) {
        if (upper && i + j + 2 > k) continue;
        const Vec3 a = upper ? Vec3(i + 1, j + 1, 0) * size : Vec3(i, j, 0) * size;
        const Vec3 b = upper ? Vec3(i, j + 1, 0) * size : Vec3(i + 1, j, 0) * size;
        const Vec3 c = upper ? Vec3(i + 1, j, 0) * size : Vec3(i, j + 1, 0) * size;
        scene.patch({a, b, c}, floor_polygon);
        scene.patch({a + Vec3::UnitZ(), c + Vec3::UnitZ(), b + Vec3::UnitZ()}, ceiling_polygon);
      }
    }
  }
  scene.quad({1.001, 0, 0}, {0, 1.001, 0}, {0, 1.001, 1}, {1.001, 0, 1}, 1, 2);
  scene.quad({1.1, 0, 0}, {1.1, 1, 0}, {1.1, 1, 1}, {1.1, 0, 1}, 1, 2);  // the wall hides this, and so counts
  const PatchMesh mesh = scene.take();
  const PatchHierarchy hierarchy = patch_hierarchy(mesh, one_enclosure(mesh));
  const OccluderSet occluders = occluder_set(mesh, hierarchy.frame, true);
  const OccluderScene rays_scene(occluders);
  const BlockEnd floor = largest_end(hierarchy, Vec3::UnitZ()),
                 ceiling = largest_end(hierarchy, -Vec3::UnitZ());
  RayCount count;

  BlockRays(hierarchy, rays_scene.scene(), 1).cast(floor, ceiling, 512, count);
  BlockRays(hierarchy, rays_scene.scene(), 1).cast_between_corners(floor, ceiling, count);

  EXPECT_FALSE(floor.rectangle);
  EXPECT_EQ(count.all, 512);
  EXPECT_EQ(count.visible, 512);
  EXPECT_EQ(count.corners_visible, 16);
}

}  // namespace
}  // namespace luxel
