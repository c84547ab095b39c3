#include "point_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace luxel {

namespace {

// Cells along the longest side of the points' box at most: places then fit in an int with room around.
constexpr double most_along_side = 0x1p29;

// Where cells start before the first point, in cells: walls and lattices, which stand at simple fractions of
// the extent, then lie within cells and not between two.
constexpr double offset = 0.381966;

}  // namespace

PointGrid::PointGrid(const std::vector<Vec3>& points, std::span<const int> chosen, double width) {
  Box box;
  for (const int i : chosen) box.extend(points[i]);
  if (!chosen.empty()) {
    width = std::max(width, box.sizes().maxCoeff() / most_along_side);
    origin_ = box.min().array() - offset * width;
  }
  cells_per_metre_ = 1 / width;
  if (!(width > 0) || !std::isfinite(cells_per_metre_)) cells_per_metre_ = 0;  // all in one cell

  begin_.assign(std::bit_ceil(chosen.size() + 1) + 1, 0);
  std::vector<std::uint32_t> buckets;
  buckets.reserve(chosen.size());
  for (const int i : chosen) {
    buckets.push_back(bucket(cell(points[i])));
    ++begin_[buckets.back()];
  }
  std::exclusive_scan(begin_.begin(), begin_.end(), begin_.begin(), 0);
  points_.resize(chosen.size());
  indices_.resize(chosen.size());
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const int place = next[buckets[k]]++;
    points_[place] = points[chosen[k]];
    indices_[place] = chosen[k];
  }
}

PointGrid::Cell PointGrid::cell(const Vec3& p) const {
  Cell result;
  for (int k = 0; k < 3; ++k) {
    // Boxes reach beyond the points: what lies further out than one cell is as empty as that one.
    const double place = (p[k] - origin_[k]) * cells_per_metre_;
    result[k] = static_cast<int>(std::clamp(place, -1.0, most_along_side + 2)) - (place < 0 ? 1 : 0);
  }
  return result;
}

std::uint32_t PointGrid::bucket(const Cell& cell) const {
  std::uint64_t row = static_cast<std::uint32_t>(cell[1]) | static_cast<std::uint64_t>(cell[2]) << 32;
  row *= 0x9e3779b97f4a7c15ull;
  row ^= row >> 32;
  row *= 0xff51afd7ed558ccdull;
  row ^= row >> 29;
  return (static_cast<std::uint32_t>(row) + static_cast<std::uint32_t>(cell[0])) &
         static_cast<std::uint32_t>(begin_.size() - 2);
}

}  // namespace luxel
