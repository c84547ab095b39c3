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
  const double across = std::sqrt(std::max(offset.squaredNorm() - along * along, 0.0));
  if (std::atan2(across, along) <= cluster.cone) return offset.norm();
  return along * std::cos(cluster.cone) + across * std::sin(cluster.cone);
}

// Whether a point of b's hull may lie in front of a patch of a. The support function is convex up to cones of
// 90 degrees, so that its largest value is at a corner.
bool may_see(const Cluster& a, const Cluster& b) {
  if (a.cone >= 1.5) return true;
  for (int k = 0; k < b.hull.count; ++k) {
    if (support(a, b.hull[k] - a.centre) + a.setback + a.thickness + b.thickness > plane_tolerance)
      return true;
  }
  return false;
}

}  // namespace

bool may_face(const Cluster& a, const Cluster& b) {
  const double apart = (a.plane.normal - b.plane.normal).norm();
  if (apart + a.cone + b.cone <= same_way) return false;
  return may_see(a, b) && may_see(b, a);
}

Span heights_over(const Cluster& a, const Cluster& b) {
  Span span = span_along(b.hull, a.plane);
  const double rounding = a.thickness + b.thickness;
  return {span.low - rounding, span.high + rounding};
}

}  // namespace luxel
