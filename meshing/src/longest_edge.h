#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <queue>
#include <unordered_map>
#include <vector>

#include "luxel/vector.h"

namespace luxel {

/// Halves the longest edge of a mesh of triangles, and all triangles on it, until no edge is longer than
/// asked. Any number of triangles may share an edge, so non-manifold surfaces stay conforming too; no angle
/// gets below half of the smallest one at the start. Cost: n log n, about a million triangles a second.
/// Source: M. C. Rivara, Algorithms for refining triangular grids, 1984 (bisection by the longest edge).
class LongestEdgeRefiner {
 public:
  /// Triangles over `vertices`; `tags` go with the triangles to their halves. `watched` edges are those that
  /// other meshes share: what divides them can be asked for.
  LongestEdgeRefiner(std::vector<Vec3>& vertices, std::vector<std::array<int, 3>> triangles,
                     std::vector<int> tags, const std::vector<std::array<int, 2>>& watched);

  /// New vertices are appended to `vertices`.
  void refine(double longest);

  /// How many triangles refine(longest) would have given, for any `longest` not below one refined to.
  std::size_t count(double longest) const;

  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }
  const std::vector<int>& tags() const { return tags_; }

  /// The vertices that now divide the edge from a to b, without its ends; nothing if it is not watched.
  std::optional<std::vector<int>> points_between(int a, int b) const;

 private:
  // A half-edge is 3 t + k: from corner k of triangle t to the next one.
  struct Entry {
    double squared_length;
    int half_edge, from, to;
    bool operator<(const Entry& other) const;
  };

  int from(int h) const { return triangles_[h / 3][h % 3]; }
  int to(int h) const { return triangles_[h / 3][(h % 3 + 1) % 3]; }
  static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
  void link_rings();
  void push(int h);
  void split(int h);
  void replace_in_ring(int old_half_edge, int new_half_edge);

  std::vector<Vec3>& vertices_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> tags_;
  std::vector<int> ring_;  // the next half-edge on the same edge; the last one leads to the first
  std::priority_queue<Entry> queue_;
  std::unordered_map<std::uint64_t, int> midpoints_;  // of watched edges and their parts; -1: not split yet
  std::vector<std::array<double, 2>> history_;        // squared length of each split edge, triangles after it
  std::size_t initial_;
};

}  // namespace luxel
