#include "lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace luxel {

namespace {

// Lattice points keep this distance from border points, in edge lengths: nearer ones make triangles with
// short edges, farther ones leave gaps that long thin triangles fill. From 0.6 to 0.75 the mean of the
// smallest angles rises by two degrees and that of the longest edges by a twentieth: 0.69 is between.
constexpr double distance_to_points = 0.69;

// And this one from border edges: nearer, the triangle over the edge is too flat.
constexpr double distance_to_edges = 0.45;

// Height of an equilateral triangle of edge 1.
constexpr double row_height = 0.8660254037844386;

/// The step nearest to `wanted` that divides `extent` into equal parts.
double fitting_step(double extent, double wanted) {
  return extent / std::max(1.0, std::round(extent / wanted));
}

}  // namespace

HexagonalLattice::HexagonalLattice(std::span<const std::array<Vec2, 2>> border,
                                   std::span<const std::array<Vec2, 2>> creases,
                                   const std::array<Vec2, 2>& axis, double edge_length)
    : origin_(axis[0]), along_((axis[1] - axis[0]).normalized()), edge_length_(edge_length) {
  const Vec2 across(-along_.y(), along_.x());
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const auto& part : border) {
    const double y = (part[0] - origin_).dot(across);
    low = std::min(low, y);
    high = std::max(high, y);
  }
  column_step_ = fitting_step((axis[1] - axis[0]).norm(), edge_length);
  row_step_ = fitting_step(high - low, row_height * edge_length);
  bottom_ = low;
  row_count_ = static_cast<int>(std::round((high - low) / row_step_)) + 1;
  find_runs(border);
  for (const auto& [a, b] : border) clear_near(a, b);
  for (const auto& [a, b] : creases) clear_near(a, b);
  size_ = static_cast<std::size_t>(std::count(free_.begin(), free_.end(), true));
}

Vec2 HexagonalLattice::place(int row, int column) const {
  const double x = (column + (row & 1) * 0.5) * column_step_;
  const double y = bottom_ + row * row_step_;
  return origin_ + x * along_ + y * Vec2(-along_.y(), along_.x());
}

double HexagonalLattice::column_of(int row, double x) const {
  return x / column_step_ - (row & 1) * 0.5;
}

/// The first row that is not below an ordinate from the bottom.
int HexagonalLattice::row_from(double y) const {
  return static_cast<int>(std::ceil(y / row_step_));
}

void HexagonalLattice::find_runs(std::span<const std::array<Vec2, 2>> border) {
  const Vec2 across(-along_.y(), along_.x());
  std::vector<std::vector<double>> crossings(row_count_);
  for (const auto& part : border) {
    Vec2 a((part[0] - origin_).dot(along_), (part[0] - origin_).dot(across) - bottom_);
    Vec2 b((part[1] - origin_).dot(along_), (part[1] - origin_).dot(across) - bottom_);
    if (a.y() > b.y()) std::swap(a, b);
    // Half open, so that a corner on a row counts once: the row from a point on is the same for both parts
    // that end there. The first and the last row touch the border only.
    const int first = std::max(1, row_from(a.y()));
    const int end = std::min(row_count_ - 1, row_from(b.y()));
    for (int row = first; row < end; ++row) {
      const double share = std::clamp((row * row_step_ - a.y()) / (b.y() - a.y()), 0.0, 1.0);
      crossings[row].push_back(a.x() + (b.x() - a.x()) * share);
    }
  }
  rows_.resize(row_count_);
  for (int row = 0; row < row_count_; ++row) {
    auto& xs = crossings[row];
    std::sort(xs.begin(), xs.end());
    for (std::size_t k = 0; k + 1 < xs.size(); k += 2) {
      int first = static_cast<int>(std::ceil(column_of(row, xs[k])));
      if (!rows_[row].empty()) first = std::max(first, rows_[row].back().last + 1);
      const int last = static_cast<int>(std::floor(column_of(row, xs[k + 1])));
      if (first > last) continue;
      rows_[row].push_back({first, last, free_.size()});
      free_.insert(free_.end(), static_cast<std::size_t>(last - first + 1), true);
    }
  }
}

void HexagonalLattice::clear_near(const Vec2& a, const Vec2& b) {
  const Vec2 across(-along_.y(), along_.x());
  const double reach = distance_to_points * edge_length_;
  const double y0 = (a - origin_).dot(across) - bottom_;
  const double y1 = (b - origin_).dot(across) - bottom_;
  const double x0 = (a - origin_).dot(along_);
  const double x1 = (b - origin_).dot(along_);
  const Vec2 d = b - a;
  const int first_row = std::max(0, static_cast<int>(std::ceil((std::min(y0, y1) - reach) / row_step_)));
  const int last_row =
      std::min(row_count_ - 1, static_cast<int>(std::floor((std::max(y0, y1) + reach) / row_step_)));
  for (int row = first_row; row <= last_row; ++row) {
    const int first = static_cast<int>(std::ceil(column_of(row, std::min(x0, x1) - reach)));
    const int last = static_cast<int>(std::floor(column_of(row, std::max(x0, x1) + reach)));
    for (const Run& run : rows_[row]) {
      for (int column = std::max(first, run.first); column <= std::min(last, run.last); ++column) {
        char& is_free = free_[run.flags + static_cast<std::size_t>(column - run.first)];
        if (!is_free) continue;
        const Vec2 p = place(row, column);
        const double along_part = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
        const double to_ends = std::min((p - a).norm(), (p - b).norm());
        const double to_part = (p - a - along_part * d).norm();
        if (to_ends < reach || to_part < distance_to_edges * edge_length_) is_free = false;
      }
    }
  }
}

std::vector<Vec2> HexagonalLattice::points() const {
  std::vector<Vec2> result;
  result.reserve(size_);
  for (int row = 0; row < row_count_; ++row) {
    const std::size_t begin = result.size();
    for (const Run& run : rows_[row]) {
      for (int column = run.first; column <= run.last; ++column) {
        if (free_[run.flags + static_cast<std::size_t>(column - run.first)])
          result.push_back(place(row, column));
      }
    }
    if (row & 1) std::reverse(result.begin() + static_cast<std::ptrdiff_t>(begin), result.end());
  }
  return result;
}

}  // namespace luxel
