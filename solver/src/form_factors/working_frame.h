#pragma once

#include "form_factors/polygon.h"
#include "luxel/patch_mesh.h"

namespace luxel {

/// Working coordinates, (x - centre) * scale: centred on the patches, their diagonal in [1, 2).
struct WorkingFrame {
  Vec3 centre = Vec3::Zero();
  double scale = 1;  ///< a power of two [1/m]
  Vec3 operator()(const Vec3& x) const { return (x - centre) * scale; }
};

WorkingFrame working_frame(const PatchMesh& mesh);

/// A patch in working coordinates, in the plane of its own corners.
WorkPatch work_patch(const PatchMesh& mesh, int patch, const WorkingFrame& frame);

}  // namespace luxel
