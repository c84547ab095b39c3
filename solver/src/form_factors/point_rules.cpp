#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "form_factors/gauss.h"
#include "form_factors/near_kernels.h"
#include "form_factors/pair.h"

namespace luxel {

namespace {

void push(PointBatch& batch, const Vec3& x, const Vec3& w) {
  const int slot = batch.count++;
  batch.x[slot] = x[0], batch.y[slot] = x[1], batch.z[slot] = x[2];
  batch.wx[slot] = w[0], batch.wy[slot] = w[1], batch.wz[slot] = w[2];
}

// Tensor Gauss points of the bilinear patch a b c d (c = d: a triangle), weights times normal; full batches
// go to `use`.
template <class Use>
void bilinear_points(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& normal,
                     int order, PointBatch& batch, const Use& use) {
  const GaussRule rule = gauss_rule(order);
  for (int i = 0; i < order; ++i) {
    const double s = rule.nodes[i];
    for (int j = 0; j < order; ++j) {
      const double t = rule.nodes[j];
      const Vec3 along_s = (1 - t) * (b - a) + t * (c - d), along_t = (1 - s) * (d - a) + s * (c - b);
      const Vec3 x = a + s * ((1 - t) * (b - a) + t * (c - d)) + t * (d - a);
      const double weight = along_s.cross(along_t).dot(normal) * rule.weights[i] * rule.weights[j];
      if (batch.count == PointBatch::capacity) {
        use(batch);
        batch.count = 0;
      }
      push(batch, x, weight * normal);
    }
  }
}

template <class Use>
void points(const Polygon& polygon, const Vec3& normal, int order, const Use& use) {
  PointBatch batch;
  int k = 1;
  for (; k + 2 < polygon.count; k += 2) {
    bilinear_points(polygon[0], polygon[k], polygon[k + 1], polygon[k + 2], normal, order, batch, use);
  }
  if (k + 1 < polygon.count) {
    bilinear_points(polygon[0], polygon[k], polygon[k + 1], polygon[k + 1], normal, order, batch, use);
  }
  if (batch.count > 0) use(batch);
}

// Distance between the segments p + s u and q + t v, s and t in [0, 1]. Source: Ericson, Real-Time Collision
// Detection 2005, 5.1.9.
double segment_distance(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v) {
  const Vec3 r = p - q;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), ur = u.dot(r), vr = v.dot(r);
  double s = 0, t = 0;
  const double determinant = uu * vv - uv * uv;
  if (determinant > 1e-14 * uu * vv) s = std::clamp((uv * vr - ur * vv) / determinant, 0.0, 1.0);
  if (vv > 0) t = (uv * s + vr) / vv;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    if (uu > 0) s = std::clamp((t * uv - ur) / uu, 0.0, 1.0);
  }
  return (r + s * u - t * v).norm();
}

// Distance of the point from the polygon's plane if it stands above the polygon, else infinity.
double height_above(const Vec3& point, const Polygon& polygon, const Plane& plane) {
  for (int k = 0; k < polygon.count; ++k) {
    const Vec3 edge = polygon.next(k) - polygon[k];
    if (plane.normal.cross(edge).dot(point - polygon[k]) < 0) return std::numeric_limits<double>::infinity();
  }
  return std::abs(plane.distance(point));
}

}  // namespace

double point_exchange(const Polygon& a, const Vec3& normal_a, const Polygon& b, const Vec3& normal_b,
                      int order) {
  double sum = 0;
  points(a, normal_a, order, [&](const PointBatch& x) {
    points(b, normal_b, order, [&](PointBatch& y) { sum += point_pair_sum(x, y); });
  });
  return sum;
}

double lambert_exchange(const Polygon& a, const Vec3& normal_a, const Polygon& b, int order) {
  double sum = 0;
  points(a, normal_a, order, [&](PointBatch& x) { sum += lambert_sum(x, b); });
  return sum;
}

double gap(const Polygon& a, const Plane& plane_a, const Polygon& b, const Plane& plane_b) {
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < a.count; ++i) smallest = std::min(smallest, height_above(a[i], b, plane_b));
  for (int j = 0; j < b.count; ++j) smallest = std::min(smallest, height_above(b[j], a, plane_a));
  for (int i = 0; i < a.count; ++i) {
    for (int j = 0; j < b.count; ++j) {
      smallest = std::min(smallest, segment_distance(a[i], a.next(i) - a[i], b[j], b.next(j) - b[j]));
    }
  }
  return smallest;
}

}  // namespace luxel
