#pragma once

#include <array>
#include <vector>

#include "luxel/patch_mesh.h"
#include "luxel/ray_scene.h"

namespace luxel {

/// The occluders in the ray scene's coordinates, where the diagonal lies in [1, 2).
struct TriangleSoup {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  double tolerance = 0;  ///< things closer than this touch, as far as rays can tell

  TriangleSoup(const Occluders& occluders, const RayScene& frame);

  const Vec3& corner(int triangle, int k) const { return vertices[triangles[triangle][k]]; }
  int size() const { return static_cast<int>(triangles.size()); }
};

/// Each triangle has two sides: 2 t is the front of triangle t, 2 t + 1 its back.
inline int side_of(int triangle, bool front) {
  return 2 * triangle + (front ? 0 : 1);
}

}  // namespace luxel
