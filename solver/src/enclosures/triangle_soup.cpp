#include "enclosures/triangle_soup.h"

#include <algorithm>
#include <limits>

namespace luxel {

namespace {

// Rays start 2e-7 off their surface: sheets closer than twice that they cannot be trusted to tell apart.
constexpr double ray_resolution = 4e-7;

}  // namespace

TriangleSoup::TriangleSoup(const Occluders& occluders, const RayScene& frame)
    : triangles(occluders.triangles) {
  vertices.reserve(occluders.vertices.size());
  double largest = 0;
  for (const Vec3& x : occluders.vertices) {
    vertices.push_back((x - frame.centre()) * frame.scale());
    largest = std::max(largest, x.cwiseAbs().maxCoeff());
  }
  const double rounding = 8 * std::numeric_limits<double>::epsilon() * largest * frame.scale();
  tolerance = std::max(ray_resolution, 4 * rounding);
}

}  // namespace luxel
