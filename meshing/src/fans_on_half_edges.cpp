#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include <stdexcept>

#include "smooth_fans.h"

namespace luxel {

namespace {

struct Traits : OpenMesh::DefaultTraitsDouble {
  FaceAttributes(OpenMesh::Attributes::Normal);
};
using HalfEdges = OpenMesh::PolyMesh_ArrayKernelT<Traits>;
using HalfEdge = OpenMesh::HalfedgeHandle;

OpenMesh::Vec3d vector(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

/// The patches as faces in their order; each vertex once for every fan of its part.
HalfEdges make_half_edges(const PatchMesh& mesh, std::span<const int> patches, const ManifoldParts& parts,
                          const Loops& loops) {
  HalfEdges half_edges;
  half_edges.reserve(parts.fan_vertices.size(), parts.fan_vertices.size() + patches.size(), patches.size());
  half_edges.resize(parts.fan_vertices.size(), 0, 0);
  for (std::size_t f = 0; f < parts.fan_vertices.size(); ++f) {
    half_edges.set_point(OpenMesh::VertexHandle(static_cast<int>(f)),
                         vector(mesh.vertices[parts.fan_vertices[f]]));
  }
  for (const int patch : patches) {
    std::array<OpenMesh::VertexHandle, 4> corners;
    const auto count = static_cast<std::size_t>(loops.offsets[patch + 1] - loops.offsets[patch]);
    for (std::size_t k = 0; k < count; ++k) {
      corners[k] = OpenMesh::VertexHandle(parts.fans[static_cast<std::size_t>(loops.offsets[patch]) + k]);
    }
    const OpenMesh::FaceHandle face = half_edges.add_face(corners.data(), count);
    if (!face.is_valid())
      throw std::invalid_argument("find_fans_on_half_edges: the patches are not manifold");
    half_edges.set_normal(face, vector(mesh.normals[patch]));
  }
  return half_edges;
}

}  // namespace

SmoothFans find_fans_on_half_edges(const PatchMesh& mesh, std::span<const int> patches,
                                   const ManifoldParts& parts, const Loops& loops, double crease_angle) {
  const HalfEdges half_edges = make_half_edges(mesh, patches, parts, loops);
  const SmoothTransition is_smooth(mesh, crease_angle);
  // Half-edges that leave a vertex, one per patch there. The next one of the fan in either direction; invalid
  // at a border and at a crease.
  const auto across = [&](HalfEdge h, HalfEdge other) {
    const auto face = half_edges.face_handle(other);
    if (!face.is_valid()) return HalfEdge();
    return is_smooth(patches[half_edges.face_handle(h).idx()], patches[face.idx()]) ? other : HalfEdge();
  };
  const auto left = [&](HalfEdge h) { return across(h, half_edges.ccw_rotated_halfedge_handle(h)); };
  const auto right = [&](HalfEdge h) {
    const HalfEdge opposite = half_edges.opposite_halfedge_handle(h);
    const HalfEdge other = across(h, opposite);
    return other.is_valid() ? half_edges.next_halfedge_handle(other) : other;
  };

  SmoothFans fans;
  std::vector<int> fan_of_half_edge(half_edges.n_halfedges(), -1);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    HalfEdge corner = half_edges.halfedge_handle(OpenMesh::FaceHandle(static_cast<int>(i)));
    const int begin = loops.offsets[patches[i]];
    while (half_edges.from_vertex_handle(corner).idx() != parts.fans[begin]) {
      corner = half_edges.next_halfedge_handle(corner);
    }
    auto& row = fans.corners.emplace_back(std::array<int, 4>{-1, -1, -1, -1});
    for (int k = 0; begin + k < loops.offsets[patches[i] + 1]; ++k) {
      if (fan_of_half_edge[corner.idx()] < 0) {
        HalfEdge first = corner;
        for (HalfEdge h = right(corner); h.is_valid() && h != corner; h = right(h)) first = h;
        Vec3 normal = Vec3::Zero();
        HalfEdge h = first;
        do {
          fan_of_half_edge[h.idx()] = static_cast<int>(fans.vertices.size());
          const double angle = half_edges.calc_sector_angle(half_edges.prev_halfedge_handle(h));
          normal += angle * Vec3(half_edges.normal(half_edges.face_handle(h)).data());
          h = left(h);
        } while (h.is_valid() && h != first);
        fans.vertices.push_back(loops.entries[begin + k]);
        fans.normals.push_back(normal.normalized());
      }
      row[k] = fan_of_half_edge[corner.idx()];
      corner = half_edges.next_halfedge_handle(corner);
    }
  }
  return fans;
}

}  // namespace luxel
