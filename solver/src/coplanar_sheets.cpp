#include "coplanar_sheets.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace luxel {

namespace {

// Sheets on one polygon up to which they are tried one by one.
constexpr int most_in_list = 8;

// Cells a side of a grid, at most.
constexpr int most_cells = 1024;

}  // namespace

CoplanarSheets::CoplanarSheets(const Occluders& occluders, const std::vector<Vec3>& normals) {
  const auto& pairs = occluders.coplanar;
  if (pairs.empty()) return;
  lists_.assign(occluders.polygon_count + 1, 0);
  for (const auto& [p, q] : pairs) {
    ++lists_[p + 1];
    ++lists_[q + 1];
  }
  for (std::size_t p = 1; p < lists_.size(); ++p) lists_[p] += lists_[p - 1];
  sheets_.resize(2 * pairs.size());
  std::vector<int> next(lists_.begin(), lists_.end() - 1);
  for (const auto& [p, q] : pairs) {
    const bool opposed = normals[p].dot(normals[q]) < 0;
    sheets_[next[p]++] = {q, opposed};
    sheets_[next[q]++] = {p, opposed};
  }

  grid_of_.assign(occluders.polygon_count, -1);
  for (int p = 0; p < occluders.polygon_count; ++p) {
    if (lists_[p + 1] - lists_[p] <= most_in_list) continue;
    if (low_.empty()) {
      const double infinity = std::numeric_limits<double>::infinity();
      low_.assign(occluders.polygon_count, Vec3::Constant(infinity));
      high_.assign(occluders.polygon_count, Vec3::Constant(-infinity));
      Vec3 low = Vec3::Constant(infinity), high = Vec3::Constant(-infinity);
      for (const Vec3& x : occluders.vertices) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
      }
      const Vec3 margin = Vec3::Constant(tolerance * (high - low).norm());
      for (std::size_t t = 0; t < occluders.triangles.size(); ++t) {
        const int polygon = occluders.polygons[t];
        for (const int corner : occluders.triangles[t]) {
          low_[polygon] = low_[polygon].cwiseMin(occluders.vertices[corner] - margin);
          high_[polygon] = high_[polygon].cwiseMax(occluders.vertices[corner] + margin);
        }
      }
    }
    const std::vector<Sheet> sheets(sheets_.begin() + lists_[p], sheets_.begin() + lists_[p + 1]);
    add_grid(p, sheets, normals[p]);
  }
  low_ = {};
  high_ = {};
}

void CoplanarSheets::add_grid(int polygon, std::span<const Sheet> sheets, const Vec3& normal) {
  Grid grid;
  int across = 0;
  normal.cwiseAbs().maxCoeff(&across);
  const int cells = std::clamp(static_cast<int>(std::sqrt(sheets.size())), 1, most_cells);
  grid.nx = grid.ny = cells;
  for (int k = 0; k < 2; ++k) {
    const int axis = (across + 1 + k) % 3;
    grid.axes[k] = axis;
    grid.low[k] = low_[polygon][axis];
    grid.cells_per_metre[k] = cells / (high_[polygon][axis] - low_[polygon][axis]);
  }
  const auto cell = [&](int k, const Vec3& x) {
    return std::clamp(static_cast<int>((x[grid.axes[k]] - grid.low[k]) * grid.cells_per_metre[k]), 0,
                      cells - 1);
  };
  std::vector<std::vector<Sheet>> lists(static_cast<std::size_t>(cells) * cells);
  for (const Sheet& sheet : sheets) {
    const Vec3& low = low_[sheet.polygon];
    const Vec3& high = high_[sheet.polygon];
    for (int j = cell(1, low); j <= cell(1, high); ++j) {
      for (int i = cell(0, low); i <= cell(0, high); ++i)
        lists[static_cast<std::size_t>(j) * cells + i].push_back(sheet);
    }
  }
  grid.first_list = static_cast<int>(lists_.size()) - 1;
  for (const auto& list : lists) {
    sheets_.insert(sheets_.end(), list.begin(), list.end());
    lists_.push_back(static_cast<int>(sheets_.size()));
  }
  grid_of_[polygon] = static_cast<int>(grids_.size());
  grids_.push_back(grid);
}

std::span<const CoplanarSheets::Sheet> CoplanarSheets::at(int polygon, const Vec3& point) const {
  if (lists_.empty()) return {};
  int list = polygon;
  if (grid_of_[polygon] >= 0) {
    const Grid& grid = grids_[grid_of_[polygon]];
    const auto cell = [&](int k, int count) {
      const double place = (point[grid.axes[k]] - grid.low[k]) * grid.cells_per_metre[k];
      return static_cast<int>(std::clamp(place, 0.0, count - 1.0));
    };
    list = grid.first_list + cell(1, grid.ny) * grid.nx + cell(0, grid.nx);
  }
  return std::span(sheets_).subspan(lists_[list], lists_[list + 1] - lists_[list]);
}

}  // namespace luxel
