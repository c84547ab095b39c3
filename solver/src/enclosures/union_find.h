#pragma once

#include <atomic>
#include <memory>
#include <utility>

namespace luxel {

/// Disjoint sets of 0 .. size - 1, joined from many threads at once; which sets result does not depend on the
/// order. A set's root is its smallest member. Source: Anderson and Woll 1991.
class UnionFind {
 public:
  explicit UnionFind(int size) : parents_(std::make_unique<std::atomic<int>[]>(size)) {
    for (int i = 0; i < size; ++i) parents_[i] = i;
  }

  int root(int i) {
    int parent = parents_[i];
    while (parent != i) {
      const int grandparent = parents_[parent];
      parents_[i].compare_exchange_weak(parent, grandparent);
      i = grandparent;
      parent = parents_[i];
    }
    return i;
  }

  void join(int a, int b) {
    for (;;) {
      a = root(a);
      b = root(b);
      if (a == b) return;
      if (a < b) std::swap(a, b);
      int expected = a;
      if (parents_[a].compare_exchange_strong(expected, b)) return;
    }
  }

 private:
  std::unique_ptr<std::atomic<int>[]> parents_;
};

}  // namespace luxel
