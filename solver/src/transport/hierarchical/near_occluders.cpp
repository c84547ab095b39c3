#include "transport/hierarchical/near_occluders.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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

// Calls test(face) for the faces that may stand between, of bodies whose spheres come within `reach` of the
// end's middle; stops where one holds. Round bodies count as `round`.
template <class Test>
bool any_face(const OccluderSet& occluders, const HidingCandidates& candidates, const BlockEnd& end,
              double reach, bool round, const Test& test) {
  for (const Candidate& candidate : candidates.list) {
    const Occluder& occluder = occluders.occluders[candidate.occluder];
    if ((occluder.centre - end.bounds.centre).norm() > reach + occluder.radius) continue;
    if (occluder.round()) {
      if (round) return true;
      continue;
    }
    for (int k = 0; k < occluder.face_count(); ++k) {
      if (!((candidate.from_a | candidate.from_b) >> k & 1)) continue;
      if (test(occluders.faces[occluder.begin + k])) return true;
    }
  }
  return false;
}

// From the middle of a flat end's rectangle along its axes to its sides.
struct Reach {
  double s, t;
};

double distance(const BlockEnd& end, const Reach& reach, const Vec3& x) {
  const Vec3 from = x - end.axes.middle;
  const double s = std::max(std::abs(end.axes.u.dot(from)) - reach.s, 0.0);
  const double t = std::max(std::abs(end.axes.v.dot(from)) - reach.t, 0.0);
  return std::hypot(s, t, end.bounds.plane.normal.dot(from));
}

}  // namespace

bool occluder_near(const OccluderSet& occluders, const HidingCandidates& candidates, const BlockEnd& end,
                   double radii) {
  const double near_enough = radii * end.bounds.radius;
  return any_face(occluders, candidates, end, near_enough, true,
                  [&](const OccluderFace& face) { return distance(face, end.bounds.centre) < near_enough; });
}

bool occluder_stands_on(const OccluderSet& occluders, const HidingCandidates& candidates, const BlockEnd& end,
                        double radii) {
  if (!end.bounds.planar) return false;
  const double near_enough = radii * end.bounds.radius;
  const Reach reach{std::numbers::sqrt3 * end.axes.spread_s, std::numbers::sqrt3 * end.axes.spread_t};
  return any_face(
      occluders, candidates, end, near_enough + end.bounds.radius, false, [&](const OccluderFace& face) {
        const Vec3* corners = face.outline.corners.data();
        return std::any_of(corners, corners + face.outline.count,
                           [&](const Vec3& corner) { return distance(end, reach, corner) < near_enough; });
      });
}

}  // namespace luxel
