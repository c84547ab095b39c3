#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace luxel {

using Box = Eigen::AlignedBox3d;

/// Finds which of many boxes touch a given one. Cost: building n log n, a query log n plus what it finds.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Box> boxes);

  /// Calls visit(index) for every box that touches `box`, in a fixed order.
  template <class Visit>
  void query(const Box& box, Visit&& visit) const {
    if (!nodes_.empty()) query_node(0, box, visit);
  }

 private:
  struct Node {
    Box box;
    int begin, end;  // in order_
    int right;       // the left child follows its parent; 0: a leaf
  };

  int build(int begin, int end);

  template <class Visit>
  void query_node(int index, const Box& box, Visit&& visit) const {
    const Node& node = nodes_[index];
    if (!node.box.intersects(box)) return;
    if (node.right == 0) {
      for (int k = node.begin; k < node.end; ++k) {
        if (boxes_[order_[k]].intersects(box)) visit(order_[k]);
      }
      return;
    }
    query_node(index + 1, box, visit);
    query_node(node.right, box, visit);
  }

  std::vector<Box> boxes_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace luxel
