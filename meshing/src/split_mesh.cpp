#include "split_mesh.h"

#include "half_edge_mesh.h"
#include "index_mesh.h"
#include "manifold_parts.h"

namespace luxel {

std::vector<std::unique_ptr<SplitMesh>> make_split_meshes(const std::vector<std::array<int, 3>>& triangles,
                                                          const std::vector<int>& tags, int vertex_count) {
  Loops loops;
  for (const auto& triangle : triangles) loops.append(triangle);
  const ManifoldParts parts = find_manifold_parts(loops, EdgeTable(loops, vertex_count));
  std::vector<std::array<int, 3>> fans, others;
  std::vector<int> tags_of_fans, tags_of_others;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (parts.manifold[t]) {
      fans.push_back({parts.fans[3 * t], parts.fans[3 * t + 1], parts.fans[3 * t + 2]});
      tags_of_fans.push_back(tags[t]);
    } else {
      others.push_back(triangles[t]);
      tags_of_others.push_back(tags[t]);
    }
  }
  std::vector<std::unique_ptr<SplitMesh>> meshes;
  if (!fans.empty()) {
    meshes.push_back(std::make_unique<HalfEdgeMesh>(fans, parts.fan_vertices, std::move(tags_of_fans)));
  }
  if (!others.empty()) {
    meshes.push_back(std::make_unique<IndexMesh>(std::move(others), std::move(tags_of_others), vertex_count));
  }
  return meshes;
}

}  // namespace luxel
