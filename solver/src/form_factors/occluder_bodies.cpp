#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "form_factors/occluder_set.h"

namespace luxel {

namespace {

// A body is convex when no corner rises further above a face than this, in working coordinates.
constexpr double convex_tolerance = 1e-9;

// A patch may reach into a body, or touch it, with this share of its area: what rounding leaves of a common
// edge.
constexpr double touching_share = 1e-7;

using Key = std::array<double, 3>;
using Edge = std::pair<Key, Key>;

Key key(const Vec3& x) {
  return {x.x(), x.y(), x.z()};
}

int root_of(std::vector<int>& parent, int k) {
  while (parent[k] != k) k = parent[k] = parent[parent[k]];
  return k;
}

// Directed edges and the face on their left; -1 where more than one face claims an edge.
std::map<Edge, int> edges_of(const std::vector<OccluderFace>& faces) {
  std::map<Edge, int> left;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Polygon& outline = faces[f].outline;
    for (int k = 0; k < outline.count; ++k) {
      const auto [found, fresh] =
          left.try_emplace(Edge{key(outline[k]), key(outline.next(k))}, static_cast<int>(f));
      if (!fresh) found->second = -1;
    }
  }
  return left;
}

bool convex(const std::vector<OccluderFace>& faces, const std::vector<int>& members) {
  for (int f : members) {
    for (int g : members) {
      if (span_along(faces[g].outline, faces[f].plane).high > convex_tolerance) return false;
    }
  }
  return true;
}

// Whether the patch has more than an edge in common with the convex body, its surface included.
bool reaches_into(const WorkPatch& patch, std::span<const OccluderFace> body) {
  Polygon rest = patch.outline;
  for (const OccluderFace& face : body) {
    if (rest.count + 1 >= Polygon::capacity) return true;
    rest = clip(rest, Plane{-face.plane.normal, -face.plane.offset - side_tolerance}, 0);
    if (rest.count == 0) return false;
  }
  return area(rest, patch.plane.normal) > touching_share * patch.area;
}

bool anything_inside(const Occluder& body, std::span<const OccluderFace> faces, const PatchMesh& mesh,
                     const WorkingFrame& frame) {
  for (int p = 0; p < mesh.size(); ++p) {
    const Vec3 middle = frame(mesh.centroids[p]);
    double radius = 0;
    for (int k = 0; k < mesh.corner_count(p); ++k) {
      radius = std::max(radius, (frame(mesh.vertices[mesh.corners[p][k]]) - middle).squaredNorm());
    }
    const double reach = body.radius + std::sqrt(radius) + side_tolerance;
    if ((middle - body.centre).squaredNorm() > reach * reach) continue;
    const WorkPatch patch = work_patch(mesh, p, frame);
    const bool own = std::any_of(faces.begin(), faces.end(),
                                 [&](const auto& face) { return face.polygon == mesh.polygons[p]; });
    // a second sheet back to back with a face of the body looks into it
    const bool outward =
        own && std::any_of(faces.begin(), faces.end(), [&](const auto& face) {
          return face.polygon == mesh.polygons[p] && face.plane.normal.dot(patch.plane.normal) > 0.5;
        });
    if (!outward && reaches_into(patch, faces)) return true;
  }
  return false;
}

void bound(Occluder& occluder, std::span<const OccluderFace> faces) {
  occluder.centre.setZero();
  for (const OccluderFace& face : faces) occluder.centre += face.centre / static_cast<double>(faces.size());
  for (const OccluderFace& face : faces) {
    for (int k = 0; k < face.outline.count; ++k) {
      occluder.radius = std::max(occluder.radius, (face.outline[k] - occluder.centre).norm());
    }
  }
}

}  // namespace

std::vector<Occluder> join_bodies(std::vector<OccluderFace>& faces, const PatchMesh& mesh,
                                  const WorkingFrame& frame) {
  const auto left = edges_of(faces);
  std::vector<int> parent(faces.size());
  std::iota(parent.begin(), parent.end(), 0);
  std::vector<char> closed(faces.size(), 1);
  for (const auto& [edge, face] : left) {
    const auto other = left.find({edge.second, edge.first});
    if (face < 0 || other == left.end() || other->second < 0) {
      if (face >= 0) closed[face] = 0;
    } else {
      parent[root_of(parent, face)] = root_of(parent, other->second);
    }
  }
  // an edge that two faces claim closes neither
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Polygon& outline = faces[f].outline;
    for (int k = 0; k < outline.count; ++k) {
      if (left.at({key(outline[k]), key(outline.next(k))}) < 0) closed[f] = 0;
    }
  }
  std::map<int, std::vector<int>> components;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    components[root_of(parent, static_cast<int>(f))].push_back(static_cast<int>(f));
  }

  std::vector<OccluderFace> ordered;
  std::vector<Occluder> occluders;
  for (const auto& [name, members] : components) {
    const int begin = static_cast<int>(ordered.size());
    for (int f : members) ordered.push_back(faces[f]);
    const int end = static_cast<int>(ordered.size());
    Occluder body{begin, end, {}, Vec3::Zero(), 0};
    const std::span<const OccluderFace> own(ordered.data() + begin, members.size());
    bound(body, own);
    const bool whole = members.size() >= 4 && members.size() <= Occluder::max_faces &&
                       std::all_of(members.begin(), members.end(), [&](int f) { return closed[f]; }) &&
                       convex(faces, members) && !anything_inside(body, own, mesh, frame);
    if (!whole) {
      for (int f = begin; f < end; ++f) {
        occluders.push_back({f, f + 1, {}, ordered[f].centre, ordered[f].radius});
      }
      continue;
    }
    std::map<int, int> position;
    for (std::size_t k = 0; k < members.size(); ++k) position[members[k]] = static_cast<int>(k);
    for (std::size_t k = 0; k < members.size(); ++k) {
      const Polygon& outline = faces[members[k]].outline;
      for (int c = 0; c < outline.count; ++c) {
        const int neighbour = position.at(left.at({key(outline.next(c)), key(outline[c])}));
        if (static_cast<int>(k) < neighbour) {
          body.edges.push_back({outline[c], outline.next(c), static_cast<int>(k), neighbour});
        }
      }
    }
    occluders.push_back(std::move(body));
  }
  faces = std::move(ordered);
  return occluders;
}

}  // namespace luxel
