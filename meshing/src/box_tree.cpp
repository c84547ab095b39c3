#include "box_tree.h"

#include <algorithm>
#include <numeric>

namespace luxel {

namespace {

// Boxes in a leaf: a query tests this many one by one.
constexpr int leaf_size = 8;

}  // namespace

BoxTree::BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (!boxes_.empty()) build(0, static_cast<int>(boxes_.size()));
}

int BoxTree::build(int begin, int end) {
  const int index = static_cast<int>(nodes_.size());
  Box box, centres;
  for (int k = begin; k < end; ++k) {
    box.extend(boxes_[order_[k]]);
    centres.extend(boxes_[order_[k]].center());
  }
  nodes_.push_back({box, begin, end, 0});
  if (end - begin <= leaf_size) return index;
  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  const auto centre = [&](int i) { return boxes_[i].min()[axis] + boxes_[i].max()[axis]; };
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](int a, int b) { return centre(a) != centre(b) ? centre(a) < centre(b) : a < b; });
  build(begin, middle);
  const int right = build(middle, end);
  nodes_[index].right = right;
  return index;
}

}  // namespace luxel
