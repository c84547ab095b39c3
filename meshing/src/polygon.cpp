#include "polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace luxel {

namespace {

// A corner may be this far off the plane, as a share of the longest edge, for the polygon to count as flat.
constexpr double flatness = 1e-6;

// A polygon lower than this share of its longest edge is a line: slivers of aspect 1e6 are well above, the
// rounding of a cross product (1e-16) well below.
constexpr double smallest_height = 1e-12;

// Units in the last place that coordinates and their differences may be off: input rounding and transforms.
constexpr double rounding_units = 4;

// The sine of a turn below which a corner is straight: a patch with it would be a triangle with one corner
// too many.
constexpr double straight = 1e-9;

}  // namespace

Vec3 area_vector(std::span<const Vec3> loop) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) sum += (loop[i] - loop[0]).cross(loop[i + 1] - loop[0]);
  return 0.5 * sum;
}

Vec3 area_centroid(std::span<const Vec3> loop, const Vec3& area) {
  Vec3 moment = Vec3::Zero();
  double total = 0;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Vec3 a = loop[i] - loop[0];
    const Vec3 b = loop[i + 1] - loop[0];
    const double weight = a.cross(b).dot(area);
    moment += weight * (a + b);
    total += weight;
  }
  return loop[0] + moment / (3 * total);
}

double longest_edge(std::span<const Vec3> loop) {
  double longest = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    longest = std::max(longest, (loop[(i + 1) % loop.size()] - loop[i]).norm());
  }
  return longest;
}

double rounding(std::span<const Vec3> points) {
  double largest = 0;
  for (const Vec3& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return rounding_units * std::numeric_limits<double>::epsilon() * largest;
}

bool has_area(std::span<const Vec3> loop) {
  if (loop.size() < 3) return false;
  const double longest = longest_edge(loop);
  const double height = 2 * area_vector(loop).norm() / longest;
  return longest > 0 && height > std::max(smallest_height * longest, rounding(loop));
}

bool is_flat(std::span<const Vec3> loop) {
  if (loop.size() <= 3) return true;
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : loop) mean += p - loop[0];
  mean /= static_cast<double>(loop.size());
  const Vec3 normal = area_vector(loop).normalized();
  const double tolerance = flatness * longest_edge(loop) + rounding(loop);
  return std::all_of(loop.begin(), loop.end(),
                     [&](const Vec3& p) { return std::abs((p - loop[0] - mean).dot(normal)) <= tolerance; });
}

bool is_convex(std::span<const Vec3> loop) {
  const std::size_t n = loop.size();
  const Vec3 normal = area_vector(loop).normalized();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 in = loop[(i + 1) % n] - loop[i];
    const Vec3 out = loop[(i + 2) % n] - loop[(i + 1) % n];
    if (in.cross(out).dot(normal) <= straight * in.norm() * out.norm()) return false;
  }
  // Left turns only, but a star turns more than once: the angles of a quad cannot, and nothing longer is
  // asked.
  return true;
}

std::array<Vec3, 2> plane_axes(const Vec3& n) {
  int smallest = 0;
  n.cwiseAbs().minCoeff(&smallest);
  const Vec3 u = n.cross(Vec3::Unit(smallest)).normalized();
  return {u, n.cross(u)};
}

}  // namespace luxel
