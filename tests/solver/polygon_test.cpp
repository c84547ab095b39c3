#include "form_factors/polygon.h"

#include <gtest/gtest.h>

namespace luxel {
namespace {

Polygon unit_square() {
  return {4, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}};
}

TEST(Polygon, AreaIsSignedByTheNormal) {
  EXPECT_EQ(area(unit_square(), Vec3::UnitZ()), 1);
  EXPECT_EQ(area(unit_square(), -Vec3::UnitZ()), -1);
}

TEST(Polygon, CentroidIsTheCentreOfMass) {
  const Polygon triangle{3, {Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(0, 3, 3)}};
  const Polygon trapezium{4, {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}};

  EXPECT_LT((centroid(triangle) - Vec3(1, 1, 1)).norm(), 1e-15);
  // y = h (a + 2 b) / (3 (a + b)) over the parallel sides a = 2 and b = 1
  EXPECT_NEAR(centroid(trapezium)[1], 4.0 / 9, 1e-15);
}

TEST(Polygon, ClipKeepsTheFront) {
  const Polygon half = clip(unit_square(), {Vec3::UnitX(), 0.25}, 0);

  EXPECT_EQ(half.count, 4);
  EXPECT_DOUBLE_EQ(area(half, Vec3::UnitZ()), 0.75);
}

TEST(Polygon, ClipHalvesAddUpToTheWhole) {
  const Plane plane{Vec3(0.6, 0.8, 0), 0.7};

  const double parts = area(clip(unit_square(), plane, 0), Vec3::UnitZ()) +
                       area(clip(unit_square(), plane.flipped(), 0), Vec3::UnitZ());

  EXPECT_NEAR(parts, 1, 1e-15);
}

TEST(Polygon, ClipLeavesWhatTouchesThePlaneAsItIs) {
  const Polygon whole = clip(unit_square(), {Vec3::UnitX(), 1e-13}, 1e-12);

  EXPECT_EQ(whole.count, 4);
  EXPECT_EQ(area(whole, Vec3::UnitZ()), 1);
}

TEST(Polygon, ClipByAPlaneInFrontLeavesNothing) {
  EXPECT_EQ(clip(unit_square(), {Vec3::UnitX(), 2}, 1e-12).count, 0);
  EXPECT_EQ(clip(unit_square(), {Vec3::UnitX(), 1}, 1e-12).count, 0);
}

TEST(Polygon, PlaneHasTheCornersOnItAndTheFrontCounterClockwise) {
  const Plane plane = plane_through(unit_square());

  EXPECT_EQ(plane.normal, Vec3::UnitZ());
  EXPECT_EQ(plane.distance(Vec3(5, 5, 2)), 2);
}

}  // namespace
}  // namespace luxel
