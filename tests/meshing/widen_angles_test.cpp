#include "widen_angles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace luxel {
namespace {

#ifdef LUXEL_WITH_CGAL

constexpr double degree = M_PI / 180;
constexpr std::size_t any_number = 100'000;
constexpr double whole = std::numeric_limits<double>::infinity();

PlanarDomain loop(const std::vector<Vec2>& points) {
  PlanarDomain domain;
  domain.points = points;
  const int n = static_cast<int>(points.size());
  for (int k = 0; k < n; ++k) domain.borders.push_back({k, (k + 1) % n});
  return domain;
}

/// The domain with the points added; halved edges come last.
PlanarDomain with(PlanarDomain domain, const AddedPoints& added) {
  for (const auto& [a, b] : added.halved) {
    const int m = static_cast<int>(domain.points.size());
    domain.points.push_back(0.5 * (domain.points[a] + domain.points[b]));
    auto& edge = *std::find(domain.borders.begin(), domain.borders.end(), std::array<int, 2>{a, b});
    edge = {a, m};
    domain.borders.push_back({m, b});
  }
  domain.points.insert(domain.points.end(), added.inside.begin(), added.inside.end());
  return domain;
}

double smallest_angle(const PlanarDomain& domain) {
  double smallest = M_PI;
  const auto triangles = triangulate_delaunay(domain);
  for (const auto& t : *triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vec2 u = domain.points[t[(k + 1) % 3]] - domain.points[t[k]];
      const Vec2 v = domain.points[t[(k + 2) % 3]] - domain.points[t[k]];
      smallest = std::min(smallest, std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v)));
    }
  }
  return smallest;
}

TEST(WidenAngles, HalvesTheEdgesOfAStrip) {
  const PlanarDomain strip = loop({{0, 0}, {10, 0}, {10, 1}, {0, 1}});

  const AddedPoints added = widen_angles(strip, {0, 0, 0, 0}, 25 * degree, any_number);

  EXPECT_GE(smallest_angle(with(strip, added)), 25 * degree);
  EXPECT_LT(added.halved.size() + added.inside.size(), 40u);
}

TEST(WidenAngles, LeavesFixedEdgesWhole) {
  const PlanarDomain strip = loop({{0, 0}, {10, 0}, {10, 1}, {0, 1}});

  const AddedPoints added = widen_angles(strip, {whole, whole, whole, whole}, 25 * degree, any_number);

  EXPECT_TRUE(added.halved.empty());
}

TEST(WidenAngles, HalvesNoPartBelowTheLeastLength) {
  const PlanarDomain strip = loop({{0, 0}, {16, 0}, {16, 1}, {0, 1}});
  const auto shortest = [&](double least) {
    const PlanarDomain widened =
        with(strip, widen_angles(strip, {least, whole, least, whole}, 25 * degree, any_number));
    double length = 16;
    for (const auto& [a, b] : widened.borders) {
      if (widened.points[a].y() != widened.points[b].y()) continue;
      length = std::min(length, (widened.points[b] - widened.points[a]).norm());
    }
    return length;
  };

  EXPECT_LT(shortest(0), 4);
  EXPECT_EQ(shortest(4), 4);  // 16 is halved twice
  EXPECT_EQ(shortest(5), 8);
}

TEST(WidenAngles, LeavesGoodTrianglesAlone) {
  const PlanarDomain square = loop({{0, 0}, {1, 0}, {1, 1}, {0, 1}});

  const AddedPoints added = widen_angles(square, {0, 0, 0, 0}, 25 * degree, any_number);

  EXPECT_TRUE(added.halved.empty());
  EXPECT_TRUE(added.inside.empty());
}

TEST(WidenAngles, LeavesSharpCornersOfTheDomain) {
  const PlanarDomain wedge = loop({{0, 0}, {1, 0}, {1, std::tan(10 * degree)}});

  const AddedPoints added = widen_angles(wedge, {0, 0, 0}, 25 * degree, any_number);

  EXPECT_NEAR(smallest_angle(with(wedge, added)), 10 * degree, 1e-12);
}

TEST(WidenAngles, AddsNoMoreThanAllowed) {
  const PlanarDomain needle = loop({{0, 0}, {1, 0}, {1, 1e-6}, {0, 1e-6}});

  const AddedPoints added = widen_angles(needle, {0, 0, 0, 0}, 25 * degree, 50);

  EXPECT_EQ(added.halved.size() + added.inside.size(), 50u);
}

#endif

}  // namespace
}  // namespace luxel
