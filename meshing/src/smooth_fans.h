#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "angle.h"
#include "luxel/patch_mesh.h"
#include "manifold_parts.h"

namespace luxel {

/// Patches around a vertex that light may be averaged over.
struct SmoothFans {
  std::vector<int> vertices;  ///< for each fan the mesh's vertex that it stands on
  std::vector<Vec3> normals;  ///< of the patches, weighted by their corner angles; unit vectors
  std::vector<std::array<int, 4>>
      corners;  ///< for each of the patches asked for its fans; [3] = -1: a triangle
};

/// Tells whether the surface goes on smoothly from one patch to another: one material, no crease.
class SmoothTransition {
 public:
  SmoothTransition(const PatchMesh& mesh, double crease_angle)
      : mesh_(mesh), smallest_(std::cos(crease_angle / degrees_per_radian)) {}

  bool operator()(int i, int j) const {
    return i != j && mesh_.materials[i] == mesh_.materials[j] &&
           mesh_.normals[i].dot(mesh_.normals[j]) >= smallest_;
  }

 private:
  const PatchMesh& mesh_;
  double smallest_;  // cosine of the crease angle
};

/// Fans of patches in manifold parts, found on OpenMesh's half-edges. `parts` are those of all patches of the
/// mesh. Cost: linear.
SmoothFans find_fans_on_half_edges(const PatchMesh& mesh, std::span<const int> patches,
                                   const ManifoldParts& parts, const Loops& loops, double crease_angle);

/// Fans of any patches, found by sorting the edges around each vertex. Where more than two patches meet at an
/// edge, two are in a fan if they are each other's only smooth transition and none rises between them. Cost:
/// n log n in the patches at a vertex.
SmoothFans find_fans_by_index(const PatchMesh& mesh, std::span<const int> patches, double crease_angle);

}  // namespace luxel
