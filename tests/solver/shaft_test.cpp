#include "form_factors/shaft.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>

namespace luxel {
namespace {

Polygon quad(const Vec3& centre, const Vec3& u, const Vec3& v) {
  Polygon polygon;
  polygon.count = 4;
  polygon.corners[0] = centre - u - v;
  polygon.corners[1] = centre + u - v;
  polygon.corners[2] = centre + u + v;
  polygon.corners[3] = centre - u + v;
  return polygon;
}

ShaftEnd end_of(const Polygon& polygon) {
  const Vec3 centre = centroid(polygon);
  double radius = 0;
  for (int k = 0; k < polygon.count; ++k) radius = std::max(radius, (polygon[k] - centre).norm());
  return shaft_end(polygon, centre, radius);
}

Vec3 point_in(const Polygon& q, double s, double t) {
  return (1 - s) * (1 - t) * q[0] + s * (1 - t) * q[1] + s * t * q[2] + (1 - s) * t * q[3];
}

bool crosses(const OccluderFace& face, const Vec3& x, const Vec3& y) {
  const double a = face.plane.distance(x), b = face.plane.distance(y);
  if (a * b >= 0) return false;
  const Vec3 at = x + a / (a - b) * (y - x);
  for (int k = 0; k < face.outline.count; ++k) {
    if (face.sides[k].distance(at) < 0) return false;
  }
  return true;
}

TEST(FaceInShaft, NeverContradictsALineOfSight) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  auto vector = [&](double size) -> Vec3 {
    return size * Vec3(2 * unit(random) - 1, 2 * unit(random) - 1, 2 * unit(random) - 1);
  };
  auto any_quad = [&](double size) {
    const Vec3 u = vector(size), normal = u.cross(vector(1)).normalized();
    return quad(vector(0.4), u, unit(random) * size * normal.cross(u.normalized()));
  };
  int missed = 0, hidden = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Polygon a = any_quad(0.15), b = any_quad(0.15), outline = any_quad(0.6);
    if (area_vector(outline).norm() < 1e-6) continue;
    const OccluderFace face = occluder_face(outline, plane_through(outline), 0);

    const FaceInShaft verdict = face_in_shaft(end_of(a), end_of(b), face);

    missed += verdict.misses();
    hidden += verdict.hides;
    if (!verdict.misses() && !verdict.hides) continue;
    for (int k = 0; k < 50; ++k) {
      const Vec3 x = point_in(a, unit(random), unit(random)), y = point_in(b, unit(random), unit(random));
      EXPECT_EQ(crosses(face, x, y), verdict.hides);
    }
  }
  EXPECT_GT(missed, 300);  // the test has met both verdicts
  EXPECT_GT(hidden, 30);
}

TEST(SphereInShaft, HoldsEveryLineThatMeetsTheSphere) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  int inside = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    auto point = [&] { return Vec3(unit(random), unit(random), unit(random)); };
    const Polygon a = quad(point(), {0.2, 0, 0}, {0, 0.1, 0}), b = quad(point(), {0, 0.1, 0}, {0, 0, 0.3});
    const Vec3 centre = point(), x = point_in(a, 0.9, 0.2), y = point_in(b, 0.1, 0.7), along = y - x;
    const double t = std::clamp((centre - x).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double distance = (x + t * along - centre).norm();

    // a sphere that just reaches the line
    inside += sphere_in_shaft(end_of(a), end_of(b), centre, distance * (1 + 1e-12));
  }
  EXPECT_EQ(inside, 2000);
}

}  // namespace
}  // namespace luxel
