#pragma once

#include <array>
#include <span>
#include <vector>

namespace luxel {

/// A corner of a patch: `patch` and its place 0 .. 3 there.
struct Corner {
  int patch;
  int place;
};

/// For every vertex the corners that stand on it, by patch.
class VertexCorners {
 public:
  VertexCorners(const std::vector<std::array<int, 4>>& corners, int vertex_count);

  std::span<const Corner> operator[](int vertex) const {
    return std::span(corners_).subspan(offsets_[vertex], offsets_[vertex + 1] - offsets_[vertex]);
  }
  /// Where the corners of the vertex start among all corners.
  int offset(int vertex) const { return offsets_[vertex]; }
  int vertex_count() const { return static_cast<int>(offsets_.size()) - 1; }

 private:
  std::vector<int> offsets_;
  std::vector<Corner> corners_;
};

/// Number of corners of a row that ends with -1 for a triangle.
inline int count_corners(const std::array<int, 4>& row) {
  return row[3] < 0 ? 3 : 4;
}

/// The vertices before and after a corner in its patch.
std::array<int, 2> neighbours(const std::array<int, 4>& row, int place);

}  // namespace luxel
