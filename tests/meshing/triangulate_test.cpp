#include "triangulate.h"

#include <gtest/gtest.h>

#include "ear_clipping.h"

namespace luxel {
namespace {

double area(const std::vector<Vec2>& points, const std::vector<std::array<int, 3>>& triangles) {
  double sum = 0;
  for (const auto& [a, b, c] : triangles) {
    const Vec2 u = points[b] - points[a];
    const Vec2 v = points[c] - points[a];
    const double doubled = u.x() * v.y() - u.y() * v.x();
    EXPECT_GT(doubled, 0);
    sum += doubled / 2;
  }
  return sum;
}

void append_loop(PlanarDomain& domain, const std::vector<Vec2>& loop) {
  const int first = static_cast<int>(domain.points.size());
  const int count = static_cast<int>(loop.size());
  domain.points.insert(domain.points.end(), loop.begin(), loop.end());
  for (int k = 0; k < count; ++k) domain.borders.push_back({first + k, first + (k + 1) % count});
}

/// A square of side 5 with two square holes of side 1.
PlanarDomain square_with_holes() {
  PlanarDomain domain;
  append_loop(domain, {{0, 0}, {5, 0}, {5, 5}, {0, 5}});
  append_loop(domain, {{1, 1}, {1, 2}, {2, 2}, {2, 1}});
  append_loop(domain, {{3, 2}, {3, 3}, {4, 3}, {4, 2}});
  return domain;
}

TEST(ClipEars, CoversAConcaveLoopWithAStraightCorner) {
  const std::vector<Vec2> loop = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};

  EXPECT_DOUBLE_EQ(area(loop, clip_ears(loop)), 3);
}

TEST(ClipEars, SurvivesALoopThatCrossesItself) {
  const std::vector<Vec2> bow_tie = {{0, 0}, {2, 2}, {2, 0}, {0, 1}};

  EXPECT_LE(clip_ears(bow_tie).size(), 2u);
}

TEST(TriangulateByEars, CoversAPolygonWithHoles) {
  const PlanarDomain domain = square_with_holes();

  const auto triangles = triangulate_by_ears(domain);

  ASSERT_TRUE(triangles);
  EXPECT_DOUBLE_EQ(area(domain.points, *triangles), 23);
  EXPECT_EQ(triangles->size(), 14u);  // Euler: corners + 2 holes - 2, holes' bridges counted twice
}

TEST(Triangulate, CoversAPolygonWithHoles) {
  const PlanarDomain domain = square_with_holes();

  const auto triangles = triangulate(domain);

  ASSERT_TRUE(triangles);
  EXPECT_DOUBLE_EQ(area(domain.points, *triangles), 23);
}

TEST(Triangulate, RefusesABorderThatCrossesItself) {
  PlanarDomain domain;
  append_loop(domain, {{0, 0}, {4, 0}, {4, 4}, {1, -1}, {0, 3}});

  EXPECT_FALSE(triangulate(domain));
}

}  // namespace
}  // namespace luxel
