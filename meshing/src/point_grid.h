#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "box_tree.h"
#include "luxel/vector.h"

namespace luxel {

/// Finds which of many points lie in a small box: by cells of one width, kept in a hash table, cells that are
/// neighbours in x side by side. Cost: building linear; a query what its cells hold.
class PointGrid {
 public:
  /// Over points[i] for i in `chosen`; `width` of the cells [m]: about that of the boxes asked for.
  PointGrid(const std::vector<Vec3>& points, std::span<const int> chosen, double width);

  /// Calls visit(i) for every chosen point in the box, for some perhaps twice. @returns false, and may have
  /// missed points, where the box reaches over so many cells or points that a tree is faster.
  template <class Visit>
  bool query(const Box& box, Visit&& visit) const {
    const Cell low = cell(box.min());
    const Cell high = cell(box.max());
    double cells = 1;
    for (int k = 0; k < 3; ++k) cells *= high[k] - low[k] + 1;
    if (!(cells <= most_cells)) return false;
    int left = most_points;
    for (int z = low[2]; z <= high[2]; ++z) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int x = low[0]; x <= high[0]; ++x) {
          const std::uint32_t b = bucket({x, y, z});
          left -= begin_[b + 1] - begin_[b];
          if (left < 0) return false;
          for (int i = begin_[b]; i < begin_[b + 1]; ++i) {
            if (box.contains(points_[i])) visit(indices_[i]);
          }
        }
      }
    }
    return true;
  }

 private:
  using Cell = std::array<int, 3>;

  // What a query looks through at most: some ten times what it needs where points are about as far apart as
  // the cells are wide.
  static constexpr int most_cells = 64;
  static constexpr int most_points = 256;

  Cell cell(const Vec3& p) const;
  std::uint32_t bucket(const Cell& cell) const;

  Vec3 origin_ = Vec3::Zero();
  double cells_per_metre_ = 1;
  std::vector<int> begin_;  // of each bucket in points_ and indices_
  std::vector<Vec3> points_;
  std::vector<int> indices_;
};

}  // namespace luxel
