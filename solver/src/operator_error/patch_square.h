#pragma once

#include "luxel/patch_mesh.h"

namespace luxel {

/// The unit square laid over a patch, area for area.
class PatchSquare {
 public:
  PatchSquare(const PatchMesh& mesh, int patch);

  /// The point of the patch [m] for (s, t) in the unit square.
  Vec3 operator()(double s, double t) const;

 private:
  Vec3 corner_, first_, second_, third_;  // and from the corner to the others
  double share_;                          // of the area in the triangle corner, first, second
};

}  // namespace luxel
