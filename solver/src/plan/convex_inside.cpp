#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "luxel/plan.h"

namespace luxel {

namespace {

// Corners nearer to a polygon's plane than this share of the mesh's size lie on it: the same as
// side_tolerance of the occluders, above the noise of files with 10 digits.
constexpr double plane_share = 1e-10;

// Patches that cover their polygons have their area, up to the rounding of sums.
constexpr double area_share = 1e-9;

// Polygons times vertices that are looked at to prove convexity: a tenth of a second. Above, rays are
// cheaper.
constexpr double most_tests = 1e8;

struct PolygonPlane {
  Vec3 normal = Vec3::Zero();  ///< twice the area long, then unit
  Vec3 moment = Vec3::Zero();
  double weight = 0;
  double offset = 0;
};

std::vector<PolygonPlane> polygon_planes(const Occluders& occluders) {
  std::vector<PolygonPlane> planes(occluders.polygon_count);
  for (std::size_t t = 0; t < occluders.triangles.size(); ++t) {
    const auto& [i, j, k] = occluders.triangles[t];
    const Vec3 &a = occluders.vertices[i], &b = occluders.vertices[j], &c = occluders.vertices[k];
    const Vec3 twice = (b - a).cross(c - a);
    PolygonPlane& plane = planes[occluders.polygons[t]];
    plane.normal += twice;
    plane.moment += twice.norm() * (a + b + c) / 3;
    plane.weight += twice.norm();
  }
  for (PolygonPlane& plane : planes) {
    if (!(plane.weight > 0) || !(plane.normal.norm() > 0)) continue;
    plane.normal.normalize();
    plane.offset = plane.normal.dot(plane.moment / plane.weight);
  }
  return planes;
}

double size_of(const std::vector<Vec3>& points) {
  Eigen::AlignedBox3d box;
  for (const Vec3& x : points) box.extend(x);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

/// Whether each edge of a triangle is met by exactly one other triangle, the other way round.
bool edges_match(const Occluders& occluders) {
  std::map<std::pair<int, int>, int> directed;
  for (const auto& triangle : occluders.triangles) {
    for (int k = 0; k < 3; ++k) ++directed[{triangle[k], triangle[(k + 1) % 3]}];
  }
  return std::all_of(directed.begin(), directed.end(), [&](const auto& edge) {
    const auto other = directed.find({edge.first.second, edge.first.first});
    return edge.second == 1 && other != directed.end() && other->second == 1;
  });
}

/// Whether every patch looks to the front of its polygon, and together they cover them.
bool patches_cover(const PatchMesh& mesh, const std::vector<PolygonPlane>& planes) {
  double of_patches = 0, of_polygons = 0;
  for (int i = 0; i < mesh.size(); ++i) {
    if (!(mesh.normals[i].dot(planes[mesh.polygons[i]].normal) > 0)) return false;
    of_patches += mesh.areas[i];
  }
  for (const PolygonPlane& plane : planes) of_polygons += plane.weight / 2;
  return std::abs(of_patches - of_polygons) <= area_share * of_polygons;
}

}  // namespace

bool convex_inside(const PatchMesh& mesh) {
  const Occluders& occluders = mesh.occluders;
  const double tests = static_cast<double>(occluders.polygon_count) * occluders.vertices.size();
  if (mesh.size() == 0 || occluders.polygon_count < 4 || tests > most_tests || !edges_match(occluders)) {
    return false;
  }
  const std::vector<PolygonPlane> planes = polygon_planes(occluders);
  const double tolerance = plane_share * size_of(occluders.vertices);
  const auto in_front = [&](const PolygonPlane& plane) {
    return std::all_of(occluders.vertices.begin(), occluders.vertices.end(),
                       [&](const Vec3& x) { return plane.normal.dot(x) - plane.offset >= -tolerance; });
  };
  return std::all_of(planes.begin(), planes.end(), in_front) && patches_cover(mesh, planes);
}

int hiding_polygons(const PatchMesh& mesh) {
  const double tolerance = plane_share * size_of(mesh.vertices);
  const std::vector<PolygonPlane> planes = polygon_planes(mesh.occluders);
  return static_cast<int>(std::count_if(planes.begin(), planes.end(), [&](const PolygonPlane& plane) {
    bool front = false, behind = false;
    for (const Vec3& x : mesh.vertices) {
      const double height = plane.normal.dot(x) - plane.offset;
      front |= height > tolerance;
      behind |= height < -tolerance;
      if (front && behind) return true;
    }
    return false;
  }));
}

}  // namespace luxel
