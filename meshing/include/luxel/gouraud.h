#pragma once

#include <array>
#include <vector>

#include "luxel/patch_mesh.h"

namespace luxel {

/// The vertices that Gouraud interpolation works on: a mesh vertex stands once for every smooth fan of
/// patches around it, so that creases, material borders and the two sides of a sheet stay sharp.
struct GouraudMesh {
  std::vector<Vec3> vertices;  ///< V [m]
  std::vector<Vec3> normals;   ///< V unit vectors, averaged over the fan
  std::vector<std::array<int, 4>>
      corners;  ///< one row per patch of the mesh, same corner order; [3] = -1: a triangle
};

/// Fans are split at edges sharper than crease_angle [degrees], at material borders and where the surface is
/// not manifold. Cost: linear in the patches.
GouraudMesh gouraud_mesh(const PatchMesh& mesh, double crease_angle = 30);

/// Values at the Gouraud vertices, V x m, from values on the patches, N x m: at an interior vertex the
/// average of its fan weighted by corner angle; at a border extrapolated linearly and held within what the
/// fan and its neighbours have.
PatchField interpolate_to_vertices(const PatchMesh& mesh, const GouraudMesh& gouraud,
                                   const PatchField& patch_values);

}  // namespace luxel
