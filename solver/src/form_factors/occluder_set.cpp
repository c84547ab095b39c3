#include "form_factors/occluder_set.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace luxel {

namespace {

// The triangles of each polygon.
std::vector<std::vector<std::array<int, 3>>> by_polygon(const Occluders& occluders) {
  std::vector<std::vector<std::array<int, 3>>> polygons(occluders.polygon_count);
  for (std::size_t k = 0; k < occluders.triangles.size(); ++k) {
    polygons[occluders.polygons[k]].push_back(occluders.triangles[k]);
  }
  return polygons;
}

// The plane that fits a flat polygon's triangles best: mean normal weighted by area, through the mean corner.
Plane fitted_plane(std::span<const Vec3> vertices, std::span<const std::array<int, 3>> triangles) {
  Vec3 normal = Vec3::Zero(), moment = Vec3::Zero();
  double total = 0;
  for (const auto& t : triangles) {
    const Vec3 &a = vertices[t[0]], &b = vertices[t[1]], &c = vertices[t[2]];
    const Vec3 twice = (b - a).cross(c - a);
    const double weight = twice.norm();
    normal += twice;
    moment += weight * (a + b + c) / 3;
    total += weight;
  }
  if (!(total > 0) || !(normal.norm() > 0)) return {Vec3::Zero(), 0};
  normal.normalize();
  return {normal, normal.dot(moment / total)};
}

// Whether the scene has points on both sides of the plane.
bool splits(const Plane& plane, std::span<const Vec3> points) {
  bool front = false, behind = false;
  for (const Vec3& x : points) {
    const double distance = plane.distance(x);
    front |= distance > side_tolerance;
    behind |= distance < -side_tolerance;
    if (front && behind) return true;
  }
  return false;
}

// Every vertex that one of the first patches has, once, in working coordinates.
std::vector<Vec3> corners_of_patches(const PatchMesh& mesh, int patches, const WorkingFrame& frame) {
  std::vector<char> used(mesh.vertices.size());
  for (int p = 0; p < patches; ++p) {
    for (int k = 0; k < mesh.corner_count(p); ++k) used[mesh.corners[p][k]] = 1;
  }
  std::vector<Vec3> corners;
  for (std::size_t k = 0; k < used.size(); ++k) {
    if (used[k]) corners.push_back(frame(mesh.vertices[k]));
  }
  return corners;
}

}  // namespace

OccluderFace occluder_face(const Polygon& outline, const Plane& plane, int polygon) {
  OccluderFace face{outline, plane, {}, Vec3::Zero(), 0, polygon};
  for (int k = 0; k < outline.count; ++k) {
    const Vec3 along = (outline.next(k) - outline[k]).normalized();
    const Vec3 inward = plane.normal.cross(along);
    face.sides[k] = {inward, inward.dot(outline[k])};
    face.centre += outline[k] / outline.count;
  }
  for (int k = 0; k < outline.count; ++k) {
    face.radius = std::max(face.radius, (outline[k] - face.centre).norm());
  }
  return face;
}

OccluderSet occluder_set(const PatchMesh& mesh, const WorkingFrame& frame, bool keep_idle) {
  std::vector<Vec3> vertices;
  vertices.reserve(mesh.occluders.vertices.size());
  for (const Vec3& x : mesh.occluders.vertices) vertices.push_back(frame(x));
  std::vector<Vec3> corners;
  if (!keep_idle) corners = corners_of_patches(mesh, mesh.size(), frame);

  OccluderSet set;
  const auto polygons = by_polygon(mesh.occluders);
  for (std::size_t polygon = 0; polygon < polygons.size(); ++polygon) {
    if (polygons[polygon].empty()) continue;
    const Plane plane = fitted_plane(vertices, polygons[polygon]);
    if (plane.normal.isZero()) continue;
    for (const Polygon& piece : convex_pieces(vertices, polygons[polygon], plane.normal)) {
      if (piece.count >= 3) set.faces.push_back(occluder_face(piece, plane, static_cast<int>(polygon)));
    }
  }
  set.occluders = join_bodies(set.faces, mesh, frame);
  if (keep_idle) return set;
  std::erase_if(set.occluders, [&](const Occluder& occluder) {
    return !occluder.body() && !splits(set.faces[occluder.begin].plane, corners);
  });
  return set;
}

OccluderSet occluder_set(const PatchMesh& mesh, const ClusterTree& tree, bool keep_idle) {
  const WorkingFrame frame{tree.centre, tree.scale};
  OccluderSet set = occluder_set(mesh, frame, keep_idle);
  if (keep_idle || tree.sky_begin == mesh.size()) return set;
  const std::vector<Vec3> corners = corners_of_patches(mesh, tree.sky_begin, frame);
  for (Occluder& occluder : set.occluders) {
    occluder.idle = !occluder.body() && !splits(set.faces[occluder.begin].plane, corners);
  }
  return set;
}

}  // namespace luxel
