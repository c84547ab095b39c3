#include "shared_edges.h"

#include <algorithm>
#include <cmath>

#include "edge_key.h"

namespace luxel {

int SharedEdges::add(int a, int b) {
  const auto [found, fresh] = index_.try_emplace(edge_key(a, b), size());
  if (fresh) ends_.push_back({std::min(a, b), std::max(a, b)});
  return found->second;
}

int SharedEdges::find(int a, int b) const {
  const auto found = index_.find(edge_key(a, b));
  return found == index_.end() ? -1 : found->second;
}

void SharedEdges::divide(std::vector<Vec3>& vertices, const std::function<int(int, double)>& parts_of,
                         const std::function<std::optional<std::vector<int>>(int, int)>& given) {
  between_.assign(ends_.size(), {});
  given_.assign(ends_.size(), false);
  for (int e = 0; e < size(); ++e) {
    const auto [a, b] = ends_[e];
    if (auto points = given(a, b)) {
      between_[e] = *std::move(points);
      given_[e] = true;
      continue;
    }
    const Vec3 start = vertices[a];
    const Vec3 d = vertices[b] - start;
    const int count = parts_of(e, d.norm());
    for (int k = 1; k < count; ++k) {
      between_[e].push_back(static_cast<int>(vertices.size()));
      vertices.push_back(start + d * (static_cast<double>(k) / count));
    }
  }
}

void SharedEdges::insert(int edge, int a, int b, int m) {
  auto& between = between_[edge];
  if (a == ends_[edge][0] || b == ends_[edge][0]) {
    between.insert(between.begin(), m);
    return;
  }
  const auto first = std::find_if(between.begin(), between.end(), [&](int v) { return v == a || v == b; });
  between.insert(first + 1, m);
}

std::vector<int> SharedEdges::points(int a, int b) const {
  std::vector<int> list = {std::min(a, b)};
  const auto& between = between_[find(a, b)];
  list.insert(list.end(), between.begin(), between.end());
  list.push_back(std::max(a, b));
  if (a > b) std::reverse(list.begin(), list.end());
  return list;
}

}  // namespace luxel
