#pragma once

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>

#include "split_mesh.h"

namespace luxel {

/// Triangles on OpenMesh's half-edges: two on an edge at most. Cost of a split: constant.
class HalfEdgeMesh final : public SplitMesh {
 public:
  /// `triangles` are manifold, around each vertex as well: they name places in `vertices`, which are what the
  /// mesh speaks of and may repeat (see ManifoldParts).
  /// @throws std::invalid_argument if they are not manifold.
  HalfEdgeMesh(const std::vector<std::array<int, 3>>& triangles, std::vector<int> vertices,
               std::vector<int> tags);

  int triangle_count() const override { return static_cast<int>(mesh_.n_faces()); }
  int edge_count() const override { return static_cast<int>(mesh_.n_edges()); }
  std::array<int, 2> ends(int edge) const override;
  std::span<const int> split(int edge, int middle) override;
  std::vector<std::array<int, 3>> triangles() const override;
  const std::vector<int>& tags() const override { return tags_; }

 private:
  OpenMesh::TriConnectivity mesh_;
  std::vector<int> vertices_;  // what each of the mesh's vertices stands for
  std::vector<int> tags_;
  std::vector<int> edges_at_middle_;
};

}  // namespace luxel
