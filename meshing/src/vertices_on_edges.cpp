#include "vertices_on_edges.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "point_grid.h"
#include "polygon.h"
#include "weld.h"

namespace luxel {

namespace {

// As a share of the scene's diagonal: above the rounding of eight-digit text, ten times below the thinnest
// gap or wall (1e-6) that must stay.
constexpr double touching = 1e-7;

// As a share of the edge: bodies much smaller than the scene keep their shape.
constexpr double touching_share_of_edge = 1e-3;

// Width of the grid's cells in median edge lengths: an edge then lies in one or two of them.
constexpr double cell_width = 1.7;

// Edges that the median is taken of: enough to know it within a tenth.
constexpr std::size_t sample = 1000;

// Edges that a thread takes at a time.
constexpr std::size_t edges_per_task = 4096;

using Edges = std::vector<std::array<int, 2>>;

double median_length(const std::vector<Vec3>& vertices, const Edges& edges) {
  std::vector<double> lengths;
  const std::size_t step = std::max<std::size_t>(1, edges.size() / sample);
  for (std::size_t e = 0; e < edges.size(); e += step) {
    lengths.push_back((vertices[edges[e][1]] - vertices[edges[e][0]]).norm());
  }
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

/// Asks for the vertices on one edge after the other.
class EdgeProbe {
 public:
  EdgeProbe(const std::vector<Vec3>& vertices, const Edges& edges)
      : vertices_(vertices),
        edges_(edges),
        distance_(touching_distance(vertices)),
        noise_(rounding(vertices)) {}

  /// Appends what lies on an edge; search(box, visit) calls visit(vertex) for candidates in the box. @returns
  /// what `search` does.
  template <class Search>
  bool append(std::size_t edge, const Search& search, std::vector<VertexOnEdge>& found) const {
    const auto [a, b] = edges_[edge];
    const Vec3& start = vertices_[a];
    const Vec3 d = vertices_[b] - start;
    const double length = d.norm();
    const double reach = std::max(noise_, std::min(distance_, touching_share_of_edge * length));
    const Box box(start.cwiseMin(vertices_[b]).array() - reach, start.cwiseMax(vertices_[b]).array() + reach);
    const std::size_t before = found.size();
    const bool complete = search(box, [&](int v) {
      if (v == a || v == b) return;
      const Vec3 x = vertices_[v] - start;
      const double along = x.dot(d) / length;
      if (along <= reach || along >= length - reach) return;
      if ((x - d * (along / length)).norm() <= reach)
        found.push_back({static_cast<int>(edge), v, along / length});
    });
    if (!complete) found.resize(before);
    return complete;
  }

 private:
  const std::vector<Vec3>& vertices_;
  const Edges& edges_;
  double distance_, noise_;
};

void sort_without_repeats(std::vector<VertexOnEdge>& found) {
  std::sort(found.begin(), found.end(), [](const VertexOnEdge& p, const VertexOnEdge& q) {
    if (p.edge != q.edge) return p.edge < q.edge;
    return p.place != q.place ? p.place < q.place : p.vertex < q.vertex;
  });
  const auto same = [](const VertexOnEdge& p, const VertexOnEdge& q) {
    return p.edge == q.edge && p.vertex == q.vertex;
  };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
}

/// Appends what lies on edges that the grid is too fine for.
void append_by_tree(const EdgeProbe& probe, const std::vector<Vec3>& vertices,
                    std::span<const int> candidates, const std::vector<std::size_t>& edges,
                    std::vector<VertexOnEdge>& found) {
  std::vector<Box> boxes;
  boxes.reserve(candidates.size());
  for (const int v : candidates) boxes.emplace_back(vertices[v]);
  const BoxTree tree(std::move(boxes));
  const auto search = [&](const Box& box, const auto& visit) {
    tree.query(box, [&](int k) { visit(candidates[k]); });
    return true;
  };
  for (const std::size_t edge : edges) probe.append(edge, search, found);
}

}  // namespace

double touching_distance(const std::vector<Vec3>& vertices) {
  return std::max(touching * diagonal(vertices), rounding(vertices));
}

std::vector<VertexOnEdge> find_vertices_on_edges(const std::vector<Vec3>& vertices,
                                                 std::span<const int> candidates, const Edges& edges) {
  const EdgeProbe probe(vertices, edges);
  const PointGrid grid(vertices, candidates, cell_width * median_length(vertices, edges));
  const auto search = [&](const Box& box, const auto& visit) { return grid.query(box, visit); };
  struct Part {
    std::vector<VertexOnEdge> found;
    std::vector<std::size_t> left;  // edges that the grid is too fine for
  };
  std::vector<Part> parts((edges.size() + edges_per_task - 1) / edges_per_task);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    const std::size_t end = std::min(edges.size(), (i + 1) * edges_per_task);
    for (std::size_t e = i * edges_per_task; e < end; ++e) {
      if (!probe.append(e, search, parts[i].found)) parts[i].left.push_back(e);
    }
  });
  std::vector<VertexOnEdge> found;
  std::vector<std::size_t> left;
  for (const Part& part : parts) {
    found.insert(found.end(), part.found.begin(), part.found.end());
    left.insert(left.end(), part.left.begin(), part.left.end());
  }
  if (!left.empty()) append_by_tree(probe, vertices, candidates, left, found);
  sort_without_repeats(found);
  return found;
}

}  // namespace luxel
