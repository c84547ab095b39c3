#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "luxel/vector.h"

namespace luxel {

/// The straight edges of all polygons, each once, with one list of points that all polygons on it share.
class SharedEdges {
 public:
  /// The edge between a and b; made on first mention.
  int add(int a, int b);

  int size() const { return static_cast<int>(ends_.size()); }
  /// Ends, the smaller vertex first.
  const std::array<int, 2>& ends(int edge) const { return ends_[edge]; }
  /// -1 if no polygon has it.
  int find(int a, int b) const;

  /// Divides every edge: by the points between its ends that given(a, b) lists, or, where that has nothing to
  /// say, into parts_of(edge, its length) equal parts, whose points are appended to `vertices`.
  void divide(std::vector<Vec3>& vertices, const std::function<int(int, double)>& parts_of,
              const std::function<std::optional<std::vector<int>>(int, int)>& given);

  /// Into how many parts an edge is divided, after divide().
  int parts(int edge) const { return static_cast<int>(between_[edge].size()) + 1; }

  /// Whether the points of an edge were given, after divide().
  bool is_given(int edge) const { return given_[edge]; }

  /// Puts the point m between a and b, which stand side by side on the edge.
  void insert(int edge, int a, int b, int m);

  /// The points from a to b, both included, after divide().
  std::vector<int> points(int a, int b) const;

 private:
  std::vector<std::array<int, 2>> ends_;
  std::unordered_map<std::uint64_t, int> index_;
  std::vector<std::vector<int>> between_;
  std::vector<char> given_;
};

}  // namespace luxel
