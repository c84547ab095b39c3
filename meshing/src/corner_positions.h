#pragma once

#include <span>
#include <vector>

#include "luxel/vector.h"

namespace luxel {

/// Where the corners of a loop are, for one loop after the other without taking memory anew.
class CornerPositions {
 public:
  /// `vertices` must outlive this.
  explicit CornerPositions(const std::vector<Vec3>& vertices) : vertices_(vertices) {}

  /// Valid until the next call.
  std::span<const Vec3> operator()(std::span<const int> loop) {
    positions_.clear();
    for (const int v : loop) positions_.push_back(vertices_[v]);
    return positions_;
  }

 private:
  const std::vector<Vec3>& vertices_;
  std::vector<Vec3> positions_;
};

}  // namespace luxel
