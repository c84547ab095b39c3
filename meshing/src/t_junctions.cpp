#include "t_junctions.h"

#include <algorithm>

#include "box_tree.h"
#include "edge_table.h"
#include "polygon.h"
#include "weld.h"

namespace luxel {

namespace {

// As a share of the scene's diagonal: above the rounding of eight-digit text, ten times below the thinnest
// gap or wall (1e-6) that must stay.
constexpr double touching = 1e-7;

// As a share of the edge: bodies much smaller than the scene keep their shape.
constexpr double touching_share_of_edge = 1e-3;

struct OnEdge {
  double place;  // 0 .. 1 along the edge
  int vertex;
};

/// Finds vertices inside edges.
class EdgeProbe {
 public:
  EdgeProbe(const std::vector<Vec3>& vertices, std::vector<int> candidates)
      : vertices_(vertices),
        candidates_(std::move(candidates)),
        distance_(touching_distance(vertices)),
        noise_(rounding(vertices)),
        tree_(boxes(vertices, candidates_)) {}

  /// The candidates strictly between a and b, in order from a.
  const std::vector<OnEdge>& between(int a, int b) {
    found_.clear();
    const Vec3& start = vertices_[a];
    const Vec3 d = vertices_[b] - start;
    const double length = d.norm();
    const double reach = std::max(noise_, std::min(distance_, touching_share_of_edge * length));
    Box box(start.cwiseMin(vertices_[b]).array() - reach, start.cwiseMax(vertices_[b]).array() + reach);
    tree_.query(box, [&](int candidate) {
      const int v = candidates_[candidate];
      if (v == a || v == b) return;
      const Vec3 x = vertices_[v] - start;
      const double along = x.dot(d) / length;
      if (along <= reach || along >= length - reach) return;
      if ((x - d * (along / length)).norm() <= reach) found_.push_back({along / length, v});
    });
    std::sort(found_.begin(), found_.end(), [](const OnEdge& p, const OnEdge& q) {
      return p.place != q.place ? p.place < q.place : p.vertex < q.vertex;
    });
    return found_;
  }

 private:
  static std::vector<Box> boxes(const std::vector<Vec3>& vertices, const std::vector<int>& candidates) {
    std::vector<Box> result;
    result.reserve(candidates.size());
    for (const int v : candidates) result.emplace_back(vertices[v]);
    return result;
  }

  const std::vector<Vec3>& vertices_;
  std::vector<int> candidates_;
  double distance_, noise_;
  BoxTree tree_;
  std::vector<OnEdge> found_;
};

}  // namespace

double touching_distance(const std::vector<Vec3>& vertices) {
  return std::max(touching * diagonal(vertices), rounding(vertices));
}

RepairedFacets repair_t_junctions(const Facets& facets) {
  std::vector<int> all(facets.vertices.size());
  for (std::size_t v = 0; v < all.size(); ++v) all[v] = static_cast<int>(v);
  EdgeProbe probe(facets.vertices, std::move(all));
  const EdgeTable edges(facets.loops, static_cast<int>(facets.vertices.size()));
  // What was found on an edge, from its first use; asked once for all that share it.
  std::vector<std::vector<int>> inserted(edges.edge_count());
  bool any = false;
  for (int e = 0; e < edges.edge_count(); ++e) {
    const int h = edges.uses_of_edge(e).front();
    for (const OnEdge& on : probe.between(edges.from(h), edges.to(h))) {
      inserted[e].push_back(on.vertex);
      any = true;
    }
  }
  RepairedFacets result{facets, 0};
  if (!any) return result;
  result.facets.loops = {};
  std::vector<int> loop;
  for (int i = 0; i < facets.size(); ++i) {
    loop.clear();
    const auto corners = facets.loop(i);
    for (int h = facets.loops.offsets[i]; h < facets.loops.offsets[i + 1]; ++h) {
      loop.push_back(edges.from(h));
      std::vector<int> found = inserted[edges.edge(h)];
      if (edges.from(edges.uses(h).front()) != edges.from(h)) std::reverse(found.begin(), found.end());
      for (const int v : found) {
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
  std::vector<int> open;  // half-edges that nothing runs against
  std::vector<int> ends;
  for (int h = 0; h < static_cast<int>(loops.entries.size()); ++h) {
    const auto uses = edges.uses(h);
    if (std::ranges::any_of(uses, [&](int g) { return edges.from(g) != edges.from(h); })) continue;
    open.push_back(h);
    ends.push_back(edges.from(h));
    ends.push_back(edges.to(h));
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  EdgeProbe probe(mesh.vertices, std::move(ends));
  int count = 0;
  for (const int h : open) count += static_cast<int>(probe.between(edges.from(h), edges.to(h)).size());
  return count;
}

}  // namespace luxel
