#include "form_factors/working_frame.h"

#include <cmath>
#include <limits>

namespace luxel {

WorkingFrame working_frame(const PatchMesh& mesh) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 low = Vec3::Constant(infinity), high = -low;
  for (int p = 0; p < mesh.size(); ++p) {
    for (int k = 0; k < mesh.corner_count(p); ++k) {
      low = low.cwiseMin(mesh.vertices[mesh.corners[p][k]]);
      high = high.cwiseMax(mesh.vertices[mesh.corners[p][k]]);
    }
  }
  if (mesh.size() == 0) low = high = Vec3::Zero();
  WorkingFrame frame;
  frame.centre = 0.5 * (low + high);
  int exponent = 1;
  const double diagonal = (high - low).norm();
  if (diagonal > 0) std::frexp(diagonal, &exponent);
  frame.scale = std::ldexp(1.0, 1 - exponent);
  return frame;
}

WorkPatch work_patch(const PatchMesh& mesh, int patch, const WorkingFrame& frame) {
  WorkPatch result;
  result.outline.count = mesh.corner_count(patch);
  for (int k = 0; k < result.outline.count; ++k) {
    result.outline.corners[k] = frame(mesh.vertices[mesh.corners[patch][k]]);
  }
  result.plane = plane_through(result.outline);
  result.centroid = centroid(result.outline);
  result.area = area(result.outline, result.plane.normal);
  result.edge = longest_edge(result.outline);
  result.patch = patch;
  return result;
}

}  // namespace luxel
