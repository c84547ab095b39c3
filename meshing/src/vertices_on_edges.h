#pragma once

#include <array>
#include <span>
#include <vector>

#include "luxel/vector.h"

namespace luxel {

/// A vertex strictly inside an edge.
struct VertexOnEdge {
  int edge;
  int vertex;
  double place;  ///< 0 .. 1 from the edge's first end to its second
};

/// Which of the `candidates` lie on which of the edges between vertices, by edge, then by place. The same for
/// any number of threads. Cost: about linear; log n for an edge much longer than most.
std::vector<VertexOnEdge> find_vertices_on_edges(const std::vector<Vec3>& vertices,
                                                 std::span<const int> candidates,
                                                 const std::vector<std::array<int, 2>>& edges);

/// Distance within which a vertex lies on an edge [m].
double touching_distance(const std::vector<Vec3>& vertices);

}  // namespace luxel
