#include "longest_edge.h"

#include <algorithm>
#include <cstdint>

#include "edge_table.h"

namespace luxel {

namespace {

std::uint64_t key(int a, int b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint32_t>(std::max(a, b));
}

}  // namespace

bool LongestEdgeRefiner::Entry::operator<(const Entry& other) const {
  if (squared_length != other.squared_length) return squared_length < other.squared_length;
  return std::pair(from, to) > std::pair(other.from, other.to);
}

LongestEdgeRefiner::LongestEdgeRefiner(std::vector<Vec3>& vertices, std::vector<std::array<int, 3>> triangles,
                                       std::vector<int> tags, const std::vector<std::array<int, 2>>& watched)
    : vertices_(vertices),
      triangles_(std::move(triangles)),
      tags_(std::move(tags)),
      initial_(triangles_.size()) {
  for (const auto& [a, b] : watched) midpoints_.emplace(key(a, b), -1);
  link_rings();
  for (int h = 0; h < static_cast<int>(ring_.size()); ++h) push(h);
}

void LongestEdgeRefiner::link_rings() {
  Loops loops;
  for (const auto& triangle : triangles_) loops.append(triangle);
  const EdgeTable edges(loops, static_cast<int>(vertices_.size()));
  ring_.resize(loops.entries.size());
  for (int e = 0; e < edges.edge_count(); ++e) {
    const auto uses = edges.uses_of_edge(e);
    for (std::size_t k = 0; k < uses.size(); ++k) ring_[uses[k]] = uses[(k + 1) % uses.size()];
  }
}

/// Queues an edge once: for the first half-edge of its ring in its smaller direction.
void LongestEdgeRefiner::push(int h) {
  for (int g = ring_[h]; g != h; g = ring_[g]) {
    if (g < h) return;
  }
  queue_.push({(vertices_[to(h)] - vertices_[from(h)]).squaredNorm(), h, from(h), to(h)});
}

void LongestEdgeRefiner::replace_in_ring(int old_half_edge, int new_half_edge) {
  int before = old_half_edge;
  while (ring_[before] != old_half_edge) before = ring_[before];
  if (before == old_half_edge) {
    ring_[new_half_edge] = new_half_edge;
  } else {
    ring_[new_half_edge] = ring_[old_half_edge];
    ring_[before] = new_half_edge;
  }
}

void LongestEdgeRefiner::split(int first) {
  const int a = from(first);
  const int b = to(first);
  const int m = static_cast<int>(vertices_.size());
  vertices_.push_back(0.5 * (vertices_[a] + vertices_[b]));
  std::vector<int> ring;
  int g = first;
  do {
    ring.push_back(g);
    g = ring_[g];
  } while (g != first);
  if (const auto found = midpoints_.find(key(a, b)); found != midpoints_.end()) {
    found->second = m;
    midpoints_.emplace(key(a, m), -1);
    midpoints_.emplace(key(m, b), -1);
  }

  std::vector<int> towards_a, towards_b, fresh;
  for (const int h : ring) {
    // Triangle (p, q, r) with the edge p -> q becomes (p, m, r) in place and (m, q, r) as a new one.
    const int t = h / 3;
    const int k = h % 3;
    const int q = triangles_[t][(k + 1) % 3];
    const int r = triangles_[t][(k + 2) % 3];
    const int u = static_cast<int>(triangles_.size());
    triangles_.push_back({m, q, r});
    tags_.push_back(tags_[t]);
    ring_.resize(ring_.size() + 3);
    const int q_to_r = next(h);
    replace_in_ring(q_to_r, 3 * u + 1);
    triangles_[t][(k + 1) % 3] = m;
    ring_[q_to_r] = 3 * u + 2;  // now m -> r, against r -> m of the new triangle
    ring_[3 * u + 2] = q_to_r;
    const bool forwards = from(h) == a;
    (forwards ? towards_a : towards_b).push_back(h);
    (forwards ? towards_b : towards_a).push_back(3 * u);
    fresh.push_back(3 * u + 2);
    // The old entry of q -> r names a half-edge that has moved: queue the edge under its new one.
    queue_.push({(vertices_[r] - vertices_[q]).squaredNorm(), 3 * u + 1, q, r});
  }
  for (auto* half : {&towards_a, &towards_b}) {
    for (std::size_t k = 0; k < half->size(); ++k) ring_[(*half)[k]] = (*half)[(k + 1) % half->size()];
    fresh.push_back(*std::min_element(half->begin(), half->end()));
  }
  for (const int h : fresh)
    queue_.push({(vertices_[to(h)] - vertices_[from(h)]).squaredNorm(), h, from(h), to(h)});
}

void LongestEdgeRefiner::refine(double longest) {
  while (!queue_.empty() && queue_.top().squared_length > longest * longest) {
    const Entry entry = queue_.top();
    queue_.pop();
    if (from(entry.half_edge) != entry.from || to(entry.half_edge) != entry.to) continue;
    split(entry.half_edge);
    history_.push_back({entry.squared_length, static_cast<double>(triangles_.size())});
  }
}

std::size_t LongestEdgeRefiner::count(double longest) const {
  const auto after = std::partition_point(history_.begin(), history_.end(),
                                          [&](const auto& step) { return step[0] > longest * longest; });
  return after == history_.begin() ? initial_ : static_cast<std::size_t>((*(after - 1))[1]);
}

std::optional<std::vector<int>> LongestEdgeRefiner::points_between(int a, int b) const {
  const auto found = midpoints_.find(key(a, b));
  if (found == midpoints_.end()) return std::nullopt;
  if (found->second < 0) return std::vector<int>();
  std::vector<int> points = *points_between(a, found->second);
  points.push_back(found->second);
  const std::vector<int> rest = *points_between(found->second, b);
  points.insert(points.end(), rest.begin(), rest.end());
  return points;
}

}  // namespace luxel
