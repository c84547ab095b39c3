#pragma once

#include <array>
#include <span>
#include <vector>

#include "luxel/patch_mesh.h"

namespace luxel {

/// Finds edges between patches of one polygon along which another polygon stands on it: what is lit on one
/// side may be covered on the other.
class ContactEdges {
 public:
  /// Cost: linear. The mesh must outlive it.
  explicit ContactEdges(const PatchMesh& mesh);

  /// Pairs of vertices of the mesh: edges that two of these patches of one polygon share, and both of whose
  /// ends are on several polygons.
  std::vector<std::array<int, 2>> between(std::span<const int> patches) const;

 private:
  const PatchMesh& mesh_;
  std::vector<char> several_;  // of each vertex: patches of several polygons have it
};

}  // namespace luxel
