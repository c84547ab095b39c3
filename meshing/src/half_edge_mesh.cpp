#include "half_edge_mesh.h"

#include <stdexcept>

namespace luxel {

HalfEdgeMesh::HalfEdgeMesh(const std::vector<std::array<int, 3>>& triangles, std::vector<int> vertices,
                           std::vector<int> tags)
    : vertices_(std::move(vertices)), tags_(std::move(tags)) {
  mesh_.resize(vertices_.size(), 0, 0);
  for (const auto& [a, b, c] : triangles) {
    const auto face =
        mesh_.add_face(OpenMesh::VertexHandle(a), OpenMesh::VertexHandle(b), OpenMesh::VertexHandle(c));
    if (!face.is_valid()) throw std::invalid_argument("HalfEdgeMesh: the triangles are not manifold");
  }
}

std::array<int, 2> HalfEdgeMesh::ends(int edge) const {
  const auto h = mesh_.halfedge_handle(OpenMesh::EdgeHandle(edge), 0);
  return {vertices_[mesh_.from_vertex_handle(h).idx()], vertices_[mesh_.to_vertex_handle(h).idx()]};
}

std::span<const int> HalfEdgeMesh::split(int edge, int middle) {
  const OpenMesh::EdgeHandle e(edge);
  const OpenMesh::VertexHandle m = mesh_.add_vertex();
  vertices_.push_back(middle);
  // The new triangles come in the order of the old ones' half-edges.
  for (const unsigned side : {0, 1}) {
    const auto face = mesh_.face_handle(mesh_.halfedge_handle(e, side));
    if (face.is_valid()) tags_.push_back(tags_[face.idx()]);
  }
  mesh_.split(e, m);
  edges_at_middle_.clear();
  for (auto it = mesh_.cve_iter(m); it.is_valid(); ++it) edges_at_middle_.push_back(it->idx());
  return edges_at_middle_;
}

std::vector<std::array<int, 3>> HalfEdgeMesh::triangles() const {
  std::vector<std::array<int, 3>> result;
  result.reserve(mesh_.n_faces());
  for (int t = 0; t < triangle_count(); ++t) {
    auto h = mesh_.halfedge_handle(OpenMesh::FaceHandle(t));
    std::array<int, 3> triangle;
    for (int& corner : triangle) {
      corner = vertices_[mesh_.from_vertex_handle(h).idx()];
      h = mesh_.next_halfedge_handle(h);
    }
    result.push_back(triangle);
  }
  return result;
}

}  // namespace luxel
