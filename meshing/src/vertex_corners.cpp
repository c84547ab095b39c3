#include "vertex_corners.h"

namespace luxel {

VertexCorners::VertexCorners(const std::vector<std::array<int, 4>>& corners, int vertex_count)
    : offsets_(vertex_count + 1, 0) {
  for (const auto& row : corners) {
    for (int k = 0; k < count_corners(row); ++k) ++offsets_[row[k] + 1];
  }
  for (int v = 0; v < vertex_count; ++v) offsets_[v + 1] += offsets_[v];
  corners_.resize(offsets_.back());
  std::vector<int> fill(offsets_.begin(), offsets_.end() - 1);
  for (int i = 0; i < static_cast<int>(corners.size()); ++i) {
    for (int k = 0; k < count_corners(corners[i]); ++k) corners_[fill[corners[i][k]]++] = {i, k};
  }
}

std::array<int, 2> neighbours(const std::array<int, 4>& row, int place) {
  const int count = count_corners(row);
  return {row[(place + count - 1) % count], row[(place + 1) % count]};
}

}  // namespace luxel
