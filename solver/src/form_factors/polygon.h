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
};

/// The plane normal . x = offset; the front is where the signed distance is positive.
struct Plane {
  Vec3 normal = Vec3::UnitZ();
  double offset = 0;
  double distance(const Vec3& x) const { return normal.dot(x) - offset; }
};

/// A patch in working coordinates: centred on the scene and scaled by a power of two so that the scene's
/// diagonal lies in [1, 2); tolerances are then plain numbers.
struct WorkPatch {
  Polygon outline;
  Plane plane;
  Vec3 centroid;
  double area = 0;
  double edge = 0;  ///< longest
  int patch = 0;    ///< index in the PatchMesh
};

}  // namespace luxel
