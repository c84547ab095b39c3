#include "box_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "luxel/vector.h"

namespace luxel {

namespace {

using Pairs = std::vector<std::pair<int, int>>;

// Boxes up to this number are swept along one axis.
constexpr int largest_sweep = 1024;

// Cells that a box of the grid may cover; larger ones, so many at most, are tried against all others.
constexpr int most_cells = 64;
constexpr std::size_t most_large = 64;

// Trials a box, above which the grid's cells are too uneven for it to pay.
constexpr std::int64_t most_trials = 64;

void append_if_touching(const std::vector<Box>& boxes, int a, int b, Pairs& pairs) {
  if (boxes[a].intersects(boxes[b])) pairs.emplace_back(std::min(a, b), std::max(a, b));
}

Pairs by_sweep(const std::vector<Box>& boxes, int axis) {
  std::vector<std::pair<double, int>> order;
  order.reserve(boxes.size());
  for (int k = 0; k < static_cast<int>(boxes.size()); ++k) order.emplace_back(boxes[k].min()[axis], k);
  std::sort(order.begin(), order.end());
  Pairs pairs;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double end = boxes[order[i].second].max()[axis];
    for (std::size_t k = i + 1; k < order.size() && order[k].first <= end; ++k) {
      append_if_touching(boxes, order[i].second, order[k].second, pairs);
    }
  }
  return pairs;
}

Pairs by_tree(const std::vector<Box>& boxes) {
  const BoxTree tree(boxes);
  Pairs pairs;
  for (int k = 0; k < static_cast<int>(boxes.size()); ++k) {
    tree.query(boxes[k], [&](int other) {
      if (other > k) pairs.emplace_back(k, other);
    });
  }
  return pairs;
}

/// Boxes sorted into the cells of a grid along two axes.
class BoxGrid {
 public:
  BoxGrid(const std::vector<Box>& boxes, const Box& all, const std::array<int, 2>& axes)
      : boxes_(boxes), low_(all.min()), axes_(axes) {
    const double width = all.sizes()[axes[0]], height = all.sizes()[axes[1]];
    const double count = static_cast<double>(boxes.size());
    columns_ =
        static_cast<int>(std::clamp(std::sqrt(count * width / std::max(height, width / count)), 1.0, count));
    rows_ = std::max(1, static_cast<int>(count / columns_));
    per_metre_ = {columns_ / width, height > 0 ? rows_ / height : 0};

    offsets_.assign(static_cast<std::size_t>(columns_) * rows_ + 1, 0);
    for (int k = 0; k < static_cast<int>(boxes.size()); ++k) {
      if (is_large(k)) large_.push_back(k);
      for_each_cell(k, [&](int cell) { ++offsets_[cell + 1]; });
    }
    for (std::size_t c = 1; c < offsets_.size(); ++c) {
      const std::int64_t here = offsets_[c];
      trials_ += here * here / 2;
      offsets_[c] += offsets_[c - 1];
    }
  }

  bool pays() const {
    return large_.size() <= most_large && trials_ <= most_trials * static_cast<std::int64_t>(boxes_.size());
  }

  Pairs pairs() const {
    Pairs found;
    std::vector<int> members(offsets_.back());
    std::vector<int> next(offsets_.begin(), offsets_.end() - 1);
    for (int k = 0; k < static_cast<int>(boxes_.size()); ++k) {
      for_each_cell(k, [&](int cell) { members[next[cell]++] = k; });
    }
    for (int cell = 0; cell + 1 < static_cast<int>(offsets_.size()); ++cell) {
      for (int i = offsets_[cell]; i < offsets_[cell + 1]; ++i) {
        for (int j = i + 1; j < offsets_[cell + 1]; ++j) {
          const Box& a = boxes_[members[i]];
          const Box& b = boxes_[members[j]];
          if (!a.intersects(b)) continue;
          // told by the one of their common cells where what they have in common begins
          const Vec3 begin = a.min().cwiseMax(b.min());
          if (place(1, begin) * columns_ + place(0, begin) == cell)
            found.emplace_back(members[i], members[j]);
        }
      }
    }
    for (const int k : large_) {
      for (int other = 0; other < static_cast<int>(boxes_.size()); ++other) {
        if (other == k || (is_large(other) && other < k)) continue;
        append_if_touching(boxes_, k, other, found);
      }
    }
    return found;
  }

 private:
  int place(int axis, const Vec3& point) const {
    const double cell = (point[axes_[axis]] - low_[axes_[axis]]) * per_metre_[axis];
    return std::clamp(static_cast<int>(cell), 0, (axis == 0 ? columns_ : rows_) - 1);
  }

  bool is_large(int k) const {
    const Box& box = boxes_[k];
    const std::int64_t across = place(0, box.max()) - place(0, box.min()) + 1;
    const std::int64_t along = place(1, box.max()) - place(1, box.min()) + 1;
    return across * along > most_cells;
  }

  template <class Visit>
  void for_each_cell(int k, Visit&& visit) const {
    if (is_large(k)) return;
    const Box& box = boxes_[k];
    for (int j = place(1, box.min()); j <= place(1, box.max()); ++j) {
      for (int i = place(0, box.min()); i <= place(0, box.max()); ++i) visit(j * columns_ + i);
    }
  }

  const std::vector<Box>& boxes_;
  Vec3 low_;
  std::array<int, 2> axes_;
  int columns_, rows_;
  std::array<double, 2> per_metre_;
  std::vector<int> offsets_;  // of each cell among the members
  std::vector<int> large_;
  std::int64_t trials_ = 0;
};

}  // namespace

std::vector<std::pair<int, int>> touching_pairs(const std::vector<Box>& boxes) {
  Box all;
  for (const Box& box : boxes) all.extend(box);
  std::array<int, 3> axes = {0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](int a, int b) { return all.sizes()[a] > all.sizes()[b]; });
  if (static_cast<int>(boxes.size()) <= largest_sweep) return by_sweep(boxes, axes[0]);
  if (!(all.sizes()[axes[0]] > 0)) return by_tree(boxes);
  const BoxGrid grid(boxes, all, {axes[0], axes[1]});
  return grid.pays() ? grid.pairs() : by_tree(boxes);
}

}  // namespace luxel
