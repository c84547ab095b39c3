#pragma once

#include <vector>

#include "edge_table.h"

namespace luxel {

/// What of a set of loops a half-edge mesh can hold. Loops that share an edge are connected; a connected part
/// is manifold if each of its edges has one loop, or two that run along it in opposite directions.
struct ManifoldParts {
  std::vector<char> manifold;     ///< for each loop whether its part is manifold
  std::vector<int> fans;          ///< for each entry of a manifold loop its fan, from 0; else -1
  std::vector<int> fan_vertices;  ///< for each fan the vertex that it stands on
};

/// A fan is what is connected around a vertex. Where two fans meet in a point, a half-edge mesh needs that
/// point twice. Cost: linear in the entries.
ManifoldParts find_manifold_parts(const Loops& loops, const EdgeTable& edges);

}  // namespace luxel
