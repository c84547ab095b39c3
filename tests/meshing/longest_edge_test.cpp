#include "longest_edge.h"

#include <gtest/gtest.h>

namespace luxel {
namespace {

TEST(LongestEdge, HalvesUntilNoEdgeIsLonger) {
  std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  LongestEdgeRefiner refiner(vertices, {{0, 1, 2}, {0, 2, 3}}, {7, 8}, {});

  refiner.refine(0.1);

  double area = 0;
  for (const auto& [a, b, c] : refiner.triangles()) {
    EXPECT_LE((vertices[a] - vertices[b]).norm(), 0.1);
    EXPECT_LE((vertices[b] - vertices[c]).norm(), 0.1);
    EXPECT_LE((vertices[c] - vertices[a]).norm(), 0.1);
    area += (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]).z() / 2;
  }
  EXPECT_NEAR(area, 1, 1e-12);
  // Right isosceles triangles stay such: their longest edge goes 2^(1/2), 1, 2^(-1/2) .. 2^(-7/2) = 0.088 <
  // 0.1, eight halvings of each.
  EXPECT_EQ(refiner.triangles().size(), 512u);
  EXPECT_EQ(refiner.count(0.1), 512u);
  EXPECT_EQ(refiner.count(1.1), 4u);
  EXPECT_EQ(refiner.count(2), 2u);
}

TEST(LongestEdge, KeepsThreeSheetsOnOneEdgeTogether) {
  std::vector<Vec3> vertices = {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, -1, 0}, {1, 0, 1}};
  LongestEdgeRefiner refiner(vertices, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, {0, 1, 2}, {{0, 1}});

  refiner.refine(1.5);

  EXPECT_EQ(refiner.triangles().size(), 6u);
  EXPECT_EQ(vertices.size(), 6u);  // one middle for all three
  EXPECT_EQ(refiner.points_between(1, 0), std::vector<int>{5});
  EXPECT_FALSE(refiner.points_between(0, 2));
}

}  // namespace
}  // namespace luxel
