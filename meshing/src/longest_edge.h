#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <queue>
#include <unordered_map>
#include <vector>

#include "luxel/vector.h"
#include "split_mesh.h"

namespace luxel {

/// Halves the longest edge of a set of meshes of triangles, and all triangles on it, until no edge is longer
/// than asked. No angle gets below half of the smallest one at the start. The same triangles give the same
/// vertices in the same order, whatever meshes they are in. Cost: n log n, about a million triangles a
/// second. Source: M. C. Rivara, Algorithms for refining triangular grids, 1984 (bisection by the longest
/// edge).
class LongestEdgeRefiner {
 public:
  /// Meshes over `vertices`. `watched` edges are those that other meshes share: what divides them can be
  /// asked for.
  LongestEdgeRefiner(std::vector<Vec3>& vertices, std::vector<std::unique_ptr<SplitMesh>> meshes,
                     const std::vector<std::array<int, 2>>& watched);

  /// New vertices are appended to `vertices`.
  void refine(double longest);

  /// The first `halvings` edges that refine() would halve, longest first, those halved before among them.
  void halve(std::size_t halvings);

  /// How many edges refine(longest) would have halved, for any `longest` not below one refined to.
  std::size_t halvings(double longest) const;

  /// How many triangles there were after so many halvings, no more than were made.
  std::size_t count(std::size_t halvings) const;

  /// Of all meshes, one after the other.
  std::vector<std::array<int, 3>> triangles() const;
  std::vector<int> tags() const;

  /// The vertices that now divide the edge from a to b, without its ends; nothing if it is not watched.
  std::optional<std::vector<int>> points_between(int a, int b) const;

 private:
  struct Entry {
    double squared_length;
    std::array<int, 2> ends;  // ascending
    int mesh, edge;
    bool operator<(const Entry& other) const;
  };

  void push(int mesh, int edge);
  void split_longest();

  std::vector<Vec3>& vertices_;
  std::vector<std::unique_ptr<SplitMesh>> meshes_;
  std::priority_queue<Entry> queue_;
  std::unordered_map<std::uint64_t, int> midpoints_;  // of watched edges and their parts; -1: not split yet

  struct Halving {
    double squared_length;  // of the edge
    std::size_t triangles;  // after it
  };
  std::vector<Halving> history_;
  std::size_t initial_ = 0;
};

}  // namespace luxel
