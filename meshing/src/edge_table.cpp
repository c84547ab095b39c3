#include "edge_table.h"

#include <algorithm>

namespace luxel {

EdgeTable::EdgeTable(const Loops& loops, int vertex_count) : from_(loops.entries) {
  const int count = static_cast<int>(from_.size());
  to_.resize(count);
  loop_.resize(count);
  edge_.resize(count);
  std::vector<int> bucket(vertex_count + 1, 0);  // half-edges by their smaller end
  for (int i = 0; i < loops.size(); ++i) {
    const int begin = loops.offsets[i];
    const int end = loops.offsets[i + 1];
    for (int h = begin; h < end; ++h) {
      to_[h] = from_[h + 1 < end ? h + 1 : begin];
      loop_[h] = i;
      ++bucket[std::min(from_[h], to_[h]) + 1];
    }
  }
  for (int v = 0; v < vertex_count; ++v) bucket[v + 1] += bucket[v];
  half_edges_.resize(count);
  std::vector<int> fill(bucket.begin(), bucket.end() - 1);
  for (int h = 0; h < count; ++h) half_edges_[fill[std::min(from_[h], to_[h])]++] = h;

  const auto larger_end = [&](int h) { return std::max(from_[h], to_[h]); };
  for (int v = 0; v < vertex_count; ++v) {
    const auto begin = half_edges_.begin() + bucket[v];
    const auto end = half_edges_.begin() + bucket[v + 1];
    std::sort(begin, end, [&](int a, int b) {
      return larger_end(a) != larger_end(b) ? larger_end(a) < larger_end(b) : a < b;
    });
    for (auto it = begin; it != end; ++it) {
      if (it == begin || larger_end(*it) != larger_end(*(it - 1))) {
        offsets_.push_back(static_cast<int>(it - half_edges_.begin()));
      }
      edge_[*it] = static_cast<int>(offsets_.size()) - 1;
    }
  }
  offsets_.push_back(count);
}

}  // namespace luxel
