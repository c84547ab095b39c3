#pragma once

#include "luxel/patch_mesh.h"
#include "luxel/ray_scene.h"

namespace luxel {

/// A patch in the coordinates of the ray scene, as rays start from it: drawn in by outline_margin() and
/// lifted off its plane, so that rounding to float puts no origin on the far side of a neighbour.
struct PatchFrame {
  Vec3 corner;
  Vec3 first, second, third;  ///< from the corner to the next ones; third = 0 for triangles
  double share;               ///< of the area in the triangle corner, first, second
  Vec3 normal;
  bool parallelogram;  ///< second = first + third
};

PatchFrame patch_frame(const PatchMesh& mesh, int patch, const RayScene& occluders);

/// How far origins keep off the outline of their patch [m].
double outline_margin(const RayScene& occluders);

}  // namespace luxel
