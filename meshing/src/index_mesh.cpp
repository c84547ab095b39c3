#include "index_mesh.h"

#include "edge_table.h"

namespace luxel {

IndexMesh::IndexMesh(std::vector<std::array<int, 3>> triangles, std::vector<int> tags, int vertex_count)
    : triangles_(std::move(triangles)), tags_(std::move(tags)) {
  Loops loops;
  for (const auto& triangle : triangles_) loops.append(triangle);
  const EdgeTable edges(loops, vertex_count);
  edge_.resize(loops.entries.size());
  ring_.resize(loops.entries.size());
  first_.resize(edges.edge_count());
  for (int e = 0; e < edges.edge_count(); ++e) {
    const auto uses = edges.uses_of_edge(e);
    make_ring(e, {uses.begin(), uses.end()});
  }
}

void IndexMesh::make_ring(int edge, const std::vector<int>& half_edges) {
  first_[edge] = half_edges[0];
  for (std::size_t k = 0; k < half_edges.size(); ++k) {
    edge_[half_edges[k]] = edge;
    ring_[half_edges[k]] = half_edges[(k + 1) % half_edges.size()];
  }
}

/// Puts one half-edge in the place of another on the same edge.
void IndexMesh::replace(int old_half_edge, int new_half_edge) {
  const int edge = edge_[old_half_edge];
  edge_[new_half_edge] = edge;
  if (first_[edge] == old_half_edge) first_[edge] = new_half_edge;
  int before = old_half_edge;
  while (ring_[before] != old_half_edge) before = ring_[before];
  ring_[new_half_edge] = before == old_half_edge ? new_half_edge : ring_[old_half_edge];
  if (before != old_half_edge) ring_[before] = new_half_edge;
}

std::span<const int> IndexMesh::split(int edge, int middle) {
  auto& [kept, added] = halves_;
  kept.clear();
  added.clear();
  edges_at_middle_ = {edge, edge_count()};
  const int a = from(first_[edge]);
  first_.push_back(-1);
  int h = first_[edge];
  do {
    // Triangle (p, q, r) with the edge p -> q becomes (p, m, r) in place and (m, q, r) as a new one.
    const int t = h / 3;
    const int k = h % 3;
    const int u = triangle_count();
    const bool forwards = triangles_[t][k] == a;
    const int q_to_r = next(h);
    triangles_.push_back({middle, triangles_[t][(k + 1) % 3], triangles_[t][(k + 2) % 3]});
    triangles_[t][(k + 1) % 3] = middle;
    tags_.push_back(tags_[t]);
    edge_.resize(edge_.size() + 3);
    ring_.resize(ring_.size() + 3);
    replace(q_to_r, 3 * u + 1);
    edges_at_middle_.push_back(edge_count());
    first_.push_back(-1);
    make_ring(edge_count() - 1, {q_to_r, 3 * u + 2});  // now m -> r, against r -> m of the new triangle
    (forwards ? kept : added).push_back(h);
    (forwards ? added : kept).push_back(3 * u);
    h = ring_[h];
  } while (h != first_[edge]);
  make_ring(edges_at_middle_[0], kept);
  make_ring(edges_at_middle_[1], added);
  return edges_at_middle_;
}

}  // namespace luxel
