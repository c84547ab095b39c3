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

// Up to so many faces a body is tested for being convex: each against each.
constexpr std::size_t most_faces = 4096;

bool convex(const std::vector<OccluderFace>& faces, const std::vector<int>& members) {
  for (int f : members) {
    for (int g : members) {
      if (span_along(faces[g].outline, faces[f].plane).high > convex_tolerance) return false;
    }
  }
  return true;
}

// How many faces meet in each vertex.
std::map<Key, int> faces_at_vertices(const std::vector<OccluderFace>& faces) {
  std::map<Key, int> count;
  for (const OccluderFace& face : faces) {
    for (int k = 0; k < face.outline.count; ++k) ++count[key(face.outline[k])];
  }
  return count;
}

// The vertices of a body; empty where faces of something else meet in one of them.
std::vector<Vec3> own_vertices(std::span<const OccluderFace> body, const std::map<Key, int>& all) {
  const std::map<Key, int> own = faces_at_vertices({body.begin(), body.end()});
  std::vector<Vec3> vertices;
  for (const auto& [x, count] : own) {
    if (all.at(x) != count) return {};
    vertices.emplace_back(x[0], x[1], x[2]);
  }
  return vertices;
}

// Whether the patch has more than an edge in common with the convex body, its surface included.
bool reaches_into(const WorkPatch& patch, std::span<const OccluderFace> body) {
  for (const OccluderFace& face : body) {
    if (span_along(patch.outline, face.plane).low > side_tolerance) return false;
  }
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
  std::map<int, Vec3> normals;  // of the body's polygons
  for (const OccluderFace& face : faces) normals.try_emplace(face.polygon, face.plane.normal);
  for (int p = 0; p < mesh.size(); ++p) {
    const Vec3 middle = frame(mesh.centroids[p]);
    double square = 0;
    for (int k = 0; k < mesh.corner_count(p); ++k) {
      square = std::max(square, (frame(mesh.vertices[mesh.corners[p][k]]) - middle).squaredNorm());
    }
    const double reach = body.radius + std::sqrt(square) + side_tolerance;
    if ((middle - body.centre).squaredNorm() > reach * reach) continue;
    const WorkPatch patch = work_patch(mesh, p, frame);
    // a second sheet back to back with a face of the body looks into it
    const auto own = normals.find(mesh.polygons[p]);
    const bool outward = own != normals.end() && own->second.dot(patch.plane.normal) > 0.5;
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

Side side_of_plane(const Occluder& round_body, const Plane& plane) {
  bool front = false, behind = false;
  for (const Vec3& x : round_body.vertices) {
    const double height = plane.distance(x);
    front |= height > side_tolerance;
    behind |= height < -side_tolerance;
    if (front && behind) return Side::both;
  }
  return front ? Side::front : Side::behind;
}

std::vector<Occluder> join_bodies(std::vector<OccluderFace>& faces, const PatchMesh& mesh,
                                  const WorkingFrame& frame) {
  const auto left = edges_of(faces);
  const auto at_vertices = faces_at_vertices(faces);
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
    Occluder body;
    body.begin = begin;
    body.end = end;
    const std::span<const OccluderFace> own(ordered.data() + begin, members.size());
    bound(body, own);
    bool whole = members.size() >= 4 && members.size() <= most_faces &&
                 std::all_of(members.begin(), members.end(), [&](int f) { return closed[f]; }) &&
                 convex(faces, members) && !anything_inside(body, own, mesh, frame);
    if (whole && body.round()) {
      body.vertices = own_vertices(own, at_vertices);
      whole = !body.vertices.empty();
      body.inner_radius = body.radius;
      for (const OccluderFace& face : own) {
        body.inner_radius = std::min(body.inner_radius, -face.plane.distance(body.centre));
      }
    }
    if (!whole) {
      for (int f = begin; f < end; ++f) {
        occluders.push_back({f, f + 1, {}, ordered[f].centre, ordered[f].radius, false, 0, {}});
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
