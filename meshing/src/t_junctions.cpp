#include "t_junctions.h"

#include <algorithm>
#include <numeric>

#include "vertices_on_edges.h"

namespace luxel {

std::optional<RepairedFacets> repair_t_junctions(const Facets& facets, const EdgeTable& edges) {
  std::vector<int> all(facets.vertices.size());
  std::iota(all.begin(), all.end(), 0);
  // An edge runs as its first use does; it is asked once for all that share it.
  std::vector<std::array<int, 2>> ends;
  ends.reserve(edges.edge_count());
  for (int e = 0; e < edges.edge_count(); ++e) {
    const int h = edges.uses_of_edge(e).front();
    ends.push_back({edges.from(h), edges.to(h)});
  }
  const std::vector<VertexOnEdge> found = find_vertices_on_edges(facets.vertices, all, ends);
  if (found.empty()) return std::nullopt;
  RepairedFacets result{facets, 0};
  result.facets.loops = {};
  std::vector<int> loop, inserted;
  for (int i = 0; i < facets.size(); ++i) {
    loop.clear();
    const auto corners = facets.loop(i);
    for (int h = facets.loops.offsets[i]; h < facets.loops.offsets[i + 1]; ++h) {
      loop.push_back(edges.from(h));
      const int e = edges.edge(h);
      inserted.clear();
      const auto first = std::ranges::lower_bound(found, e, {}, &VertexOnEdge::edge);
      for (auto on = first; on != found.end() && on->edge == e; ++on) inserted.push_back(on->vertex);
      if (ends[e][0] != edges.from(h)) std::reverse(inserted.begin(), inserted.end());
      for (const int v : inserted) {
        if (std::ranges::find(corners, v) != corners.end()) continue;
        loop.push_back(v);
        ++result.repaired;
      }
    }
    result.facets.loops.append(loop);
  }
  return result;
}

int count_t_vertices(const PatchMesh& mesh) {
  Loops loops;
  for (int i = 0; i < mesh.size(); ++i) {
    loops.append(std::span<const int>(mesh.corners[i]).first(mesh.corner_count(i)));
  }
  const EdgeTable edges(loops, static_cast<int>(mesh.vertices.size()));
  std::vector<std::array<int, 2>> open;  // half-edges that nothing runs against
  std::vector<int> ends;
  for (int h = 0; h < static_cast<int>(loops.entries.size()); ++h) {
    const auto uses = edges.uses(h);
    if (std::ranges::any_of(uses, [&](int g) { return edges.from(g) != edges.from(h); })) continue;
    open.push_back({edges.from(h), edges.to(h)});
    ends.insert(ends.end(), open.back().begin(), open.back().end());
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return static_cast<int>(find_vertices_on_edges(mesh.vertices, ends, open).size());
}

}  // namespace luxel
