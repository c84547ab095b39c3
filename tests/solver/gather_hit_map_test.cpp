#include "transport/gather/hit_map.h"

#include <gtest/gtest.h>

#include <algorithm>
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
