#include <gtest/gtest.h>

#include <algorithm>

#include "form_factors/occluder_set.h"
#include "solver/blocked_scenes.h"

namespace luxel {
namespace {

using testing::SceneBuilder;
using testing::turned;

OccluderSet occluders_of(const PatchMesh& mesh) {
  return occluder_set(mesh, cluster_tree(mesh));
}

// Triangles of a grid over a rectangle, without the cells that `hole` names.
struct Grid {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
};
template <class Hole>
Grid grid(int n, int m, const Eigen::Matrix3d& turn, Hole hole) {
  Grid result;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= m; ++j) result.vertices.push_back(turn * Vec3(0.1 * i, 0.07 * j, 0.3));
  }
  auto at = [&](int i, int j) { return i * (m + 1) + j; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      if (hole(i, j)) continue;
      result.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      result.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return result;
}

double total_area(const std::vector<Polygon>& pieces) {
  double sum = 0;
  for (const Polygon& piece : pieces) sum += area_vector(piece).norm();
  return sum;
}

TEST(ConvexPieces, MakeOneRectangleOfATurnedGrid) {
  const Eigen::Matrix3d turn = turned(0.3, -0.7, 1.1);
  const Grid sheet = grid(7, 5, turn, [](int, int) { return false; });

  const auto pieces = convex_pieces(sheet.vertices, sheet.triangles, turn * Vec3::UnitZ());

  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].count, 4);
  EXPECT_NEAR(total_area(pieces), 0.7 * 0.35, 1e-14);  // rounding of 70 triangles
}

TEST(ConvexPieces, KeepTheAreaOfAFrameAndItsHole) {
  const Eigen::Matrix3d turn = turned(1.3, 0.2, -0.4);
  const Grid frame = grid(4, 4, turn, [](int i, int j) { return i > 0 && i < 3 && j > 0 && j < 3; });

  const auto pieces = convex_pieces(frame.vertices, frame.triangles, turn * Vec3::UnitZ());

  EXPECT_NEAR(total_area(pieces), 12 * 0.1 * 0.07, 1e-14);
  EXPECT_LT(pieces.size(), 24u);  // fewer than the triangles
  for (const Polygon& piece : pieces) {
    const Vec3 normal = area_vector(piece).normalized();
    for (int k = 0; k < piece.count; ++k) {
      const Vec3 here = piece.next(k) - piece[k], next = piece.next((k + 1) % piece.count) - piece.next(k);
      EXPECT_GE(here.cross(next).dot(normal), 0) << "a piece is not convex";
    }
  }
}

TEST(OccluderSet, IsEmptyForAConvexRoom) {
  SceneBuilder scene;
  scene.box({0, 0, 0}, {1, 2, 3}, turned(0.1, 0.2, 0.3), 3, true);

  EXPECT_TRUE(occluders_of(scene.take()).occluders.empty());
}

TEST(OccluderSet, TakesAFloatingBoxAsOneBody) {
  const OccluderSet set = occluders_of(testing::room_with_turned_boxes(2, 1));

  ASSERT_EQ(set.occluders.size(), 2u);
  for (const Occluder& occluder : set.occluders) {
    EXPECT_EQ(occluder.face_count(), 6);
    EXPECT_EQ(occluder.edges.size(), 12u);
  }
}

TEST(OccluderSet, TakesAPrismOfManySidesAsOneRoundBody) {
  SceneBuilder scene;
  scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), 2, true);
  scene.prism({0.3, 0.4, 0.3}, {0.6, 0.5, 0.7}, 0.15, 24);

  const OccluderSet set = occluders_of(scene.take());

  ASSERT_EQ(set.occluders.size(), 1u);
  EXPECT_TRUE(set.occluders[0].round());
  EXPECT_EQ(set.occluders[0].vertices.size(), 48u);
  // the centre is off the axis by no more than the ends' pieces pull it; sides keep 0.15 cos(pi / 24) from
  // that
  EXPECT_GT(set.occluders[0].inner_radius, 0.1);
  EXPECT_LT(set.occluders[0].inner_radius, 0.15);
}

TEST(OccluderSet, DoesNotTrustARoundBodyThatSharesAVertex) {
  SceneBuilder scene;
  scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), 2, true);
  scene.prism({0.5, 0.5, 0.3}, {0.5, 0.5, 0.7}, 0.15, 24);
  const Vec3 rim = Vec3(0.5, 0.5, 0.7) + 0.15 * Vec3::UnitZ().unitOrthogonal();
  scene.patch({rim, rim + Vec3(0.1, 0, 0.1), rim + Vec3(0, 0.1, 0.1)},
              scene.polygon({rim, rim + Vec3(0.1, 0, 0.1), rim + Vec3(0, 0.1, 0.1)}));

  const OccluderSet set = occluders_of(scene.take());

  EXPECT_TRUE(std::none_of(set.occluders.begin(), set.occluders.end(),
                           [](const Occluder& occluder) { return occluder.body(); }));
}

TEST(OccluderSet, DoesNotTrustABodyWithPatchesInside) {
  SceneBuilder scene;
  scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), 2, true);
  scene.box({0.3, 0.3, 0.3}, {0.7, 0.7, 0.7}, Eigen::Matrix3d::Identity(), 2, false, 2);

  const OccluderSet set = occluders_of(scene.take());

  EXPECT_EQ(set.occluders.size(), 6u);
  EXPECT_TRUE(std::none_of(set.occluders.begin(), set.occluders.end(),
                           [](const Occluder& occluder) { return occluder.body(); }));
}

TEST(OccluderSet, DoesNotTrustABoxThatStandsOnAnUnsplitFloor) {
  SceneBuilder scene;
  scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), 3, true);
  scene.box({0.2, 0.2, 0}, {0.6, 0.6, 0.5}, Eigen::Matrix3d::Identity(), 1, false);

  for (const Occluder& occluder : occluders_of(scene.take()).occluders) EXPECT_FALSE(occluder.body());
}

}  // namespace
}  // namespace luxel
