#pragma once

#include <vector>

#include "form_factors/cluster_tree.h"

namespace luxel {

/// Quadrature points of all patches in tree order, in the layout of the block kernels: point k of patch p at
/// [k * stride + p]. Triangles get triangle rules, quads tensor Gauss rules of the same accuracy; in mixed
/// meshes the shorter rule is filled up with points of weight 0.
struct PatchPoints {
  int count = 0;  ///< points per patch
  int stride = 0;
  std::vector<double> x, y, z, weight;
};

/// Normals and plane offsets in the same layout.
struct PatchPlanes {
  std::vector<double> nx, ny, nz, offset;
};

/// Entries behind the last patch that kernels may read.
constexpr int lane_padding = 16;

/// Levels of accuracy: 1 = midpoint, 2, 3, 4 = exact for polynomials of degree 3, 5, 7 on quads and 2, 4, 6
/// on triangles.
constexpr int point_levels = 4;

PatchPoints patch_points(const std::vector<WorkPatch>& patches, int level);
PatchPlanes patch_planes(const std::vector<WorkPatch>& patches);

}  // namespace luxel
