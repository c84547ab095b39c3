#pragma once

#include <array>

#include "luxel/vector.h"

namespace luxel {

/// A flat convex polygon of at most `capacity` corners, on the stack: patches, and what clipping leaves of
/// them.
struct Polygon {
  static constexpr int capacity = 16;
  int count = 0;
  std::array<Vec3, capacity> corners;

  const Vec3& operator[](int k) const { return corners[k]; }
  const Vec3& next(int k) const { return corners[k + 1 < count ? k + 1 : 0]; }
};

/// The plane normal . x = offset; the front is where the signed distance is positive.
struct Plane {
  Vec3 normal = Vec3::UnitZ();
  double offset = 0;
  double distance(const Vec3& x) const { return normal.dot(x) - offset; }
  Plane flipped() const { return {-normal, -offset}; }
};

/// A patch in working coordinates: centred on the scene and scaled by a power of two so that the scene's
/// diagonal lies in [1, 2); tolerances are then plain numbers.
struct WorkPatch {
  Polygon outline;
  Plane plane;  ///< its coplanar group's, so that coplanar patches have one plane, bit for bit
  Vec3 centroid;
  double area = 0;
  double edge = 0;  ///< longest
  int patch = 0;    ///< index in the PatchMesh
};

/// Half the sum of the cross products around the outline: normal times area, right-handed.
Vec3 area_vector(const Polygon& polygon);

/// Area as seen along the unit `normal`; negative where the corners run the other way round.
double area(const Polygon& polygon, const Vec3& normal);

/// Centre of mass of the surface; the mean corner where the area is 0.
Vec3 centroid(const Polygon& polygon);

/// Length of the longest edge.
double longest_edge(const Polygon& polygon);

/// Plane through the corners, best in the sense of their area vector; +z through the corners where the area
/// is 0.
Plane plane_through(const Polygon& polygon);

/// Smallest and largest signed distance of the corners from the plane.
struct Span {
  double low = 0, high = 0;
};
Span span_along(const Polygon& polygon, const Plane& plane);

/// The part in front of the plane: corners nearer to it than `tolerance` count as on it and stay. Count 0
/// where no more than an edge is left.
/// @throws std::length_error if the result has more than Polygon::capacity corners (one more than before)
Polygon clip(const Polygon& polygon, const Plane& plane, double tolerance);

}  // namespace luxel
