#include "transport/gather/patch_frame.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace luxel {

namespace {

// In the ray scene's coordinates, whose diagonal lies in [1, 2): above the rounding of a float coordinate
// (6e-8) and of a plane through such corners, below gaps of 1e-6.
constexpr double surface_offset = 4e-7;

// Above what float moves an origin along its patch.
constexpr double margin = 1e-6;

// Quads whose fourth corner is this close to a parallelogram's are one: within what float moves it, and a
// share of the patch that light does not feel.
constexpr double skew = 1e-7, relative_skew = 1e-4;

}  // namespace

double outline_margin(const RayScene& occluders) {
  return margin / occluders.scale();
}

PatchFrame patch_frame(const PatchMesh& mesh, int patch, const RayScene& occluders) {
  const auto& corners = mesh.corners[patch];
  const int count = mesh.corner_count(patch);
  const auto local = [&](const Vec3& x) -> Vec3 { return (x - occluders.centre()) * occluders.scale(); };
  const Vec3 centroid = local(mesh.centroids[patch]);
  const Vec3 corner = local(mesh.vertices[corners[0]]);
  PatchFrame frame;
  frame.normal = mesh.normals[patch];
  frame.first = local(mesh.vertices[corners[1]]) - corner;
  frame.second = local(mesh.vertices[corners[2]]) - corner;
  frame.third = count == 4 ? Vec3(local(mesh.vertices[corners[3]]) - corner) : Vec3::Zero();
  const double skewness = (frame.second - frame.first - frame.third).squaredNorm();
  frame.parallelogram = count == 4 && skewness <= std::min(skew * skew, relative_skew * relative_skew *
                                                                            frame.second.squaredNorm());
  // from the centroid to the nearest edge: a third of a triangle's least height, half a parallelogram's
  double clearance;
  const double longer =
      std::max(frame.first.squaredNorm(), (count == 3 ? frame.second : frame.third).squaredNorm());
  if (count == 3) {
    frame.share = 1;
    const double longest = std::max(longer, (frame.second - frame.first).squaredNorm());
    clearance = std::sqrt(frame.first.cross(frame.second).squaredNorm() / longest) / 3;
  } else if (frame.parallelogram) {
    frame.share = 0.5;
    clearance = std::sqrt(frame.first.cross(frame.third).squaredNorm() / longer) / 2;
  } else {
    const double in_first = frame.first.cross(frame.second).norm();
    frame.share = in_first / (in_first + frame.second.cross(frame.third).norm());
    clearance = std::numeric_limits<double>::infinity();
    const std::array<Vec3, 4> from_corner{Vec3::Zero(), frame.first, frame.second, frame.third};
    for (int k = 0; k < count; ++k) {
      const Vec3 edge = from_corner[(k + 1) % count] - from_corner[k];
      clearance = std::min(clearance, edge.cross(centroid - corner - from_corner[k]).norm() / edge.norm());
    }
  }
  const double shrink = clearance > margin ? margin / clearance : 1;
  frame.corner = corner + shrink * (centroid - corner) + surface_offset * frame.normal;
  frame.first *= 1 - shrink;
  frame.second *= 1 - shrink;
  frame.third *= 1 - shrink;
  return frame;
}

}  // namespace luxel
