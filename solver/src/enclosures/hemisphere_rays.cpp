#include "enclosures/hemisphere_rays.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sampling/owen_sobol.h"

namespace luxel {

namespace {

double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b - a).cross(c - a).norm() / 2;
}

/// Distance of the centroid from the outline [m].
double clearance(const PatchMesh& mesh, int patch) {
  double nearest = std::numeric_limits<double>::infinity();
  const int count = mesh.corner_count(patch);
  for (int k = 0; k < count; ++k) {
    const Vec3& a = mesh.vertices[mesh.corners[patch][k]];
    const Vec3 edge = mesh.vertices[mesh.corners[patch][(k + 1) % count]] - a;
    nearest = std::min(nearest, edge.cross(mesh.centroids[patch] - a).norm() / edge.norm());
  }
  return nearest;
}

}  // namespace

double drawn_in(const PatchMesh& mesh, int patch, double margin) {
  const double room = clearance(mesh, patch);
  return room > margin ? margin / room : 1;
}

HemisphereRays hemisphere_rays(const PatchMesh& mesh, int patch, int count, std::uint64_t seed,
                               double margin) {
  const auto& corners = mesh.corners[patch];
  const Vec3& a = mesh.vertices[corners[0]];
  const Vec3& b = mesh.vertices[corners[1]];
  const Vec3& c = mesh.vertices[corners[2]];
  const Vec3& d = mesh.vertices[corners[3] < 0 ? corners[2] : corners[3]];
  const double first = triangle_area(a, b, c), second = triangle_area(a, c, d);
  const double share = first / (first + second);
  const Vec3& normal = mesh.normals[patch];
  const Vec3 tangent = normal.unitOrthogonal();
  const Vec3 bitangent = normal.cross(tangent);
  const double shrink = drawn_in(mesh, patch, margin);

  HemisphereRays rays;
  rays.origins.reserve(count);
  rays.directions.reserve(count);
  rays.normals.assign(count, normal);
  const OwenSobol4 sequence(seed);
  for (int k = 0; k < count; ++k) {
    auto [s, t, azimuth, height] = sequence(k);
    const bool in_first = s < share;
    s = in_first ? s / share : (s - share) / (1 - share);
    const Vec3& e = in_first ? b : c;
    const Vec3& f = in_first ? c : d;
    const double root = std::sqrt(s);
    const Vec3 x = a + root * ((1 - t) * (e - a) + t * (f - a));
    rays.origins.push_back(x + shrink * (mesh.centroids[patch] - x));
    // Malley: uniform on the disc below is cosine-distributed above; half a step up from the horizon, which
    // no ray may run along
    const double radius = std::sqrt(std::min(height, 1 - 0x1p-33));
    const double angle = 2 * std::numbers::pi * azimuth;
    rays.directions.push_back(radius * std::cos(angle) * tangent + radius * std::sin(angle) * bitangent +
                              std::sqrt(1 - radius * radius) * normal);
  }
  return rays;
}

}  // namespace luxel
