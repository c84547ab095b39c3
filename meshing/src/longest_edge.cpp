#include "longest_edge.h"

#include <algorithm>

#include "edge_key.h"

namespace luxel {

namespace {

std::size_t triangles_of(const std::vector<std::unique_ptr<SplitMesh>>& meshes) {
  std::size_t total = 0;
  for (const auto& mesh : meshes) total += static_cast<std::size_t>(mesh->triangle_count());
  return total;
}

}  // namespace

bool LongestEdgeRefiner::Entry::operator<(const Entry& other) const {
  if (squared_length != other.squared_length) return squared_length < other.squared_length;
  return ends > other.ends;
}

LongestEdgeRefiner::LongestEdgeRefiner(std::vector<Vec3>& vertices,
                                       std::vector<std::unique_ptr<SplitMesh>> meshes,
                                       const std::vector<std::array<int, 2>>& watched)
    : vertices_(vertices), meshes_(std::move(meshes)), initial_(triangles_of(meshes_)) {
  for (const auto& [a, b] : watched) midpoints_.emplace(edge_key(a, b), -1);
  for (int i = 0; i < static_cast<int>(meshes_.size()); ++i) {
    for (int e = 0; e < meshes_[i]->edge_count(); ++e) push(i, e);
  }
}

void LongestEdgeRefiner::push(int mesh, int edge) {
  auto [a, b] = meshes_[mesh]->ends(edge);
  if (a > b) std::swap(a, b);
  queue_.push({(vertices_[b] - vertices_[a]).squaredNorm(), {a, b}, mesh, edge});
}

void LongestEdgeRefiner::split_longest() {
  const Entry longest = queue_.top();
  queue_.pop();
  const auto [a, b] = longest.ends;
  const int m = static_cast<int>(vertices_.size());
  vertices_.push_back(0.5 * (vertices_[a] + vertices_[b]));
  if (const auto found = midpoints_.find(edge_key(a, b)); found != midpoints_.end()) {
    found->second = m;
    midpoints_.emplace(edge_key(a, m), -1);
    midpoints_.emplace(edge_key(m, b), -1);
  }
  SplitMesh& mesh = *meshes_[longest.mesh];
  const int before = mesh.triangle_count();
  for (const int edge : mesh.split(longest.edge, m)) push(longest.mesh, edge);
  history_.push_back({longest.squared_length,
                      count(history_.size()) + static_cast<std::size_t>(mesh.triangle_count() - before)});
}

void LongestEdgeRefiner::refine(double longest) {
  while (!queue_.empty() && queue_.top().squared_length > longest * longest) split_longest();
}

void LongestEdgeRefiner::halve(std::size_t halvings) {
  while (!queue_.empty() && history_.size() < halvings) split_longest();
}

std::size_t LongestEdgeRefiner::halvings(double longest) const {
  const auto after = std::partition_point(history_.begin(), history_.end(), [&](const Halving& halving) {
    return halving.squared_length > longest * longest;
  });
  return static_cast<std::size_t>(after - history_.begin());
}

std::size_t LongestEdgeRefiner::count(std::size_t halvings) const {
  return halvings == 0 ? initial_ : history_[halvings - 1].triangles;
}

std::vector<std::array<int, 3>> LongestEdgeRefiner::triangles() const {
  std::vector<std::array<int, 3>> all;
  for (const auto& mesh : meshes_) {
    const auto triangles = mesh->triangles();
    all.insert(all.end(), triangles.begin(), triangles.end());
  }
  return all;
}

std::vector<int> LongestEdgeRefiner::tags() const {
  std::vector<int> all;
  for (const auto& mesh : meshes_) all.insert(all.end(), mesh->tags().begin(), mesh->tags().end());
  return all;
}

std::optional<std::vector<int>> LongestEdgeRefiner::points_between(int a, int b) const {
  const auto found = midpoints_.find(edge_key(a, b));
  if (found == midpoints_.end()) return std::nullopt;
  if (found->second < 0) return std::vector<int>();
  std::vector<int> points = *points_between(a, found->second);
  points.push_back(found->second);
  const std::vector<int> rest = *points_between(found->second, b);
  points.insert(points.end(), rest.begin(), rest.end());
  return points;
}

}  // namespace luxel
