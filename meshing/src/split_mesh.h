#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace luxel {

/// Triangles that can be split at an edge, all those on the edge at once, so that neighbours keep meeting
/// edge to edge. Edges are counted from 0; new ones are added at the end.
class SplitMesh {
 public:
  virtual ~SplitMesh() = default;

  virtual int triangle_count() const = 0;
  virtual int edge_count() const = 0;

  /// The vertices at both ends.
  virtual std::array<int, 2> ends(int edge) const = 0;

  /// Puts the vertex `middle` on the edge, which becomes one of its halves. Gives all edges that now meet in
  /// the middle; the list lasts until the next split.
  virtual std::span<const int> split(int edge, int middle) = 0;

  /// Counter-clockwise as they were given.
  virtual std::vector<std::array<int, 3>> triangles() const = 0;

  /// For each triangle the tag of the one that it is part of.
  virtual const std::vector<int>& tags() const = 0;
};

/// One mesh over half-edges for the parts that are manifold and one by index for the others, where there are
/// such parts. No edge is shared between the two.
std::vector<std::unique_ptr<SplitMesh>> make_split_meshes(const std::vector<std::array<int, 3>>& triangles,
                                                          const std::vector<int>& tags, int vertex_count);

}  // namespace luxel
