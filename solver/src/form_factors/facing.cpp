#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "form_factors/cluster_tree.h"

namespace luxel {

namespace {

// Two patches whose normals differ by the angle t exchange at most cos cos <= t^2 / 4 of a solid angle: where
// both look the same way, n_i . d + n_j . (-d) <= t |d|, so the smaller of the two cosines is at most t / 2.
constexpr double same_way = 1e-5;

// Largest height of a point at `offset` from the cluster's centre over a plane through the centre whose
// normal lies in the cone: the support function of the cone.
double support(const Cluster& cluster, const Vec3& offset) {
  const double along = cluster.plane.normal.dot(offset);
  if (cluster.planar) return along;
  const double square = offset.squaredNorm(), length = std::sqrt(square);
  if (cluster.cone_cosine <= 0 || along >= length * cluster.cone_cosine) return length;
  return along * cluster.cone_cosine + std::sqrt(std::max(square - along * along, 0.0)) * cluster.cone_sine;
}

}  // namespace

Span heights_over(const Cluster& a, const Cluster& b) {
  const double rounding = a.thickness + b.thickness;
  Span span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (int k = 0; k < b.hull.count; ++k) {
    const Vec3 offset = b.hull[k] - a.centre;
    span.low = std::min(span.low, -support(a, -offset) + a.setback.low - rounding);
    span.high = std::max(span.high, support(a, offset) + a.setback.high + rounding);
  }
  return span;
}

bool may_face(const Cluster& a, const Cluster& b) {
  const double apart = (a.plane.normal - b.plane.normal).norm();
  if (apart + a.cone + b.cone <= same_way) return false;
  return heights_over(a, b).high > plane_tolerance && heights_over(b, a).high > plane_tolerance;
}

}  // namespace luxel
