#include "form_factors/polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <stdexcept>

namespace luxel {

Vec3 area_vector(const Polygon& polygon) {
  Vec3 twice = Vec3::Zero();
  for (int k = 1; k + 1 < polygon.count; ++k) {
    twice += (polygon[k] - polygon[0]).cross(polygon[k + 1] - polygon[0]);
  }
  return 0.5 * twice;
}

double area(const Polygon& polygon, const Vec3& normal) {
  return area_vector(polygon).dot(normal);
}

Vec3 centroid(const Polygon& polygon) {
  Vec3 mean = Vec3::Zero();
  for (int k = 0; k < polygon.count; ++k) mean += polygon[k];
  mean /= polygon.count;
  const Vec3 normal = area_vector(polygon);
  Vec3 moment = Vec3::Zero();
  double total = 0;
  for (int k = 0; k < polygon.count; ++k) {
    const Vec3 p = polygon[k] - mean, q = polygon.next(k) - mean;
    const double weight = p.cross(q).dot(normal);
    moment += weight * (p + q);
    total += weight;
  }
  if (total > 0) mean += moment / (3 * total);
  return mean;
}

double longest_edge(const Polygon& polygon) {
  double longest = 0;
  for (int k = 0; k < polygon.count; ++k) {
    longest = std::max(longest, (polygon.next(k) - polygon[k]).squaredNorm());
  }
  return std::sqrt(longest);
}

Plane plane_through(const Polygon& polygon) {
  Vec3 normal = area_vector(polygon);
  const double length = normal.norm();
  normal = length > 0 ? Vec3(normal / length) : Vec3::UnitZ();
  double offset = 0;
  for (int k = 0; k < polygon.count; ++k) offset += normal.dot(polygon[k]);
  return {normal, offset / polygon.count};
}

Span span_along(const Polygon& polygon, const Plane& plane) {
  Span span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (int k = 0; k < polygon.count; ++k) {
    const double distance = plane.distance(polygon[k]);
    span.low = std::min(span.low, distance);
    span.high = std::max(span.high, distance);
  }
  return span;
}

Polygon clip(const Polygon& polygon, const Plane& plane, double tolerance) {
  std::array<double, Polygon::capacity> distance;
  for (int k = 0; k < polygon.count; ++k) distance[k] = plane.distance(polygon[k]);
  Polygon kept;
  auto add = [&kept](const Vec3& corner) {
    if (kept.count == Polygon::capacity) throw std::length_error("clipped polygon has too many corners");
    kept.corners[kept.count++] = corner;
  };
  for (int k = 0; k < polygon.count; ++k) {
    const double here = distance[k], there = distance[k + 1 < polygon.count ? k + 1 : 0];
    if (here >= -tolerance) add(polygon[k]);
    const bool crosses = (here > tolerance && there < -tolerance) || (here < -tolerance && there > tolerance);
    if (crosses) add(polygon[k] + (here / (here - there)) * (polygon.next(k) - polygon[k]));
  }
  if (kept.count < 3) kept.count = 0;
  return kept;
}

}  // namespace luxel
