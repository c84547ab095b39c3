#pragma once

#include <cstdint>
#include <vector>

#include "luxel/patch_mesh.h"

namespace luxel {

/// Rays from the front of one patch: quasi-random points of it and cosine-distributed directions, one net of
/// both together. Points keep off the outline by `margin` [m] where the patch is wide enough, so that
/// rounding cannot put an origin on the far side of a neighbour.
struct HemisphereRays {
  std::vector<Vec3> origins, normals, directions;
};

/// The share of their way to the centroid by which the points of a patch are drawn in for that, in (0, 1]: 1
/// where the patch is narrower than the margin.
double drawn_in(const PatchMesh& mesh, int patch, double margin);

HemisphereRays hemisphere_rays(const PatchMesh& mesh, int patch, int count, std::uint64_t seed,
                               double margin);

}  // namespace luxel
