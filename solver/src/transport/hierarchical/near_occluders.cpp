#include "transport/hierarchical/near_occluders.h"

#include <algorithm>
#include <cmath>

namespace luxel {

namespace {

// From a point to a convex face.
double distance(const OccluderFace& face, const Vec3& x) {
  const double height = face.plane.distance(x);
  const Vec3 foot = x - height * face.plane.normal;
  double aside = 0;  // squared, from the foot to the outline
  for (int k = 0; k < face.outline.count; ++k) {
    if (face.sides[k].distance(foot) >= 0) continue;
    const Vec3 along = face.outline.next(k) - face.outline[k];
    const double at = std::clamp((foot - face.outline[k]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double squared = (foot - face.outline[k] - at * along).squaredNorm();
    aside = aside == 0 ? squared : std::min(aside, squared);
  }
  return std::sqrt(height * height + aside);
}

}  // namespace

bool occluder_near(const OccluderSet& occluders, const HidingCandidates& candidates, const BlockEnd& end,
                   double radii) {
  const double near_enough = radii * end.bounds.radius;
  for (const Candidate& candidate : candidates.list) {
    const Occluder& occluder = occluders.occluders[candidate.occluder];
    if ((occluder.centre - end.bounds.centre).norm() > near_enough + occluder.radius) continue;
    if (occluder.round()) return true;
    for (int k = 0; k < occluder.face_count(); ++k) {
      if (!((candidate.from_a | candidate.from_b) >> k & 1)) continue;
      if (distance(occluders.faces[occluder.begin + k], end.bounds.centre) < near_enough) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace luxel
