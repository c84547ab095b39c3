#pragma once

#include <span>
#include <vector>

#include "repeated_loops.h"

namespace luxel {

/// Which loops meet at each edge. The half-edge h runs from entry h of the loops to the next one of its loop.
/// Any number of loops may share an edge, in either direction. Cost: n log(most edges at a vertex).
class EdgeTable {
 public:
  EdgeTable(const Loops& loops, int vertex_count);

  /// The half-edges on the same edge as h, itself among them, ascending.
  std::span<const int> uses(int h) const {
    const int e = edge_[h];
    return std::span(half_edges_).subspan(offsets_[e], offsets_[e + 1] - offsets_[e]);
  }
  int edge(int h) const { return edge_[h]; }
  int edge_count() const { return static_cast<int>(offsets_.size()) - 1; }
  std::span<const int> uses_of_edge(int e) const {
    return std::span(half_edges_).subspan(offsets_[e], offsets_[e + 1] - offsets_[e]);
  }
  int loop(int h) const { return loop_[h]; }
  int from(int h) const { return from_[h]; }
  int to(int h) const { return to_[h]; }

 private:
  std::vector<int> from_, to_, loop_, edge_;
  std::vector<int> offsets_, half_edges_;
};

}  // namespace luxel
