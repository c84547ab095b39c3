#pragma once

#include "split_mesh.h"

namespace luxel {

/// Triangles by index: any number of them may share an edge, in either direction. Cost of a split: linear in
/// the triangles on the edge.
class IndexMesh final : public SplitMesh {
 public:
  IndexMesh(std::vector<std::array<int, 3>> triangles, std::vector<int> tags, int vertex_count);

  int triangle_count() const override { return static_cast<int>(triangles_.size()); }
  int edge_count() const override { return static_cast<int>(first_.size()); }
  std::array<int, 2> ends(int edge) const override { return {from(first_[edge]), to(first_[edge])}; }
  std::span<const int> split(int edge, int middle) override;
  std::vector<std::array<int, 3>> triangles() const override { return triangles_; }
  const std::vector<int>& tags() const override { return tags_; }

 private:
  // A half-edge is 3 t + k: from corner k of triangle t to the next one.
  int from(int h) const { return triangles_[h / 3][h % 3]; }
  int to(int h) const { return triangles_[h / 3][(h % 3 + 1) % 3]; }
  static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
  void replace(int old_half_edge, int new_half_edge);
  void make_ring(int edge, const std::vector<int>& half_edges);

  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> tags_;
  std::vector<int> edge_;   // of each half-edge
  std::vector<int> ring_;   // the next half-edge on the same edge; the last one leads to the first
  std::vector<int> first_;  // of each edge, one of its half-edges
  std::vector<int> edges_at_middle_, halves_[2];
};

}  // namespace luxel
