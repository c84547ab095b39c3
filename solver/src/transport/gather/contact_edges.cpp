#include "transport/gather/contact_edges.h"

#include <algorithm>

namespace luxel {

ContactEdges::ContactEdges(const PatchMesh& mesh) : mesh_(mesh), several_(mesh.vertices.size(), 0) {
  std::vector<int> polygon(mesh.vertices.size(), -1);
  for (int i = 0; i < mesh.size(); ++i) {
    for (int k = 0; k < mesh.corner_count(i); ++k) {
      const int vertex = mesh.corners[i][k];
      if (polygon[vertex] < 0) polygon[vertex] = mesh.polygons[i];
      if (polygon[vertex] != mesh.polygons[i]) several_[vertex] = 1;
    }
  }
}

std::vector<std::array<int, 2>> ContactEdges::between(std::span<const int> patches) const {
  std::vector<std::array<int, 2>> edges;
  for (const int i : patches) {
    const int count = mesh_.corner_count(i);
    for (int k = 0; k < count; ++k) {
      const int a = mesh_.corners[i][k], b = mesh_.corners[i][(k + 1) % count];
      if (several_[a] && several_[b]) edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<std::array<int, 2>> shared;
  for (std::size_t k = 1; k < edges.size(); ++k) {
    if (edges[k] == edges[k - 1]) shared.push_back(edges[k]);
  }
  return shared;
}

}  // namespace luxel
