#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "form_factors/pair.h"
#include "luxel/form_factors.h"

namespace luxel {

namespace {

void require_polygon(std::span<const Vec3> corners) {
  if (corners.size() < 3 || corners.size() > 8) {
    throw std::invalid_argument("a polygon has 3 to 8 corners, not " + std::to_string(corners.size()));
  }
}

Polygon polygon_of(std::span<const Vec3> corners, const Vec3& origin, double scale) {
  Polygon polygon;
  for (const Vec3& corner : corners) polygon.corners[polygon.count++] = (corner - origin) * scale;
  return polygon;
}

double reach_from(const Vec3& origin, std::span<const Vec3> corners) {
  double reach = 0;
  for (const Vec3& corner : corners) reach = std::max(reach, (corner - origin).norm());
  return reach;
}

double radius_about(const Polygon& polygon, const Vec3& centre) {
  double radius = 0;
  for (int k = 0; k < polygon.count; ++k) radius = std::max(radius, (polygon[k] - centre).norm());
  return radius;
}

// Gauss points along a side for a relative error of 1e-13 where the kernel's nearest singularity is
// `distance` from a patch of half-diameter `radius`: the Bernstein ellipse through it.
int order_for(double distance, double radius) {
  constexpr double log_error = 30;  // -ln 1e-13
  const double x = std::max(distance / std::max(radius, 1e-300), 1e-3);
  const double rate = std::log(x + std::sqrt(x * x + 1));
  return std::clamp(static_cast<int>(std::ceil(log_error / (2 * rate))) + 1, 2, 12);
}

// Corners nearer to a plane than rounding lie on it; lengths are at most 1.
constexpr double on_plane = 4e-16;

// Beyond this ratio of sizes the contour integral of touching polygons loses digits: the larger one is
// halved.
constexpr double largest_ratio = 32;

// The polygon's two halves across its longest diameter.
std::pair<Polygon, Polygon> halves(const Polygon& polygon) {
  Vec3 diameter = Vec3::Zero();
  for (int i = 0; i < polygon.count; ++i) {
    for (int j = 0; j < i; ++j) {
      const Vec3 d = polygon[i] - polygon[j];
      if (d.squaredNorm() > diameter.squaredNorm()) diameter = d;
    }
  }
  const Vec3 normal = diameter.normalized();
  const Plane middle{normal, normal.dot(centroid(polygon))};
  return {clip(polygon, middle, 0), clip(polygon, middle.flipped(), 0)};
}

// Exchange area of polygons in front of each other's plane.
double unclipped_exchange(const Polygon& p, const Plane& plane_p, const Polygon& q, const Plane& plane_q) {
  const double area_p = area(p, plane_p.normal), area_q = area(q, plane_q.normal);
  if (p.count == 0 || q.count == 0 || area_p <= 0 || area_q <= 0) return 0;
  const double radius_p = radius_about(p, centroid(p)), radius_q = radius_about(q, centroid(q));
  const double distance = gap(p, plane_p, q, plane_q);
  // Gauss rules converge from this many radii on.
  constexpr double smooth = 1.5;
  if (distance > smooth * std::max(radius_p, radius_q)) {
    const int order = order_for(distance, std::max(radius_p, radius_q));
    return point_exchange(p, plane_p.normal, q, plane_q.normal, order);
  }
  if (distance > smooth * radius_p)
    return lambert_exchange(p, plane_p.normal, q, order_for(distance, radius_p));
  if (distance > smooth * radius_q)
    return lambert_exchange(q, plane_q.normal, p, order_for(distance, radius_q));
  if (radius_q > largest_ratio * radius_p && q.count < Polygon::capacity) {
    const auto [first, second] = halves(q);
    return unclipped_exchange(p, plane_p, first, plane_q) + unclipped_exchange(p, plane_p, second, plane_q);
  }
  if (radius_p > largest_ratio * radius_q && p.count < Polygon::capacity) {
    return unclipped_exchange(q, plane_q, p, plane_p);
  }
  // 1e-12 of the exchange area, which grazing pairs may have down to 1e-3 of the smaller area.
  return contour_exchange(p, q, 1e-15 * std::min(area_p, area_q));
}

}  // namespace

double exchange_area(std::span<const Vec3> a, std::span<const Vec3> b) {
  require_polygon(a);
  require_polygon(b);
  // The smaller polygon sits at the origin, where its corners keep all their digits.
  if (reach_from(a[0], a) > reach_from(b[0], b)) std::swap(a, b);
  const double reach = std::max(reach_from(a[0], a), reach_from(a[0], b));
  if (!(reach > 0) || !std::isfinite(reach)) return 0;
  int exponent = 0;
  std::frexp(reach, &exponent);
  const double scale = std::ldexp(1.0, -exponent);
  const Polygon p = polygon_of(a, a[0], scale), q = polygon_of(b, a[0], scale);
  const Plane plane_p = plane_through(p), plane_q = plane_through(q);
  if (span_along(p, plane_q).high <= on_plane || span_along(q, plane_p).high <= on_plane) return 0;
  const double value =
      unclipped_exchange(clip(p, plane_q, on_plane), plane_p, clip(q, plane_p, on_plane), plane_q);
  return std::max(value, 0.0) / (scale * scale);
}

double point_form_factor(const Vec3& point, const Vec3& normal, std::span<const Vec3> polygon) {
  require_polygon(polygon);
  const Polygon moved = polygon_of(polygon, point, 1);
  if (plane_through(moved).distance(Vec3::Zero()) <= 0) return 0;
  double reach = 0;
  for (int k = 0; k < moved.count; ++k) reach = std::max(reach, moved[k].norm());
  const Polygon seen = clip(moved, {normal, 0}, 1e-15 * reach);
  double sum = 0;
  for (int k = 0; k < seen.count; ++k) {
    const Vec3 across = seen.next(k).cross(seen[k]);
    const double length = across.norm();
    if (length > 0) sum += std::atan2(length, seen[k].dot(seen.next(k))) / length * across.dot(normal);
  }
  return std::max(sum, 0.0) / (2 * std::numbers::pi);
}

}  // namespace luxel
